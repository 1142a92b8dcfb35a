"""A bolted flange joint: two flanges, a gasket and bolts, each with a name, and nothing by number.

A quarter is meshed, with a bolt in its middle. It goes through holes with play, and touches the
flanges below its head and above its nut alone. Parts stick to each other where they meet.

- Tightening: the bolt is made shorter by a strain e, and presses on the upper flange below its
  head. By springs in a row the force is e l / (1 / k_b + 1 / k_g + 1 / k_f), where l is the
  clamped length: k_b of the bolt, where head and nut count as 0.4 of a diameter of shank each; k_g
  of the gasket and k_f of the flanges' rings, E A over their thickness. Reference: VDI 2230, part 1
  (2015). It leaves out how flanges bend, and is right to some parts in a hundred here.
- Pulling at the pipe: the lower pipe's end holds what is pulled above, and bolt and gasket together
  carry it. By reactions, and by the stress integrated where flange and gasket meet, which knows
  nothing of them and is right as far as elements are small.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np
import skfem
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import SuperLU, splu
from skfem.helpers import ddot, eye, sym_grad, trace

import decomp

BORE, PIPE, OUTER, THICK, PIPE_LENGTH = 25.0, 31.0, 60.0, 25.0, 15.0
"""Radii, the flanges' thickness and how far pipes reach beyond: in mm, as all lengths."""
GASKET = 3.0
CIRCLE, SHANK, HOLE, HEAD, HEAD_HIGH = 44.0, 6.0, 8.0, 11.0, 8.0
"""Radii: of the circle of bolts, of shank, hole and head."""
CLAMPED = 2 * THICK + GASKET
STEEL = (210e3, 0.3)
MATERIAL = {"lower": STEEL, "upper": STEEL, "gasket": (200.0, 0.0), "bolt": STEEL}
"""Young's modulus in MPa, and Poisson's ratio."""
SHRINK = 1e-3
PULL = 5e3
"""On the quarter, in N."""
SIZE = 10.0
HEAD_FACE, GASKET_FACE = "below the head", "on the gasket"
GROUPS = {
    "left": "*/quarter.xmin",
    "front": "*/quarter.ymin",
    HEAD_FACE: "upper/*|bolt/*",
    GASKET_FACE: "upper/*|gasket/*",
}


def parts() -> dict[str, decomp.Solid]:
    """The regions; z = 0 is the lower flange's back."""

    def rod(radius: float, low: float, high: float, name: str, at: float = 0.0) -> decomp.Solid:
        return decomp.Cylinder((at, at, low), (at, at, high), radius, name=name)

    middle = CIRCLE / 2**0.5
    low, high = -PIPE_LENGTH, CLAMPED + PIPE_LENGTH
    quarter = decomp.Block.between(
        (0, 0, low - 1), (OUTER + 1, OUTER + 1, high + 1), name="quarter"
    )
    free = rod(BORE, low - 1, high + 1, "bore") | rod(HOLE, -1, CLAMPED + 1, "hole", middle)
    lower = rod(PIPE, low, THICK / 2, "pipe") | rod(OUTER, 0, THICK, "ring")
    upper = rod(PIPE, CLAMPED - THICK / 2, high, "pipe") | rod(
        OUTER, CLAMPED - THICK, CLAMPED, "ring"
    )
    bolt = (
        rod(SHANK, -HEAD_HIGH, CLAMPED + HEAD_HIGH, "shank", middle)
        | rod(HEAD, CLAMPED, CLAMPED + HEAD_HIGH, "head", middle)
        | rod(HEAD, -HEAD_HIGH, 0, "nut", middle)
    )
    return {
        "lower": (lower - free) & quarter,
        "upper": (upper - free) & quarter,
        "gasket": (rod(OUTER, THICK, THICK + GASKET, "gasket") - free) & quarter,
        "bolt": bolt,
    }


def meshed(size: float) -> decomp.TetMesh:
    """Of order 2, with edges up to a size in mm."""
    return decomp.mesh(parts(), size=size, order=2, groups=GROUPS, cells="none")


