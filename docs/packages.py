"""Draw the packages of decomp and who imports whom: `python docs/packages.py` makes `packages.png`.

Rows are the layers that `pyproject.toml` lists, the highest on top. A line goes from a package to
each one that it imports, unless another one that it imports does so too; its width tells how many
imports there are.
"""

from __future__ import annotations

import tomllib
from collections import Counter
from pathlib import Path

import grimp
from matplotlib import pyplot as plt

ROOT = Path(__file__).parent.parent
TARGET = ROOT / "docs" / "pictures" / "packages.png"
WIDTH = 10.0
COLOURS = plt.get_cmap("tab20").colors


def layers() -> list[list[str]]:
    """The rows of the picture, the highest first, packages alone."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    rows = settings["tool"]["importlinter"]["contracts"][0]["layers"]
    packages = [[name.strip() for name in row.split(":")] for row in rows]
    rows = [[n for n in row if (ROOT / "decomp" / n / "__init__.py").exists()] for row in packages]
    return [row for row in rows if row]


def imports(names: set[str]) -> Counter[tuple[str, str]]:
    """How many imports lead from one package to another."""
    graph = grimp.build_graph("decomp")
    found: Counter[tuple[str, str]] = Counter()
    for module in graph.modules:
        for other in graph.find_modules_directly_imported_by(module):
            pair = (module.split(".")[1:2] or [""])[0], (other.split(".")[1:2] or [""])[0]
            if pair[0] != pair[1] and set(pair) <= names:
                found[pair] += 1
    return found


def direct(found: Counter[tuple[str, str]], level: dict[str, int]) -> dict[tuple[str, str], int]:
    """The imports downwards that no longer way of imports says as well."""
    below = {pair: count for pair, count in found.items() if level[pair[0]] < level[pair[1]]}

    def reached(start: str, end: str, without: tuple[str, str]) -> bool:
        nexts = [b for a, b in below if a == start and (a, b) != without]
        return end in nexts or any(reached(b, end, without) for b in nexts)

    return {pair: count for pair, count in below.items() if not reached(*pair, pair)}


def draw() -> None:
    """Write the picture."""
    rows = layers()
    place = {}
    level = {}
    for k, row in enumerate(rows):
        for i, name in enumerate(row):
            shift = 0.16 * (k % 3 - 1)
            place[name] = (WIDTH * ((i + 1) / (len(row) + 1) + shift), -float(k))
            level[name] = k
    files = {n: len(list((ROOT / "decomp" / n).rglob("*.py"))) for n in place}
    figure, axes = plt.subplots(figsize=(8, 0.62 * len(rows)))
    for number, ((a, b), count) in enumerate(sorted(direct(imports(set(place)), level).items())):
        bend = 0.12 * (-1) ** number * min(2, level[b] - level[a] - 1)
        axes.annotate(
            "",
            xy=(place[b][0], place[b][1] + 0.3),
            xytext=(place[a][0], place[a][1] - 0.3),
            arrowprops={
                "arrowstyle": "-|>",
                "color": COLOURS[2 * number % 20],
                "linewidth": 0.6 + 0.2 * count**0.5,
                "connectionstyle": f"arc3,rad={bend}",
            },
        )
    for name, (x, y) in place.items():
        label = f"{name}  ({files[name]})"
        box = {"boxstyle": "round,pad=0.35", "facecolor": "#f4f1e8", "edgecolor": "#555555"}
        axes.text(x, y, label, ha="center", va="center", fontsize=9, bbox=box, zorder=3)
    axes.set_xlim(0, WIDTH)
    axes.set_ylim(-len(rows) + 0.4, 0.6)
    axes.axis("off")
    figure.savefig(TARGET, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    draw()
