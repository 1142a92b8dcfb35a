"""Every file that other projects ship: read, or refused by name."""

from __future__ import annotations

import re
import sysconfig
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path

import pytest

from decomp.errors import ParseError, UnsupportedError
from decomp.formats import load

CORPUS = Path(__file__).parents[3] / "shared" / "corpus"
FOREIGN = re.compile(r"\b(ellipsoid|ellipticcone|extrusion|revolution|polyhedron)\s*\(")
NOW_READ = {"ellipticcyl.geo"}
"""Files that the index has as not fitting, of kinds that have been added since."""
INFINITE = "special-consts-expected.csg"


def indexed() -> list[tuple[Path, bool]]:
    """Files of the corpus and whether they fit, from its index tables."""
    found = []
    for index in sorted(CORPUS.glob("*/INDEX.md")):
        for name, fits in re.findall(r"^\| (\S+) \|[^|]+\| (yes|no) \|", index.read_text(), re.M):
            found.append((index.with_name(name), fits == "yes" or name in NOW_READ))
    return found


def shipped() -> list[Path]:
    """The .geo files of solids that the installed Netgen brings along."""
    try:
        listed = files("netgen-mesher") or []
    except PackageNotFoundError:
        return []
    paths = {Path(str(f.locate())).resolve() for f in listed if f.name.endswith(".geo")}
    for root in {sysconfig.get_path("data"), sysconfig.get_path("purelib")}:
        paths.update(p.resolve() for p in Path(root, "share", "netgen").rglob("*.geo"))
    return sorted(p for p in paths if p.exists())


FILES = indexed()
SHIPPED = shipped()


@pytest.mark.skipif(not CORPUS.exists(), reason="the corpus is not at hand")
def test_corpus_is_not_empty() -> None:
    assert len(FILES) > 70
    assert {fits for _, fits in FILES} == {True, False}


def test_netgen_ships_files() -> None:
    pytest.importorskip("netgen")
    assert len(SHIPPED) > 25


@pytest.mark.parametrize(
    ("path", "fits"), FILES, ids=[f"{p.parent.name}/{p.name}" for p, _ in FILES]
)
def test_corpus(path: Path, fits: bool) -> None:
    if path.name == INFINITE:
        with pytest.raises(ParseError, match="r must be finite, got inf") as caught:
            load(path)
        assert (caught.value.line, caught.value.column) == (12, 1)
    elif fits:
        model = load(path)
        assert model.name == path.stem
        assert model.regions
    else:
        refused(path)


@pytest.mark.parametrize("path", SHIPPED, ids=[p.name for p in SHIPPED])
def test_shipped_with_netgen(path: Path) -> None:
    text = re.sub(r"#[^\n]*", "", path.read_text(encoding="latin-1"))
    if FOREIGN.search(text):
        refused(path)
    else:
        assert load(path).regions


def refused(path: Path) -> None:
    """The error names the construct and points at it."""
    with pytest.raises(UnsupportedError) as caught:
        load(path)
    error = caught.value
    assert error.line is not None
    assert error.column is not None
    line = path.read_text(encoding="latin-1").splitlines()[error.line - 1]
    construct = error.message.split()[0]
    assert line[error.column - 1 :].startswith(construct)
    assert str(path) in str(error)
