"""Heat through the wall of a hollow cylinder, with elements of order 1 and 2.

The inner side is at 1, the outer at 0, the ends are insulated, the conductivity is 1. Exactly
T = ln(r / b) / ln(a / b), and 2 pi L / ln(b / a) of heat flows through.
Reference: Incropera and DeWitt, Fundamentals of Heat and Mass Transfer, section 3.3.
"""

from __future__ import annotations

import sys
from math import log, pi

import numpy as np
import skfem
from skfem.helpers import dot, grad

import decomp

INNER, OUTER, LENGTH = 0.5, 1.0, 0.5


def solved(size: float, order: int) -> tuple[float, float, float]:
    """Mean edge length; errors of the temperature (L2, relative) and of the heat flow (relative).

    The length is that of a regular tetrahedron of the mesh's mean volume.
    """
    tube = decomp.Cylinder((0, 0, 0), (0, 0, LENGTH), OUTER, name="tube")
    hole = decomp.Cylinder((0, 0, -1), (0, 0, 1), INNER, name="hole")
    mesh = decomp.mesh(tube - hole, size=size, order=order).to_skfem()
    basis = skfem.Basis(mesh, skfem.ElementTetP1() if order == 1 else skfem.ElementTetP2())
    stiffness = skfem.BilinearForm(lambda u, v, w: dot(grad(u), grad(v))).assemble(basis)
    hot = basis.get_dofs("solid/hole.side").all()
    cold = basis.get_dofs("solid/tube.side").all()
    t = basis.zeros()
    t[hot] = 1.0
    t = skfem.solve(*skfem.condense(stiffness, x=t, D=np.union1d(hot, cold)))

    def exact(x: np.ndarray) -> np.ndarray:
        return np.log(np.hypot(x[0], x[1]) / OUTER) / log(INNER / OUTER)

    off = skfem.Functional(lambda w: (w["t"] - exact(w.x)) ** 2)
    whole = skfem.Functional(lambda w: exact(w.x) ** 2)
    square = off.assemble(basis, t=basis.interpolate(t)) / whole.assemble(basis)
    flow = float(t @ stiffness @ t) / (2 * pi * LENGTH / log(OUTER / INNER)) - 1
    volume = pi * (OUTER**2 - INNER**2) * LENGTH / mesh.nelements
    return float(np.cbrt(volume * 72**0.5)), float(np.sqrt(square)), flow


def convergence(sizes: tuple[float, ...], order: int) -> tuple[list[float], list[float], float]:
    """Edge lengths, errors of the temperature, and the slope of their logarithms."""
    lengths, errors, _ = map(list, zip(*(solved(size, order) for size in sizes), strict=True))
    return lengths, errors, float(np.polyfit(np.log(lengths), np.log(errors), 1)[0])


def plot(found: dict[int, tuple[list[float], list[float], float]], path: str) -> None:
    """Errors against edge lengths."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.figure(figsize=(5, 4))
    for (order, (lengths, errors, slope)), colour in zip(
        found.items(), ("#0072B2", "#D55E00"), strict=True
    ):
        plt.loglog(lengths, errors, "o-", color=colour, label=f"order {order}, rate {slope:.1f}")
    plt.xlabel("edge length")
    plt.ylabel("relative error of the temperature (L2)")
    plt.grid(True, which="both", alpha=0.3)
    plt.legend()
    plt.tight_layout()
    plt.savefig(path, dpi=120)


if __name__ == "__main__":
    found = {order: convergence((0.2, 0.14, 0.1, 0.07), order) for order in (1, 2)}
    for order, (lengths, errors, slope) in found.items():
        print(f"order {order}: rate {slope:.2f}, at lengths", *(f"{h:.3f}" for h in lengths))
        print("  errors", *(f"{error:.2e}" for error in errors))
    print(f"heat flow, order 2: off by {solved(0.14, 2)[2]:.1e}")
    if len(sys.argv) > 1:
        plot(found, sys.argv[1])
