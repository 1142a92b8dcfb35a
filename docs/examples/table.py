"""Runs all examples; writes their figures into the table of README.md, and the plot beside it."""

from __future__ import annotations

import re
from pathlib import Path

import coaxial
import heat
import plate
import sphere_modes
import wall_distance

HERE = Path(__file__).parent


def rows() -> list[tuple[str, str, str, str, str]]:
    """Example, figure, found, reference, how far off."""
    found: list[tuple[str, str, str, str, str]] = []

    def add(script: str, what: str, value: float, exact: float) -> None:
        off = f"{value / exact - 1:.1e}"
        found.append((script, what, f"{value:.5g}", f"{exact:.5g}", off))

    convergence = {order: heat.convergence((0.2, 0.14, 0.1, 0.07), order) for order in (1, 2)}
    heat.plot(convergence, str(HERE / "heat.png"))
    for order, (_, _, slope) in convergence.items():
        what = f"rate of the temperature's error, order {order}"
        found.append(("heat", what, f"{slope:.2f}", str(order + 1), ""))
    flow = heat.solved(0.14, 2)[2]
    add("heat", "heat flow over the exact one", 1 + flow, 1.0)
    add("coaxial", "capacitance for each unit of length", coaxial.capacitance(0.15), coaxial.EXACT)
    modes = sphere_modes.eigenvalues(0.3)
    for k in (0, 3):
        add("sphere_modes", f"eigenvalue {k + 1}", modes[k], sphere_modes.EXACT[k])
    add("plate", "stress concentration", plate.concentration(1.0, 60), plate.EXACT)
    names = ("largest error of the distance", "... of the thickness", "... of the mid-surface")
    for what, error in zip(names, wall_distance.errors(), strict=True):
        found.append(("wall_distance", what, f"{error:.0e}", "0", ""))
    return found


def main() -> None:
    """Write the table."""
    lines = ["| script | figure | found | reference | off |", "|---|---|---|---|---|"]
    for script, *rest in rows():
        lines.append(f"| [{script}]({script}.py) | {' | '.join(rest)} |")
    page = HERE / "README.md"
    text = page.read_text()
    table = "\n".join(["<!-- table -->", *lines, "<!-- end -->"])
    old = re.compile(r"<!-- table -->.*?<!-- end -->", re.DOTALL)
    page.write_text(old.sub(lambda _: table, text))


if __name__ == "__main__":
    main()
