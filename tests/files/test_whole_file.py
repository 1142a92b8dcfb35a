"""The one writer: what is there is replaced whole with its mode, or written to, or left alone."""

from __future__ import annotations

import errno
import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from decomp.errors import FileError, InputError
from decomp.files.suffixes import known_suffix
from decomp.files.targets import check_outputs, check_target, descriptor, same_file
from decomp.files.whole_file import write_whole
from tests.files.small_disk import small_disk

pytestmark = pytest.mark.skipif(os.name != "posix", reason="links, modes and pipes of POSIX")


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


@pytest.mark.parametrize("umask", [0o022, 0o077, 0o002])
def test_a_new_file_has_the_umasks_mode(umask: int, tmp_path: Path) -> None:
    before = os.umask(umask)
    try:
        write_whole(tmp_path / "x", b"new")
    finally:
        os.umask(before)
    assert mode(tmp_path / "x") == 0o666 & ~umask


@pytest.mark.parametrize("kept", [0o600, 0o640, 0o755, 0o666, 0o200])
def test_an_old_files_mode_is_kept(kept: int, tmp_path: Path) -> None:
    path = tmp_path / "x"
    path.write_text("old")
    path.chmod(kept)
    write_whole(path, b"new")
    assert mode(path) == kept
    path.chmod(0o600)
    assert path.read_bytes() == b"new"
    assert [each.name for each in tmp_path.iterdir()] == ["x"]


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root gives files away")
def test_an_old_files_owner_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "x"
    path.write_text("old")
    os.chown(path, 12345, 23456)
    write_whole(path, b"new")
    assert (path.stat().st_uid, path.stat().st_gid) == (12345, 23456)


@pytest.mark.parametrize("closed", [0o444, 0o400, 0o555, 0o000])
def test_a_read_only_file_is_left_alone(closed: int, tmp_path: Path) -> None:
    """The superuser too is refused, by way of a link too."""
    path, link = tmp_path / "x", tmp_path / "link"
    path.write_text("old")
    path.chmod(closed)
    link.symlink_to(path)
    for name in (path, link):
        for refused in (lambda: check_target(name), lambda: write_whole(name, b"new")):  # noqa: B023
            with pytest.raises(FileError, match=f"{name.name}: cannot be written: it is read-only"):
                refused()
    assert mode(path) == closed
    path.chmod(0o600)
    assert path.read_text() == "old"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["link", "x"]


