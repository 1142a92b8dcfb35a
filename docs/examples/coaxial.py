"""The capacitance of a coaxial line with two layers of insulation, as two regions.

C / L = 2 pi / (ln(c / a) / e1 + ln(b / c) / e2), in units of the vacuum's permittivity.
Reference: Jackson, Classical Electrodynamics, section 1.11, for layers in series.
"""

from __future__ import annotations

from math import log, pi

import numpy as np
import skfem
from skfem.helpers import dot, grad

import decomp

INNER, BETWEEN, OUTER, LENGTH = 0.5, 0.7, 1.0, 0.4
PERMITTIVITY = {"core": 4.0, "shell": 1.0}
EXACT = 2 * pi / (log(BETWEEN / INNER) / 4.0 + log(OUTER / BETWEEN) / 1.0)


def capacitance(size: float, order: int = 2) -> float:
    """For each unit of length."""

    def rod(radius: float, name: str, beyond: float = 0.0) -> decomp.Solid:
        return decomp.Cylinder((0, 0, -beyond), (0, 0, LENGTH + beyond), radius, name=name)

    core = rod(BETWEEN, "middle") - rod(INNER, "wire", 1.0)
    shell = rod(OUTER, "outside") - rod(BETWEEN, "middle", 1.0)
    mesh = decomp.mesh({"core": core, "shell": shell}, size=size, order=order).to_skfem()
    element = skfem.ElementTetP1() if order == 1 else skfem.ElementTetP2()
    basis = skfem.Basis(mesh, element)
    stiffness = 0
    for region, value in PERMITTIVITY.items():
        part = skfem.Basis(mesh, element, elements=region)
        form = skfem.BilinearForm(lambda u, v, w: dot(grad(u), grad(v)))
        stiffness = stiffness + value * form.assemble(part)
    wire = basis.get_dofs("core/wire.side").all()
    earth = basis.get_dofs("shell/outside.side").all()
    u = basis.zeros()
    u[wire] = 1.0
    u = skfem.solve(*skfem.condense(stiffness, x=u, D=np.union1d(wire, earth)))
    return float(u @ stiffness @ u) / LENGTH


if __name__ == "__main__":
    found = capacitance(0.15)
    print(f"C / L = {found:.5f}, exactly {EXACT:.5f}: off by {found / EXACT - 1:.1e}")
