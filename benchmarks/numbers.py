"""Small numbers without a name, and names that stand for several numbers.

python -m benchmarks.numbers [--list] [FOLDER]

Counts, in each package, float literals below 1e-3 that are not constants of a module with a
docstring, and names of constants that have different values in several modules.
"""

from __future__ import annotations

import argparse
import ast
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

PACKAGE = Path(__file__).parent.parent / "decomp"
SMALL = 1e-3
"""Literals below are tolerances, most of them."""


@dataclass(frozen=True)
class Literal:
    """A small number in the middle of the code.

    Args:
        path, line: where.
        value: as it is written.
    """

    path: Path
    line: int
    value: str


def constants(tree: ast.Module) -> Iterator[tuple[str, ast.expr, bool]]:
    """Names and values of a module's constants, and whether a docstring is below.

    One docstring is enough for constants on lines that follow one another. `A, B = 1, 2` are two.
    """
    run: list[ast.Assign | ast.AnnAssign] = []
    for node in [*tree.body, ast.Pass()]:
        if isinstance(node, ast.Assign | ast.AnnAssign):
            if run and node.lineno > (run[-1].end_lineno or 0) + 1:
                yield from _named(run, False)
                run = []
            run.append(node)
            continue
        told = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        yield from _named(run, told)
        run = []


def _named(
    run: list[ast.Assign | ast.AnnAssign], told: bool
) -> Iterator[tuple[str, ast.expr, bool]]:
    for node in run:
        if node.value is None:
            continue
        for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
            pairs = [(target, node.value)]
            if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                pairs = list(zip(target.elts, node.value.elts, strict=True))
            for name, value in pairs:
                if isinstance(name, ast.Name) and name.id.isupper():
                    yield name.id, value, told


def unnamed(path: Path) -> list[Literal]:
    """The small numbers in a file that are not constants with a docstring."""
    text = path.read_text(encoding="utf-8")
    tree = ast.parse(text)
    named = {id(part) for _, value, told in constants(tree) if told for part in ast.walk(value)}
    return [
        Literal(path, node.lineno, ast.get_source_segment(text, node) or repr(node.value))
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant)
        and isinstance(node.value, float)
        and 0 < node.value < SMALL
        and id(node) not in named
    ]


def ambiguous(folder: Path) -> dict[str, dict[str, list[Path]]]:
    """Names of numbers that have several values: the modules of each value, as it is written."""
    found: dict[str, dict[str, list[Path]]] = defaultdict(lambda: defaultdict(list))
    for path in sorted(folder.rglob("*.py")):
        for name, value, _ in constants(ast.parse(path.read_text(encoding="utf-8"))):
            parts = list(ast.walk(value))
            if any(isinstance(p, ast.Constant) and type(p.value) in (int, float) for p in parts):
                found[name][ast.unparse(value)].append(path)
    return {name: dict(values) for name, values in found.items() if len(values) > 1}


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", nargs="?", type=Path, default=PACKAGE)
    parser.add_argument("--list", action="store_true", help="print every place")
    options = parser.parse_args()
    literals = [each for path in sorted(options.folder.rglob("*.py")) for each in unnamed(path)]
    names = ambiguous(options.folder)
    if options.list:
        for each in literals:
            print(f"{each.path.relative_to(options.folder)}:{each.line}: {each.value}")
        for name, values in sorted(names.items()):
            for value, paths in values.items():
                where = ", ".join(str(path.relative_to(options.folder)) for path in paths)
                print(f"{name} = {value}: {where}")
    packages = Counter(each.path.relative_to(options.folder).parts[0] for each in literals)
    for package, count in sorted(packages.items()):
        print(f"{count:6d}  {package}")
    print(f"{len(literals):6d}  numbers below {SMALL:g} without a name")
    print(f"{len(names):6d}  names of constants with several values")


if __name__ == "__main__":
    main()