@dataclass(frozen=True)
class Joint:
    """A mesh with its matrices, by names alone.

    Attributes:
        mesh: of order 2, with the groups of `GROUPS`.
    """

    mesh: skfem.Mesh

    @cached_property
    def basis(self) -> skfem.CellBasis:
        """Of displacements."""
        return skfem.Basis(self.mesh, skfem.ElementVector(skfem.ElementTetP2()))

    @cached_property
    def stiffness(self) -> dict[str, csr_matrix]:
        """Of each region."""
        return {name: elastic(name).assemble(self.part(name)) for name in MATERIAL}

    @cached_property
    def held(self) -> np.ndarray:
        """Numbers of the displacements that are zero: by symmetry, and along z at the lower end."""
        kept = {"left": "u^1", "front": "u^2", "lower/pipe.base": "u^3"}
        return np.unique(
            np.concatenate([self.basis.get_dofs(on).all([way]) for on, way in kept.items()])
        )

    @cached_property
    def factors(self) -> SuperLU:
        """Of the whole matrix, where it is free."""
        free = self.basis.complement_dofs(self.held)
        matrix = sum(self.stiffness.values())[free][:, free].tocsc()
        options = {"SymmetricMode": True}
        return splu(matrix, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)

    def part(self, name: str) -> skfem.CellBasis:
        """The elements of a region."""
        return skfem.Basis(self.mesh, self.basis.elem, elements=name)

    def solved(self, load: np.ndarray) -> np.ndarray:
        """Displacements under a load."""
        u = self.basis.zeros()
        free = self.basis.complement_dofs(self.held)
        u[free] = self.factors.solve(load[free])
        return u

    def force(self, u: np.ndarray, region: str, on: str) -> float:
        """Along z, that keeps a region, which nothing else loads, in place where a group is."""
        nodes = self.basis.get_dofs(on).all(["u^3"])
        return float((self.stiffness[region] @ u)[nodes].sum())


def stress(strain: np.ndarray, region: str) -> np.ndarray:
    """Of an isotropic material, in MPa."""
    young, poisson = MATERIAL[region]
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    return young / (1 + poisson) * strain + lame * eye(trace(strain), 3)


def elastic(region: str) -> skfem.BilinearForm:
    """Virtual work."""
    return skfem.BilinearForm(lambda u, v, w: ddot(stress(sym_grad(u), region), sym_grad(v)))


def tightened(joint: Joint) -> float:
    """What the bolt presses on the flange below its head with, in N, when it is made shorter."""
    tension = MATERIAL["bolt"][0] * SHRINK
    shorter = skfem.LinearForm(lambda v, w: -tension * sym_grad(v)[2, 2])
    return -joint.force(joint.solved(shorter.assemble(joint.part("bolt"))), "upper", HEAD_FACE)


def by_springs() -> float:
    """The same, of three springs in a row."""
    steel, gasket = MATERIAL["bolt"][0], MATERIAL["gasket"][0]
    ring = pi * (OUTER**2 - BORE**2) / 4 - pi * HOLE**2
    bolt = (CLAMPED + 2 * 0.4 * 2 * SHANK) / (steel * pi * SHANK**2)
    return SHRINK * CLAMPED / (bolt + GASKET / (gasket * ring) + 2 * THICK / (steel * ring))


def pulled(joint: Joint) -> tuple[float, float, float]:
    """Over the pull: what holds the lower end; what gasket and bolt carry, by reactions.

    The third is that with the gasket's part by the stress on it.
    """
    elements = joint.basis.elem
    end = skfem.LinearForm(lambda v, w: v[2]).assemble(
        skfem.FacetBasis(joint.mesh, elements, facets="upper/pipe.top")
    )
    u = joint.solved(end * PULL / end.sum())
    held = -joint.force(u, "lower", "lower/pipe.base")
    head, gasket = (-joint.force(u, "upper", on) for on in (HEAD_FACE, GASKET_FACE))
    meet = skfem.FacetBasis(joint.mesh, elements, facets=GASKET_FACE)
    along = skfem.Functional(lambda w: -(stress(sym_grad(w["u"]), "upper")[2] * w.n).sum(axis=0))
    by_stress = float(along.assemble(meet, u=meet.interpolate(u)))
    return tuple(force / PULL for force in (held, head + gasket, head + by_stress))


if __name__ == "__main__":
    joint = Joint(meshed(SIZE).to_skfem())
    found, theory = tightened(joint), by_springs()
    print(f"tightened: {found:.0f} N, by springs {theory:.0f}: off by {found / theory - 1:.1e}")
    held, carried, by_stress = pulled(joint)
    print(f"pulled: held over the pull {held:.12f}, carried {carried:.12f}", end=", ")
    print(f"by the stress on the gasket {by_stress:.4f}")
