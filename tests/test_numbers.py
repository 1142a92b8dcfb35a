"""What `benchmarks.numbers` counts, and that there is none of it where there was none."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.numbers import PACKAGE, ambiguous, unnamed

TRACED = {"skeletons", "carriers"}
"""Packages whose numbers still want names."""


def test_numbers_with_a_docstring_are_named(tmp_path: Path) -> None:
    path = tmp_path / "named.py"
    path.write_text(
        'A, B = 1e-9, 2e-5\n"""Two lengths."""\nC = 5e-4\nD: float = 3e-7\n"""Both."""\n'
    )
    assert unnamed(path) == []


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("LONELY = 1e-9\n", "1e-9"),
        ("LONELY = 1e-9\n\nNAMED = 2\n'''Of the second only.'''\n", "1e-9"),
        ("def f(x):\n    '''Of the function.'''\n    return x > 1e-12\n", "1e-12"),
        ("lower = 4e-16\n'''No constant.'''\n", "4e-16"),
        ("A = 1\n'''A function follows.'''\ndef f(x=5e-7): pass\n", "5e-7"),
    ],
)
def test_other_small_numbers_are_not(tmp_path: Path, text: str, value: str) -> None:
    path = tmp_path / "unnamed.py"
    path.write_text(text)
    assert [each.value for each in unnamed(path)] == [value]


def test_large_numbers_and_zero_do_not_count(tmp_path: Path) -> None:
    path = tmp_path / "large.py"
    path.write_text("x = 0.0 + 1e-3 + 0.5 + 1e300 + 7\n")
    assert unnamed(path) == []


def test_names_with_several_values(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("SAME, OWN = 1e-9, 3\nWORD = 'a'\nTHREE: int = 3\n")
    (tmp_path / "b.py").write_text("SAME = 1e-6\nWORD = 'b'\nTHREE = 3\n")
    found = ambiguous(tmp_path)
    assert {name: set(values) for name, values in found.items()} == {"SAME": {"1e-09", "1e-06"}}


def test_small_numbers_have_names_and_reasons() -> None:
    left = [
        f"{each.path.relative_to(PACKAGE)}:{each.line}: {each.value}"
        for path in sorted(PACKAGE.rglob("*.py"))
        if path.relative_to(PACKAGE).parts[0] not in TRACED
        for each in unnamed(path)
    ]
    assert left == []
