"""The lowest eigenvalues of Laplace's operator in a solid torus, fixed on its surface.

There is no closed form. With the angle u about the axis, modes are cos(m u) or sin(m u) times a
function f of the section, a disk at the distance R from the axis, where

    -(f_rr + f_r / r + f_zz) + m^2 / r^2 f = k f,    f = 0 on the circle.

The reference is this problem in two dimensions, solved by Ritz's method with polynomials that
vanish on the circle; their integrals come out to rounding by Gauss's rule, and eigenvalues stop
changing in the tenth digit at degree 8. It knows nothing of meshes. A mode with m > 0 has an
eigenvalue that counts twice. For a thin torus they tend to (2.404826 / a)^2 + (m^2 - 1/4) / R^2, as
the first zero of the Bessel function of order 0 tells, with a the radius of the section.
"""

from __future__ import annotations

from math import pi

import numpy as np
import skfem
from numpy.polynomial.legendre import leggauss
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigsh, splu
from skfem.helpers import dot, grad

import decomp

MAJOR, MINOR = 1.0, 0.4


def in_the_section(m: int, count: int, degree: int = 14, radius: float = MINOR) -> np.ndarray:
    """The lowest eigenvalues of modes that turn m times, by polynomials on the disk, ascending."""
    rho, weights = leggauss(2 * degree)
    angles = 2 * pi * np.arange(4 * degree) / (4 * degree)
    rho = (rho + 1) / 2
    x, z = (np.multiply.outer(rho, f(angles)).ravel() for f in (np.cos, np.sin))
    weights = np.repeat(weights / 2 * rho * 2 * pi / angles.size, angles.size)
    # polynomials T_i(x) T_j(z) (1 - x^2 - z^2) and their derivatives, shape (functions, points)
    t = np.polynomial.chebyshev
    eye = np.eye(degree + 1)
    of, slope = ([[t.chebval(s, t.chebder(row, k)) for row in eye] for s in (x, z)] for k in (0, 1))
    pairs = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
    bubble = 1 - x**2 - z**2
    f = np.array([of[0][i] * of[1][j] * bubble for i, j in pairs])
    f_x = np.array([of[1][j] * (slope[0][i] * bubble - 2 * x * of[0][i]) for i, j in pairs])
    f_z = np.array([of[0][i] * (slope[1][j] * bubble - 2 * z * of[1][j]) for i, j in pairs])
    r = MAJOR + radius * x
    stiffness = (f_x * (weights * r)) @ f_x.T + (f_z * (weights * r)) @ f_z.T
    stiffness = stiffness / radius**2 + (f * (weights * m**2 / r)) @ f.T
    return eigh(stiffness, (f * (weights * r)) @ f.T, eigvals_only=True)[:count]


def reference(count: int, degree: int = 14) -> np.ndarray:
    """The lowest eigenvalues of the torus, ascending, those with m > 0 twice."""
    found = [k for m in range(count) for k in [*in_the_section(m, count, degree)] * (1 + (m > 0))]
    return np.sort(found)[:count]


def eigenvalues(size: float, count: int) -> np.ndarray:
    """The lowest on a mesh with curved elements of order 2, ascending."""
    torus = decomp.Torus((0, 0, 0), (0, 0, 1), MAJOR, MINOR, name="torus")
    mesh = decomp.mesh(torus, size=size, order=2).to_skfem()
    basis = skfem.Basis(mesh, skfem.ElementTetP2())
    stiffness = skfem.BilinearForm(lambda u, v, w: dot(grad(u), grad(v))).assemble(basis)
    mass = skfem.BilinearForm(lambda u, v, w: u * v).assemble(basis)
    free = basis.complement_dofs(basis.get_dofs("solid/torus.surface"))
    a, b = stiffness[free][:, free].tocsc(), mass[free][:, free]
    factors = splu(a, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    inverse = LinearOperator(a.shape, factors.solve)
    return np.sort(eigsh(a, k=count, M=b, sigma=0.0, OPinv=inverse, return_eigenvectors=False))


if __name__ == "__main__":
    for value, exact in zip(eigenvalues(0.15, 7), reference(7), strict=True):
        print(f"{value:.5f}, in two dimensions {exact:.5f}: off by {value / exact - 1:.1e}")
