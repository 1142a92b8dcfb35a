"""Kept machine code: files that are cut off or cannot be written have kernels compiled anew."""

from __future__ import annotations

import importlib.util
import itertools
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from decomp.kernels.cache import CheckedFiles
from tests.files.small_disk import small_disk

NUMBERS = itertools.count()
SOURCE = """from decomp.kernels.compiled import kernel

@kernel
def twice(x):
    return {factor} * x
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "doubling.py").write_text(SOURCE.format(factor=2))
    return tmp_path


def fresh(folder: Path) -> Any:
    """The kernel as another process would see it."""
    spec = importlib.util.spec_from_file_location(
        f"doubling{next(NUMBERS)}", folder / "doubling.py"
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.twice


def was_kept(kernel: Any) -> bool:
    return sum(kernel.stats.cache_hits.values()) == 1


def halved(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def emptied(path: Path) -> None:
    path.write_bytes(b"")


def garbled(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(data)


def of_numba(path: Path) -> None:
    """As numba itself begins its files."""
    path.write_bytes(b"\x80\x04\x95\n\x00\x00\x00\x00\x00\x00\x00\x8c\x060.68.0\x94.")


def a_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("harm", [halved, emptied, garbled, of_numba, Path.unlink, a_folder])
def test_harmed_files(harm: Callable[[Path], None], suffix: str, folder: Path) -> None:
    assert fresh(folder)(3.0) == 6.0
    kept = fresh(folder)
    assert kept(3.0) == 6.0
    assert was_kept(kept)
    (file,) = (folder / "__pycache__").glob(f"*{suffix}")
    harm(file)
    anew = fresh(folder)
    assert anew(3.0) == 6.0
    assert not was_kept(anew)
    if harm is not a_folder:
        again = fresh(folder)
        assert again(3.0) == 6.0
        assert was_kept(again)


def test_code_of_another_source_is_not_taken(folder: Path) -> None:
    """An index without its code, beside code that another source has left under the name."""
    assert fresh(folder)(3.0) == 6.0
    (code,) = (folder / "__pycache__").glob("*.nbc")
    old = code.read_bytes()
    (folder / "doubling.py").write_text(SOURCE.format(factor=30))
    assert fresh(folder)(3.0) == 90.0
    code.write_bytes(old)
    assert fresh(folder)(3.0) == 90.0


@pytest.fixture
def elsewhere(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache on a disk of 4 kB."""
    with small_disk(tmp_path / "disk", 4) as disk:
        monkeypatch.setattr("numba.core.config.CACHE_DIR", str(disk))
        yield disk


def test_a_full_disk(folder: Path, elsewhere: Path) -> None:
    for _ in range(2):
        kernel = fresh(folder)
        assert kernel(3.0) == 6.0
        assert not was_kept(kernel)
    assert not list(elsewhere.rglob("*.tmp*"))
    assert not (folder / "__pycache__").exists() or not list(folder.rglob("*.nb?"))


def test_the_index_comes_last(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Code that cannot be written leaves no index that tells of it."""

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(CheckedFiles, "_open_for_write", full)
    assert fresh(folder)(3.0) == 6.0
    assert not list(folder.rglob("*.nbi"))