@pytest.mark.parametrize("there", [True, False], ids=["whole", "dangling"])
def test_links_are_followed(there: bool, tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    target, link, outer = tmp_path / "far" / "x", tmp_path / "link", tmp_path / "outer"
    if there:
        target.write_text("old")
    link.symlink_to("far/x")
    outer.symlink_to(link)
    write_whole(outer, b"new")
    assert outer.is_symlink()
    assert link.readlink() == Path("far/x")
    assert target.read_bytes() == b"new"
    assert [each.name for each in target.parent.iterdir()] == ["x"]


def test_links_in_a_circle(tmp_path: Path) -> None:
    (tmp_path / "a").symlink_to("b")
    (tmp_path / "b").symlink_to("a")
    with pytest.raises(FileError, match="a: cannot be written: Too many levels of symbolic links"):
        check_target(tmp_path / "a")


def test_a_long_name_is_no_obstacle(tmp_path: Path) -> None:
    path = tmp_path / ("x" * 255)
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    with pytest.raises(FileError, match="cannot be written: File name too long"):
        check_target(tmp_path / ("x" * 256))


def test_a_pipe_is_written_to(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    found: list[bytes] = []
    reader = threading.Thread(target=lambda: found.append(pipe.read_bytes()))
    reader.start()
    write_whole(pipe, b"x" * 200_000)
    reader.join(10)
    assert found == [b"x" * 200_000]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_device_is_written_to(tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to(os.devnull)
    for name in (os.devnull, link):
        write_whole(name, b"new")
    assert stat.S_ISCHR(Path(os.devnull).stat().st_mode)
    assert link.is_symlink()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
def test_a_full_device() -> None:
    with pytest.raises(FileError, match="/dev/full: cannot be written: No space left on device"):
        write_whole("/dev/full", b"new")
    assert stat.S_ISCHR(Path("/dev/full").stat().st_mode)


WRITING = "import sys; from decomp.files.whole_file import write_whole as w; print('a'); "


@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "link"])
@pytest.mark.parametrize("to", ["pipe", "file"])
def test_open_streams(name: str, to: str, tmp_path: Path) -> None:
    """What the stream leads to is neither replaced nor cut off, and order is kept."""
    if name == "link":
        (tmp_path / name).symlink_to("/dev/stdout")
        name = str(tmp_path / name)
    words = [sys.executable, "-c", WRITING + f"w({name!r}, b'b\\n'); print('c')"]
    if to == "pipe":
        said = subprocess.run(words, capture_output=True, check=True).stdout
        assert said == b"a\nb\nc\n"
        return
    path = tmp_path / "out"
    path.write_text("before\n")
    number = path.stat().st_ino
    with path.open("a") as file:
        subprocess.run(words, stdout=file, check=True)
    assert path.read_text() == "before\na\nb\nc\n"
    assert path.stat().st_ino == number


def test_a_stream_that_is_not_open() -> None:
    with pytest.raises(FileError, match="cannot be written: it is not open"):
        check_target("/dev/fd/987")


def test_a_full_disk(tmp_path: Path) -> None:
    with small_disk(tmp_path / "disk", 64) as disk:
        path = disk / "x"
        path.write_text("old")
        path.chmod(0o640)
        with pytest.raises(FileError, match="x: cannot be written: No space left on device"):
            write_whole(path, b"x" * 100_000)
        assert path.read_text() == "old"
        assert mode(path) == 0o640
        assert [each.name for each in disk.iterdir()] == ["x"]


def test_a_disk_that_fails_late(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "x").write_text("old")

    def failing(*_: object) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(Path, "replace", failing)
    with pytest.raises(FileError, match="x: cannot be written: Input/output error"):
        write_whole(tmp_path / "x", b"new")
    assert [each.read_text() for each in tmp_path.iterdir()] == ["old"]


def _renamed(folder: Path) -> list[Path]:
    """Other names of a file `x`."""
    symbolic, hard, around = folder / "symbolic", folder / "hard", folder / "sub" / ".." / "x"
    (folder / "sub").mkdir()
    symbolic.symlink_to("x")
    os.link(folder / "x", hard)
    return [folder / "x", symbolic, hard, around]


def test_no_output_is_an_input(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("x").write_text("old")
    for name in [*_renamed(tmp_path), Path("x")]:
        assert same_file(name, "x")
        with pytest.raises(FileError, match="this file is read"):
            check_outputs([tmp_path / "other", name], [None, tmp_path / "x"])
    check_outputs([tmp_path / "other"], [tmp_path / "x", tmp_path / "gone"])
    check_outputs([tmp_path / "other"], ["x" * 1000, "x\0"])  # whoever reads these says so


def test_no_two_outputs_are_one_file(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("old")
    for name in _renamed(tmp_path):
        with pytest.raises(FileError, match="two outputs would be written to this one file"):
            check_outputs([tmp_path / "x", tmp_path / "new", name])
    (tmp_path / "folder").symlink_to("sub")
    with pytest.raises(FileError, match=r"new: two outputs .* file as .*sub/new: give each"):
        check_outputs([tmp_path / "sub" / "new", tmp_path / "folder" / "new"])


def test_suffixes(tmp_path: Path) -> None:
    known = (".json", ".html")
    assert known_suffix("x.JSON", known, "reports") == ".json"
    for name in ("x", "-", ".json", "x.json.bak", tmp_path):
        with pytest.raises(InputError, match=r"as a suffix for reports; use \.json, \.html"):
            known_suffix(name, known, "reports")
    os.mkfifo(tmp_path / "pipe")
    os.mkfifo(tmp_path / "pipe.txt")
    assert known_suffix(tmp_path / "pipe", known, "reports") == ".json"
    assert known_suffix(os.devnull, known, "reports") == ".json"
    with pytest.raises(InputError, match=r"'\.txt' is unknown"):
        known_suffix(tmp_path / "pipe.txt", known, "reports")


def test_what_names_a_stream() -> None:
    assert descriptor("/dev/stderr") == 2
    assert descriptor("/dev/fd/7") == 7
    assert descriptor("/dev/null") is None
    assert descriptor("x") is None
