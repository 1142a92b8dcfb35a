"""The lowest eigenvalues of Laplace's operator in the unit ball, fixed on the sphere.

They are squares of the zeros of spherical Bessel functions: pi^2 once, 4.493409...^2 three times.
Reference: Abramowitz and Stegun, Handbook of Mathematical Functions, table 10.6.
"""

from __future__ import annotations

from math import pi

import numpy as np
import skfem
from scipy.sparse.linalg import eigsh
from skfem.helpers import dot, grad

import decomp

EXACT = np.array([pi**2, *[4.493409457909064**2] * 3])


def eigenvalues(size: float) -> np.ndarray:
    """The four lowest, with elements of order 2."""
    ball = decomp.Sphere((0, 0, 0), 1, name="ball")
    mesh = decomp.mesh(ball, size=size, order=2).to_skfem()
    basis = skfem.Basis(mesh, skfem.ElementTetP2())
    stiffness = skfem.BilinearForm(lambda u, v, w: dot(grad(u), grad(v))).assemble(basis)
    mass = skfem.BilinearForm(lambda u, v, w: u * v).assemble(basis)
    free = basis.complement_dofs(basis.get_dofs("solid/ball.surface"))
    a, b = stiffness[free][:, free], mass[free][:, free]
    return np.sort(eigsh(a, k=4, M=b, sigma=0.0, return_eigenvectors=False))


if __name__ == "__main__":
    found = eigenvalues(0.3)
    for value, exact in zip(found, EXACT, strict=True):
        print(f"{value:.5f}, exactly {exact:.5f}: off by {value / exact - 1:.1e}")
