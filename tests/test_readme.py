"""The README's Python example runs and prints what its comments say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

README = Path(__file__).parent.parent / "README.md"


def test_the_python_example(capsys: pytest.CaptureFixture[str]) -> None:
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(), flags=re.DOTALL)
    assert len(blocks) == 1
    exec(compile(blocks[0], str(README), "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("5497.345")
    assert lines[0].endswith(" -1")
    assert lines[1].endswith("'hole#1.side', 'hole#2.side']")
    assert lines[2].startswith("plate.zmin [2.5")
    assert lines[-1] == "[-2.5]"


def test_the_package_docstring() -> None:
    import doctest

    import decomp

    assert doctest.testmod(decomp).failed == 0
