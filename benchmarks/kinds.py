"""Where code asks for a surface's kind instead of asking the surface.

What depends on a carrier's kind alone belongs behind `Carrier`. Tables of pairs (curves of
intersection, Voronoi surfaces) and what makes carriers out of primitives ask for kinds by their
nature and are not counted, nor is `decomp/carriers` itself. `python -m benchmarks.kinds` lists the
places; with `--count` it prints only how many there are.
"""

from __future__ import annotations

import argparse
import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
KINDS = frozenset({"Plane", "Sphere", "Cylinder", "EllipticCylinder", "Cone", "Torus"})
SITES = frozenset(f"{kind}Site" for kind in KINDS)
CODES = frozenset({"PLANE", "SPHERE", "CYLINDER", "ELLIPTIC_CYLINDER", "CONE", "TORUS"})
HOMES = (
    "decomp/carriers",
    "decomp/curves/intersect",
    "decomp/curves/meeting.py",
    "decomp/voronoi",
    "decomp/csg/primitives.py",
    "decomp/csg/elliptic.py",
    "decomp/csg/unbounded.py",
)


def places() -> Iterator[tuple[Path, int, str]]:
    """File, line and text of every place outside the homes that asks for a kind."""
    for path in sorted((ROOT / "decomp").rglob("*.py")):
        if not path.relative_to(ROOT).as_posix().startswith(HOMES):
            lines = path.read_text().splitlines()
            found = {node.lineno for node in ast.walk(ast.parse("\n".join(lines))) if asks(node)}
            yield from ((path, number, lines[number - 1].strip()) for number in sorted(found))


def asks(node: ast.AST) -> bool:
    """Whether a node of a syntax tree asks for a carrier's kind: a test of class, name or code."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return node.func.id == "isinstance" and _names(node.args[1]) & (KINDS | SITES) != set()
    if isinstance(node, ast.pattern):
        return isinstance(node, ast.MatchClass) and _names(node.cls) & (KINDS | SITES) != set()
    if isinstance(node, ast.Compare):
        asked = [node.left, *node.comparators]
        words = {kind.lower() for kind in KINDS}
        names = set().union(*map(_names, asked))
        return bool(names & CODES and names & {"code", "codes", "kinds"}) or (
            "kind" in names
            and any(isinstance(each, ast.Constant) and each.value in words for each in asked)
        )
    return isinstance(node, ast.Attribute) and node.attr == "code"


def _names(node: ast.AST) -> set[str]:
    """The names in an expression, dotted ones by their last part."""
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)} | {
        each.attr for each in ast.walk(node) if isinstance(each, ast.Attribute)
    }


def main() -> None:
    """Print the places, or how many there are."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", action="store_true", help="print only how many there are")
    found = list(places())
    if not parser.parse_args().count:
        for path, line, text in found:
            print(f"{path.relative_to(ROOT)}:{line}: {text}")
    print(f"{len(found)} places ask for a kind of surface")


if __name__ == "__main__":
    main()
