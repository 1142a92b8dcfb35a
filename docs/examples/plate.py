"""A plate with a hole under tension: how much larger the stress is at the hole.

Reference for a finite width W and diameter d: Heywood, Designing by Photoelasticity (1952):
K = 2 + (1 - d / W)^3 of the mean stress in the narrowest section. A quarter of the plate is meshed,
with symmetry on two sides; it is thin, with Poisson's ratio 0.3.
"""

from __future__ import annotations

import numpy as np
import skfem
from skfem.helpers import ddot, eye, sym_grad, trace

import decomp

RADIUS, HALF_WIDTH, HALF_LENGTH, THICK = 1.0, 5.0, 8.0, 0.5
POISSON = 0.3
NARROW = 1 - RADIUS / HALF_WIDTH
EXACT = 2 + NARROW**3


def concentration(size: float, per_circle: float) -> float:
    """Stress along the pull at the hole over the mean one in the narrowest section.

    It is the mean over the thickness, as it varies there and the reference is of plane stress.
    """
    plate = decomp.Block((0, 0, 0), (HALF_LENGTH, HALF_WIDTH, THICK), name="plate")
    hole = decomp.Cylinder((0, 0, -1), (0, 0, THICK + 1), RADIUS, name="hole")
    made = decomp.mesh(plate - hole, size=size, elements_per_circle=per_circle, order=2)
    mesh = made.to_skfem()
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()))
    mu = 1 / (2 * (1 + POISSON))
    lame = POISSON / ((1 + POISSON) * (1 - 2 * POISSON))

    def stress(e: np.ndarray) -> np.ndarray:
        return 2 * mu * e + lame * eye(trace(e), 3)

    form = skfem.BilinearForm(lambda u, v, w: ddot(stress(sym_grad(u)), sym_grad(v)))
    pull = skfem.FacetBasis(mesh, basis.elem, facets="solid/plate.xmax")
    load = skfem.LinearForm(lambda v, w: v[0]).assemble(pull)
    sides = (("xmin", "u^1"), ("ymin", "u^2"), ("zmin", "u^3"))
    held = [basis.get_dofs(f"solid/plate.{side}").all([name]) for side, name in sides]
    u = skfem.solve(*skfem.condense(form.assemble(basis), load, D=np.unique(np.concatenate(held))))
    scalar = basis.with_element(skfem.ElementTetP2())
    pulled = scalar.project(stress(sym_grad(basis.interpolate(u)))[0, 0])
    x, y, z = scalar.doflocs
    crown = np.flatnonzero((np.abs(x) < 1e-9) & (np.abs(y - RADIUS) < 1e-9))
    crown = crown[np.argsort(z[crown])]
    return float(np.trapezoid(pulled[crown], z[crown])) / THICK * NARROW


if __name__ == "__main__":
    found = concentration(1.0, 60)
    print(f"K = {found:.3f}, by Heywood {EXACT:.3f}: off by {found / EXACT - 1:.1e}")
