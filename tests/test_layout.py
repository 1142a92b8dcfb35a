"""The packages as README lists them."""

from __future__ import annotations

import re
from pathlib import Path

import decomp

PACKAGE = Path(decomp.__file__).parent
README = (PACKAGE.parent / "README.md").read_text(encoding="utf-8")


def listed() -> list[Path]:
    """Folders and files in README's tree of the code, nested by indentation."""
    tree = README.split("## How the code is laid out", 1)[1].split("The tests' folders", 1)[0]
    found: list[Path] = []
    above = PACKAGE
    for line in tree.splitlines():
        name = re.match(r"( {4}| {8})([a-z]+(?:/|\.py)) ", line)
        if name and len(name[1]) == 4:
            above = PACKAGE / name[2]
        if name:
            found.append(above if len(name[1]) == 4 else above / name[2])
    return found


def test_what_readme_lists_exists() -> None:
    assert [path for path in listed() if not path.exists()] == []


def test_readme_lists_every_package() -> None:
    inner = ("skeletons", "meshing")
    packages = [p for p in PACKAGE.iterdir() if (p / "__init__.py").exists()]
    packages += [p for name in inner for p in (PACKAGE / name).iterdir() if p.is_dir()]
    missing = {p for p in packages if p.name != "__pycache__"} - set(listed())
    assert not missing
