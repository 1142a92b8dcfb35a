"""A sweep over a design: the stiffness of a plate in tension against the radius of its hole.

A square plate of side W has a hole of radius a in its middle. Two opposite sides are pulled apart,
free to slide, and the force for each unit of stretch is its stiffness. An eighth of the plate is
meshed, with symmetry on three sides. What must hold, in parts of the stiffness E t without a hole:

- no hole: 1, and the elements hold the exact uniform stretch;
- any hole: at least 1 - 2 a / W, by the theorem of least complementary energy, as two strips beside
  the hole can carry the pull alone; at most 1 - c with c = pi a^2 / W^2, by the theorem of least
  potential energy, as the uniform stretch is a possible one (Timoshenko and Goodier, Theory of
  Elasticity, chapter 8). Found values are above the exact ones for the second reason;
- a small hole: 1 - 3 c for plane stress (Kachanov, Elastic solids with many cracks and related
  problems, Advances in Applied Mechanics 30, 1993). It is compared for Poisson's ratio 0, with
  which a plate of any thickness is in plane stress.
"""

from __future__ import annotations

import sys
from functools import cache
from math import pi

import numpy as np
import skfem
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, eye, sym_grad, trace

import decomp

SIDE, THICK = 20.0, 1.0
STEEL, CORK = 0.3, 0.0
"""Poisson's ratios."""
SMALL = (0.8, 1.2, 1.6)
RADII = (0.0, *SMALL, 2.4, 3.6, 5.0, 6.5, 8.0)


@cache
def meshed(radius: float) -> skfem.MeshTet:
    """An eighth of the plate, its hole's axis along z, with elements of order 2."""
    plate: decomp.Solid = decomp.Block((0, 0, 0), (SIDE / 2, SIDE / 2, THICK / 2), name="plate")
    if radius:
        plate = plate - decomp.Cylinder((0, 0, -1), (0, 0, THICK), radius, name="hole")
    made = decomp.mesh(plate, size=1.25, elements_per_circle=24, order=2)
    return made.to_skfem()


def stiffness(mesh: skfem.MeshTet, poisson: float) -> float:
    """Of the whole plate, over that of the plate without a hole."""
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()))
    mu = 1 / (2 * (1 + poisson))
    lame = poisson / ((1 + poisson) * (1 - 2 * poisson))

    def stress(e: np.ndarray) -> np.ndarray:
        return 2 * mu * e + lame * eye(trace(e), 3)

    form = skfem.BilinearForm(lambda u, v, w: ddot(stress(sym_grad(u)), sym_grad(v)))
    matrix = form.assemble(basis)
    sides = (("xmin", "u^1"), ("ymin", "u^2"), ("zmin", "u^3"))
    held = [basis.get_dofs(f"solid/plate.{side}").all([name]) for side, name in sides]
    pulled = basis.get_dofs("solid/plate.xmax").all(["u^1"])
    u = basis.zeros()
    u[pulled] = 1.0
    free = np.setdiff1d(np.arange(basis.N), np.concatenate([*held, pulled]))
    inner = matrix[free][:, free].tocsc()
    factors = splu(inner, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    u[free] = factors.solve(-(matrix @ u)[free])
    return float(u @ matrix @ u) / (THICK / 2)


def lost_by_area(radii: tuple[float, ...]) -> np.ndarray:
    """How much stiffness each hole takes over its part of the area, for Poisson's ratio 0."""
    left = np.array([stiffness(meshed(radius), CORK) for radius in radii])
    return (1 - left) * SIDE**2 / (pi * np.square(radii))


def for_small_holes(radii: tuple[float, ...]) -> float:
    """The same for radius 0, by a line through the values over the holes' areas."""
    return float(np.polyfit(np.square(radii), lost_by_area(radii), 1)[1])


def bounds(radii: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest stiffness by energy, over that without a hole."""
    return 1 - 2 * radii / SIDE, 1 - pi * radii**2 / SIDE**2


def plot(radii: tuple[float, ...], found: list[float], path: str) -> None:
    """Stiffness against the hole's radius, between its bounds."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    fine = np.linspace(0, max(radii), 200)
    least, greatest = bounds(fine)
    near = fine[fine <= SIDE / 6]
    plt.figure(figsize=(5, 4))
    plt.fill_between(fine / SIDE, least, greatest, color="0.9", label="between bounds by energy")
    small = 1 - 3 * pi * near**2 / SIDE**2
    plt.plot(near / SIDE, small, "--", color="#D55E00", label="for a small hole")
    plt.plot(np.array(radii) / SIDE, found, "o-", color="#0072B2", label="found")
    plt.xlabel("radius of the hole / side of the plate")
    plt.ylabel("stiffness / stiffness without hole")
    plt.ylim(0, 1.05)
    plt.grid(True, alpha=0.3)
    plt.legend(loc="lower left")
    plt.tight_layout()
    plt.savefig(path, dpi=120)


if __name__ == "__main__":
    found = [stiffness(meshed(radius), STEEL) for radius in RADII]
    for radius, value, least, greatest in zip(RADII, found, *bounds(np.array(RADII)), strict=True):
        print(f"radius {radius:3.1f}: {value:.4f}, between {least:.4f} and {greatest:.4f}")
    print(f"lost over area of small holes: {for_small_holes(SMALL):.3f}, in theory 3")
    if len(sys.argv) > 1:
        plot(RADII, found, sys.argv[1])
