"""Runs the examples; writes their figures into the table of README.md, and the plots beside it.

python docs/examples/table.py              all of them
python docs/examples/table.py heat sweep   these, the other rows stay
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import coaxial
import fichera
import flange
import heat
import heat_sink
import housing
import numpy as np
import plate
import sphere_modes
import sweep
import torus_modes
import transformer
import wall_distance

import decomp
from decomp.cli.main import main as command

HERE = Path(__file__).parent

Row = tuple[str, str, str, str]
"""Figure, found, reference, how far off."""


def compared(what: str, value: float, exact: float) -> Row:
    """A figure beside its reference, with the relative difference."""
    return what, f"{value:.5g}", f"{exact:.5g}", f"{value / exact - 1:.1e}"


def heat_rows() -> Iterator[Row]:
    """Rates of convergence, with the plot, and the heat flow."""
    convergence = {order: heat.convergence((0.2, 0.14, 0.1, 0.07), order) for order in (1, 2)}
    heat.plot(convergence, str(HERE / "heat.png"))
    for order, (_, _, slope) in convergence.items():
        what = f"rate of the temperature's error, order {order}"
        yield what, f"{slope:.2f}", str(order + 1), ""
    yield compared("heat flow over the exact one", 1 + heat.solved(0.14, 2)[2], 1.0)


def coaxial_rows() -> Iterator[Row]:
    """The capacitance."""
    yield compared("capacitance for each unit of length", coaxial.capacitance(0.15), coaxial.EXACT)


def sphere_modes_rows() -> Iterator[Row]:
    """The lowest eigenvalue and the next."""
    modes = sphere_modes.eigenvalues(0.3)
    for k in (0, 3):
        yield compared(f"eigenvalue {k + 1}", modes[k], sphere_modes.EXACT[k])


def torus_modes_rows() -> Iterator[Row]:
    """The lowest eigenvalue and one that counts twice."""
    modes, exact = torus_modes.eigenvalues(0.15, 4), torus_modes.reference(4)
    for k in (0, 3):
        yield compared(f"eigenvalue {k + 1}", modes[k], exact[k])


def transformer_rows() -> Iterator[Row]:
    """Heat balances, and elements of order 1 beside those of order 2, with the picture."""
    first, second = (
        transformer.solved(transformer.meshed(size, order), order)
        for size, order in (transformer.FIRST, transformer.SECOND)
    )
    transformer.plot(second, str(HERE / "transformer.png"))
    yield compared("heat out over heat made, by reactions", second.reactions, 1.0)
    yield compared("heat out over heat made, by slopes on the tank", second.by_slope, 1.0)
    yield compared("heat from a winding over heat made there", second.winding, 1.0)
    hottest = [float(warm.rise.max()) for warm in (first, second)]
    yield compared("greatest rise in K, order 1 beside order 2", *hottest)
    what = "losses times temperatures, order 1 beside order 2"
    yield compared(what, first.product, second.product)


def fichera_rows() -> Iterator[Row]:
    """Rates of convergence, with the plot, and the exponent."""
    results = {order: fichera.convergence(fichera.SIZES, order) for order in (1, 2)}
    fichera.plot(results, str(HERE / "fichera.png"))
    for order, (_, _, slope) in results.items():
        what = f"rate of the eigenvalue's error, order {order}"
        yield what, f"{slope:.2f}", f"{fichera.POWER:.2f} in the end", ""
    q = fichera.extrapolated(*results[2][:2])
    yield compared("exponent at the corner, extrapolated", q, fichera.EXPONENT)


def plate_rows() -> Iterator[Row]:
    """The stress concentration."""
    yield compared("stress concentration", plate.concentration(1.0, 60), plate.EXACT)


def sweep_rows() -> Iterator[Row]:
    """Stiffness without hole, with a large one, and the loss by small ones, with the plot."""
    found = [sweep.stiffness(sweep.meshed(radius), sweep.STEEL) for radius in sweep.RADII]
    sweep.plot(sweep.RADII, found, str(HERE / "sweep.png"))
    yield compared("stiffness without hole", found[0], 1.0)
    k = sweep.RADII.index(5.0)
    least, greatest = (values[k] for values in sweep.bounds(np.array(sweep.RADII)))
    what = "stiffness with a hole of a quarter of the side"
    yield what, f"{found[k]:.4f}", f"between {least:.2f} and {greatest:.2f}", ""
    what = "stiffness that a small hole takes, by area"
    yield compared(what, sweep.for_small_holes(sweep.SMALL), 3.0)


def wall_distance_rows() -> Iterator[Row]:
    """Largest errors."""
    names = ("largest error of the distance", "... of the thickness", "... of the mid-surface")
    for what, error in zip(names, wall_distance.errors(), strict=True):
        yield what, f"{error:.0e}", "0", ""


def picture(made: decomp.TetMesh, name: str, *options: str) -> None:
    """What `decomp view` draws of a mesh."""
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "mesh.msh"
        made.write(path)
        picture = ["-o", str(HERE / name), "--size-px", "900x675", *options]
        if command(["view", str(path), *picture]) != 0:
            raise SystemExit(f"no picture {name}")


def flange_rows() -> Iterator[Row]:
    """The preload beside springs, and who carries the pull, with the picture."""
    made = flange.meshed(flange.SIZE)
    picture(made, "flange.png", "--camera=-0.5,-1,0.5", "--clip", "y=31")
    joint = flange.Joint(made.to_skfem())
    yield compared("preload of the bolt in N", flange.tightened(joint), flange.by_springs())
    held, carried, by_stress = flange.pulled(joint)
    yield compared("pull held below over the pull", held, 1.0)
    yield compared("... carried by gasket and bolt, by reactions", carried, 1.0)
    yield compared("... by the stress on the gasket", by_stress, 1.0)


def heat_sink_rows() -> Iterator[Row]:
    """The conductance to the air, and balances, with the picture."""
    made = heat_sink.meshed(heat_sink.SIZE)
    picture(made, "heat_sink.png", "--camera=-1,-2,-0.7")
    warm = heat_sink.solved(made)
    what = "conductance from the base's top to the air in W/K"
    yield compared(what, warm.conductance, heat_sink.by_fin_theory())
    yield compared("heat to the air over heat made", warm.balance, 1.0)
    yield compared("heat from chip to sink over heat made", warm.pressed, 1.0)


def housing_rows() -> Iterator[Row]:
    """Forces of the screws, and the floor between two plates, with the picture."""
    made = housing.meshed(housing.SIZE)
    picture(made, "housing.png", "--camera=-1,-1.6,0.9")
    loaded = housing.solved(made)
    yield compared("force on the screws, down, over that on the floor", loaded.up, 1.0)
    yield compared("... along, over that opposite to the hole", loaded.along, 1.0)
    least, greatest = housing.BOUNDS
    what = "bending of the floor by p a^4 / D"
    yield what, f"{loaded.bending:.5f}", f"between {least} and {greatest}", ""


EXAMPLES: dict[str, Callable[[], Iterator[Row]]] = {
    "heat": heat_rows,
    "coaxial": coaxial_rows,
    "sphere_modes": sphere_modes_rows,
    "torus_modes": torus_modes_rows,
    "transformer": transformer_rows,
    "fichera": fichera_rows,
    "plate": plate_rows,
    "sweep": sweep_rows,
    "wall_distance": wall_distance_rows,
    "flange": flange_rows,
    "heat_sink": heat_sink_rows,
    "housing": housing_rows,
}
TABLE = re.compile(r"<!-- table -->\n(.*?)\n<!-- end -->", re.DOTALL)


def main(names: list[str]) -> None:
    """Write the table, with rows of the named examples, or of all, made anew."""
    page = HERE / "README.md"
    text = page.read_text()
    found = TABLE.search(text)
    old = found[1].splitlines()[2:] if found else []
    lines = ["| script | figure | found | reference | off |", "|---|---|---|---|---|"]
    for script, rows in EXAMPLES.items():
        start = f"| [{script}]({script}.py) |"
        if names and script not in names:
            lines += [line for line in old if line.startswith(start)]
        else:
            lines += [f"{start} {' | '.join(row)} |" for row in rows()]
    table = "\n".join(["<!-- table -->", *lines, "<!-- end -->"])
    page.write_text(TABLE.sub(lambda _: table, text))


if __name__ == "__main__":
    main(sys.argv[1:])
