"""Few places ask for a surface's kind: what depends on it alone is asked of the surface."""

from __future__ import annotations

import ast

import pytest

from benchmarks.kinds import asks, places

MOST = 25


def test_few_places_ask_for_a_kind() -> None:
    found = [f"{path.name}:{line}: {text}" for path, line, text in places()]
    assert len(found) <= MOST, "\n".join(found)


@pytest.mark.parametrize(
    ("text", "counts"),
    [
        ("isinstance(carrier, Torus)", True),
        ("isinstance(carrier, (carriers.Plane, Sphere))", True),
        ("isinstance(site, ConeSite)", True),
        ("carrier.code", True),
        ("table.codes[k] == CONE", True),
        ("carrier.kind == 'plane'", True),
        ("match c:\n case Cylinder(): pass", True),
        ("isinstance(curve, Circle)", False),
        ("curve.kind == 'line'", False),
        ("period == PLANE", False),
        ("Torus(centre, axis, 2, 1)", False),
    ],
)
def test_what_counts(text: str, counts: bool) -> None:
    assert any(asks(node) for node in ast.walk(ast.parse(text))) is counts
