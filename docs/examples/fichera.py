"""The singularity at a Fichera corner, from the lowest eigenvalue of Laplace's operator beside it.

An octant is cut out of the unit ball and the boundary is fixed. In spherical coordinates the
variables separate: the first mode is J_(q + 1/2)(sqrt(k) r) / sqrt(r) times a function of the
direction, so its eigenvalue k is the square of the first zero of the Bessel function of order
q + 1/2. At the corner the mode, like every solution of Poisson's equation there, grows as r^q, and
q can be read from the eigenvalue.

Reference: q = 0.45417371533061, the figure that circulates as the published exponent of Dirichlet's
problem at the Fichera vertex (the table it comes from was not at hand). Elements of high order on
the sphere without the octant, in the plane by stereographic projection and graded towards the three
edges, gave 0.454174.

At the three reentrant edges solutions grow with the power 2/3 of the distance. On meshes of one
size the eigenvalue's error therefore goes down with the power 4/3 of the size in the end, with
elements of any order (Babuska and Osborn, Eigenvalue problems, Handbook of Numerical Analysis II,
1991): with order 2 it soon does, with order 1 the smooth part of the error, of power 2, counts on.
"""

from __future__ import annotations

import sys

import numpy as np
import skfem
from scipy.optimize import brentq
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, splu
from scipy.special import jv
from skfem.helpers import dot, grad

import decomp

EXPONENT = 0.45417371533061
POWER = 4 / 3
SIZES = (0.2, 0.14, 0.1)
"""Longer edges than the first would be shortened on the sphere alone."""


def first_zero(order: float) -> float:
    """The first positive zero of the Bessel function of an order between 1/2 and 2."""
    return float(brentq(lambda x: jv(order, x), 3.0, 5.2, xtol=1e-14))


EXACT = first_zero(EXPONENT + 0.5) ** 2


def exponent(eigenvalue: float) -> float:
    """The exponent at the corner that belongs to an eigenvalue."""
    return float(brentq(lambda q: first_zero(q + 0.5) ** 2 - eigenvalue, 0.01, 1.4, xtol=1e-13))


def factored(a: csr_matrix) -> SuperLU:
    """A symmetric positive definite matrix, with less fill than by the general choice."""
    symmetric = {"SymmetricMode": True}
    return splu(a.tocsc(), "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric)


def meshed(size: float, order: int) -> skfem.Mesh:
    """The ball without the octant; nodes of order 2 lie on the exact sphere."""
    ball = decomp.Sphere((0, 0, 0), 1, name="ball")
    octant = decomp.Block((0, 0, 0), (2, 2, 2), name="octant")
    made = decomp.mesh(ball - octant, size=size, order=order)
    return made.to_skfem()


def solved(mesh: skfem.Mesh, order: int) -> tuple[float, float]:
    """Mean edge length and the lowest eigenvalue, with elements of an order."""
    basis = skfem.Basis(mesh, skfem.ElementTetP1() if order == 1 else skfem.ElementTetP2())
    stiffness = skfem.BilinearForm(lambda u, v, w: dot(grad(u), grad(v))).assemble(basis)
    mass = skfem.BilinearForm(lambda u, v, w: u * v).assemble(basis)
    free = basis.complement_dofs(basis.get_dofs())
    a, b = stiffness[free][:, free], mass[free][:, free]
    inverse = LinearOperator(a.shape, factored(a).solve)
    (lowest,) = eigsh(a, k=1, M=b, sigma=0.0, OPinv=inverse, return_eigenvectors=False)
    volume = 4 / 3 * np.pi * 7 / 8 / mesh.nelements
    return float(np.cbrt(volume * 72**0.5)), float(lowest)


def convergence(sizes: tuple[float, ...], order: int) -> tuple[list[float], list[float], float]:
    """Edge lengths, eigenvalues, and the slope of the logarithms of the relative errors."""
    lengths, found = map(
        list, zip(*(solved(meshed(size, order), order) for size in sizes), strict=True)
    )
    errors = np.array(found) / EXACT - 1
    return lengths, found, float(np.polyfit(np.log(lengths), np.log(errors), 1)[0])


def extrapolated(lengths: list[float], found: list[float]) -> float:
    """The exponent for edge length 0, from eigenvalues whose errors go down with the power 4/3."""
    return exponent(float(np.polyfit(np.array(lengths) ** POWER, found, 1)[1]))


def plot(results: dict[int, tuple[list[float], list[float], float]], path: str) -> None:
    """Relative errors of the eigenvalue against edge lengths."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FixedLocator, NullLocator

    _, axes = plt.subplots(figsize=(5, 4))
    for (order, (lengths, found, slope)), colour in zip(
        results.items(), ("#0072B2", "#D55E00"), strict=True
    ):
        errors = np.array(found) / EXACT - 1
        plt.loglog(lengths, errors, "o-", color=colour, label=f"order {order}, rate {slope:.1f}")
    longest, shortest = max(lengths), min(lengths)
    guide = 0.8 * errors[-1] * (np.array([longest, shortest]) / shortest) ** POWER
    plt.loglog([longest, shortest], guide, "--", color="0.4", label="rate 4/3")
    axes.xaxis.set_major_locator(FixedLocator([0.1, 0.12, 0.14, 0.16, 0.18]))
    axes.xaxis.set_major_formatter("{x:.2f}")
    axes.xaxis.set_minor_locator(NullLocator())
    plt.xlabel("edge length")
    plt.ylabel("relative error of the eigenvalue")
    plt.grid(True, which="both", alpha=0.3)
    plt.legend()
    plt.tight_layout()
    plt.savefig(path, dpi=120)


if __name__ == "__main__":
    results = {order: convergence(SIZES, order) for order in (1, 2)}
    for order, (lengths, found, slope) in results.items():
        print(f"order {order}: rate {slope:.2f}, at lengths", *(f"{h:.3f}" for h in lengths))
        print("  eigenvalues", *(f"{k:.4f}" for k in found), f"exactly {EXACT:.4f}")
    q = extrapolated(*results[2][:2])
    print(f"exponent {q:.4f}, published {EXPONENT:.4f}: off by {q / EXPONENT - 1:.1e}")
    if len(sys.argv) > 1:
        plot(results, sys.argv[1])
