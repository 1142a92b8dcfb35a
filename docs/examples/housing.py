"""An open housing with thin walls, lugs for screws and a hole for a cable, under pressure inside.

Half of it is meshed. It is held in the holes of its lugs; the lid and what closes the hole for the
cable carry their own load. What must hold:

- forces balance: the screws keep the pressure on the floor, p A, and along x that on the piece of
  wall that faces the hole, p pi r^2, as all other pressure on walls is in pairs. These are by
  reactions; the pressure's area is that of the elements' curved sides;
- the floor bends as a square plate between one whose edges are free to turn and one whose edges are
  clamped: by 0.00406 and by 0.00126 p a^4 / D in its middle, with D = E t^3 / (12 (1 - nu^2)).
  Reference: Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, tables 8 and 35. Shear,
  which these leave out, adds some parts in a hundred.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
import skfem
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, eye, sym_grad, trace

import decomp

INSIDE, DEEP, WALL = 40.0, 20.0, 3.0
"""The cavity's side and depth, and the thickness of walls and floor, in mm as all lengths."""
LUG, SCREW, CABLE = 6.0, 3.0, 6.0
"""Radii."""
YOUNG, POISSON = 70e3, 0.33
PRESSURE = 0.1
"""In MPa, as Young's modulus."""
SIZE = 4.0
GROUPS = {
    "floor": "cavity.zmin",
    "walls": ["cavity.x*", "cavity.y*"],
    "screws": "screw*.side",
    "middle": "half.ymin",
}
BOUNDS = 0.00126, 0.00406
"""Of the floor's bending, by a^4 p / D."""


@dataclass(frozen=True)
class Loaded:
    """A solution.

    Attributes:
        up: what the screws hold along z, over the pressure on the floor.
        along: ... along x, over the pressure on the hole's section.
        bending: of the floor's middle against its edges, by p a^4 / D.
    """

    up: float
    along: float
    bending: float


def model() -> decomp.Solid:
    """The half with y > 0."""
    reach = INSIDE / 2 + WALL
    outside = decomp.Block.between((-reach, -reach, -WALL), (reach, reach, DEEP), name="outside")
    cavity = decomp.Block((-INSIDE / 2, -INSIDE / 2, 0), (INSIDE, INSIDE, DEEP + 1), name="cavity")
    at = reach + 3.0

    def upright(radius: float, beyond: float, name: str) -> decomp.Solid:
        low, high = -WALL - beyond, DEEP + beyond
        rod = decomp.Cylinder((at, at, low), (at, at, high), radius, name=name)
        return rod.polar_copies((0, 0, 1), 4)

    cable = decomp.Cylinder((0, 0, DEEP / 2), (2 * reach, 0, DEEP / 2), CABLE, name="cable")
    half = decomp.Block((-100, 0, -100), (200, 100, 200), name="half")
    body = (outside | upright(LUG, 0, "lug")) - cavity - upright(SCREW, 1, "screw") - cable
    return body & half


def meshed(size: float) -> decomp.TetMesh:
    """Of order 2, with edges up to a size in mm."""
    return decomp.mesh({"housing": model()}, size=size, order=2, groups=GROUPS, cells="none")


def stress(strain: np.ndarray) -> np.ndarray:
    """Of an isotropic material, in MPa."""
    lame = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    return YOUNG / (1 + POISSON) * strain + lame * eye(trace(strain), 3)


def solved(made: decomp.TetMesh) -> Loaded:
    """Under the pressure."""
    mesh = made.to_skfem()
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()))
    form = skfem.BilinearForm(lambda u, v, w: ddot(stress(sym_grad(u)), sym_grad(v)))
    matrix = form.assemble(basis)
    pressed = skfem.FacetBasis(mesh, basis.elem, facets=["floor", "walls"])
    load = skfem.LinearForm(lambda v, w: -PRESSURE * (w.n * v).sum(axis=0)).assemble(pressed)
    screws = basis.get_dofs("screws")
    free = basis.complement_dofs(screws, basis.get_dofs("middle").all(["u^2"]))
    u = basis.zeros()
    inner = matrix[free][:, free].tocsc()
    factors = splu(inner, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    u[free] = factors.solve(load[free])
    kept = matrix @ u - load
    up, along = (float(kept[screws.all([way])].sum()) for way in ("u^3", "u^1"))
    # the floor's edges are where its nodes are the walls' too
    floor, walls = (basis.get_dofs(name).all(["u^3"]) for name in ("floor", "walls"))
    edges = np.intersect1d(floor, walls)
    centre = floor[np.argmin(np.abs(basis.doflocs[:2, floor]).sum(axis=0))]
    stiff = YOUNG * WALL**3 / (12 * (1 - POISSON**2))
    bending = float(u[edges].mean() - u[centre]) * stiff / (PRESSURE * INSIDE**4)
    floor_area, hole_area = INSIDE**2 / 2, pi * CABLE**2 / 2
    return Loaded(up / (PRESSURE * floor_area), along / (PRESSURE * hole_area), bending)


if __name__ == "__main__":
    made = meshed(SIZE)
    loaded = solved(made)
    print(f"held by the screws: {loaded.up:.12f} of what presses on the floor,", end=" ")
    print(f"{loaded.along:.6f} of what presses opposite to the hole")
    print(f"the floor's bending {loaded.bending:.5f} p a^4 / D, between", *BOUNDS)
