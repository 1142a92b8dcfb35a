"""Where the files are: the corpus next to the repository, else the ones that Netgen ships."""

from __future__ import annotations

import re
import sysconfig
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path

from tests.corpus.geo_text import UnreadableError, read

CORPUS = Path(__file__).parents[3] / "shared" / "corpus"
FOLDERS = ("netgen", "ngsolve", "elmer")
ROW = re.compile(r"^\| (\S+\.geo) \|[^|]+\| yes \|", re.MULTILINE)


def indexed() -> dict[str, Path]:
    """The files that the corpus marks as fit, by folder and name."""
    found = {}
    for folder in FOLDERS:
        index = CORPUS / folder / "INDEX.md"
        if index.exists():
            for name in ROW.findall(index.read_text(encoding="utf-8")):
                found[f"{folder}/{name}"] = index.with_name(name)
    return found


def shipped() -> dict[str, Path]:
    """The tutorials of the installed Netgen that the second reader understands."""
    paths = {p for root in _roots() for p in root.rglob("*.geo")}
    found = {}
    for path in sorted(paths):
        try:
            if read(path):
                found[f"netgen/{path.name}"] = path
        except UnreadableError:
            continue
    return found


def _roots() -> set[Path]:
    roots = {Path(sysconfig.get_path(key), "share", "netgen") for key in ("data", "purelib")}
    try:
        listed = files("netgen-mesher") or []
    except PackageNotFoundError:
        listed = []
    roots.update(Path(str(f.locate())).resolve().parent for f in listed if f.suffix == ".geo")
    return roots


FILES = indexed() or shipped()
