"""Heat in a transformer of five regions (meshes/transformer.geo, a quarter of it).

Windings and core are warmed by their losses, the outside of the tank is kept at ambient
temperature, the planes of symmetry are insulated, and each region conducts as its material does
(the oil with a figure that stands for its convection too). Found is the rise above ambient.

There is no closed form. What is checked:

- the heat that leaves through the tank is all that is made. By the reactions of the fixed nodes it
  is so to rounding for any elements; integrated from the temperature's slope on the tank it is so
  only as far as elements are small, and so is the heat that a winding gives to the oil;
- elements of order 1, and curved ones of order 2 on a mesh of its own, agree. The sum of losses
  times temperatures comes out too small with any elements (it is the greatest value of what Ritz's
  method makes greatest), so the larger of the two is the better.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import skfem
from scipy.sparse.linalg import splu
from skfem.helpers import dot, grad

import decomp

MODEL = Path(__file__).parents[2] / "meshes" / "transformer.geo"
CONDUCTIVITY = {"primary": 1.0, "secondary": 1.0, "core": 0.25, "oil": 0.02, "tank": 0.5}
"""In W / (cm K)."""
LOSSES = {"primary": 0.02, "secondary": 0.016, "core": 0.01}
"""In W / cm^3."""
FIRST, SECOND = (1.5, 1), (2.5, 2)
"""Largest edges in cm, and orders."""
OUTSIDE = [f"tank/tank.orthobrick1.{side}" for side in ("xmin", "xmax", "ymax", "zmax")]
GIVES = [
    f"primary/{face}"
    for face in (
        "top|oil/top",
        *(f"primary.cylinder{k}.side|oil/primary.cylinder{k}.side" for k in (1, 2)),
    )
]


@dataclass(frozen=True)
class Warm:
    """A solution.

    Attributes:
        basis: its elements; rise: above ambient at their nodes, in K.
        reactions: heat that leaves through the fixed nodes, over all that is made.
        by_slope: heat that leaves through the tank, by integrals over it, over all that is made.
        winding: heat that the primary winding gives to the oil, over its losses.
        product: losses times temperatures, summed, in W K.
    """

    basis: skfem.CellBasis
    rise: np.ndarray
    reactions: float
    by_slope: float
    winding: float
    product: float


def meshed(size: float, order: int) -> skfem.Mesh:
    """With edges up to a size in cm."""
    return decomp.mesh(MODEL, size=size, order=order).to_skfem()


def losses() -> dict[str, float]:
    """What each region makes, with its exact volume, in W."""
    regions = decomp.Geometry(MODEL).regions
    return {region.name: LOSSES.get(region.name, 0.0) * region.volume for region in regions}


def solved(mesh: skfem.Mesh, order: int) -> Warm:
    """With elements of an order."""
    element = skfem.ElementTetP1() if order == 1 else skfem.ElementTetP2()
    basis = skfem.Basis(mesh, element)
    matrix, load = 0, basis.zeros()
    for region, value in CONDUCTIVITY.items():
        part = skfem.Basis(mesh, element, elements=region)
        matrix = matrix + value * conduction.assemble(part)
        load += LOSSES.get(region, 0.0) * unit.assemble(part)
    fixed = basis.get_dofs(OUTSIDE).all()
    free = basis.complement_dofs(fixed)
    rise = basis.zeros()
    inner = matrix[free][:, free].tocsc()
    factors = splu(inner, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    rise[free] = factors.solve(load[free])
    reactions = float((load - matrix @ rise)[fixed].sum() / load.sum())
    made = losses()
    leaves = CONDUCTIVITY["tank"] * fall(basis, rise, OUTSIDE) / sum(made.values())
    given = CONDUCTIVITY["primary"] * fall(basis, rise, GIVES) / made["primary"]
    return Warm(basis, rise, reactions, leaves, given, float(load @ rise))


@skfem.BilinearForm
def conduction(u: skfem.DiscreteField, v: skfem.DiscreteField, w: object) -> np.ndarray:
    """Of conductivity 1."""
    return dot(grad(u), grad(v))


@skfem.LinearForm
def unit(v: skfem.DiscreteField, w: object) -> np.ndarray:
    """A source of 1."""
    return 1.0 * v


def fall(basis: skfem.CellBasis, rise: np.ndarray, faces: list[str]) -> float:
    """How fast the temperature falls across faces, integrated, on the side of the first region."""
    across = skfem.Functional(lambda w: -dot(w.n, w["t"].grad))
    on = [skfem.FacetBasis(basis.mesh, basis.elem, facets=face) for face in faces]
    return float(sum(across.assemble(part, t=part.interpolate(rise)) for part in on))


def plot(warm: Warm, path: str) -> None:
    """Temperatures in the plane of symmetry y = 0, with the outlines of the regions."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    mesh = warm.basis.mesh
    cuts = [name for name in mesh.boundaries if "/cut.plane1" in name and "|" not in name]
    nodes = warm.basis.get_dofs(cuts).all()
    x, _, z = warm.basis.doflocs[:, nodes]
    plt.figure(figsize=(7, 3.2))
    plt.tripcolor(x, z, warm.rise[nodes], shading="gouraud", cmap="inferno")
    plt.colorbar(label="rise above ambient, K", shrink=0.85)
    for name in cuts:
        sides = mesh.facets[:3, mesh.boundaries[name]][[0, 1, 1, 2, 2, 0]].T.reshape(-1, 2)
        ends, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
        x, _, z = mesh.p[:, ends[count == 1]]
        plt.plot(x.T, z.T, color="0.75", linewidth=0.8)
    plt.gca().set_aspect("equal")
    plt.xlabel("x, cm")
    plt.ylabel("z, cm")
    plt.tight_layout()
    plt.savefig(path, dpi=120)


if __name__ == "__main__":
    second = solved(meshed(*SECOND), SECOND[1])
    for warm in (solved(meshed(*FIRST), FIRST[1]), second):
        print(f"{warm.basis.N} unknowns, order {warm.basis.elem.maxdeg}:")
        print(
            f"  hottest {warm.rise.max():.3f} K, losses times temperatures {warm.product:.2f} W K"
        )
        print(f"  heat out over heat made {warm.reactions:.12f}", end=", ")
        print(f"by slope {warm.by_slope:.4f}; out of the primary {warm.winding:.4f}")
    if len(sys.argv) > 1:
        plot(second, sys.argv[1])
