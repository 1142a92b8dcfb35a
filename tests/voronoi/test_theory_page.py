"""The page `docs/theory.md`: the tests that it names exist."""

from __future__ import annotations

import re
from pathlib import Path

HERE = Path(__file__).parent
PAGE = (HERE.parent.parent / "docs" / "theory.md").read_text(encoding="utf-8")


def test_named_tests_exist() -> None:
    defined = set()
    for path in HERE.glob("test_*.py"):
        defined |= set(re.findall(r"^def (test_\w+)", path.read_text(encoding="utf-8"), re.M))
        defined.add(path.name)
    named = re.findall(r"`(?:(test_\w+\.py)::)?(test_\w+(?:\.py)?)`", PAGE)
    assert len(named) > 40
    for file, test in named:
        assert test in defined
        if file:
            assert f"def {test}(" in (HERE / file).read_text(encoding="utf-8")
