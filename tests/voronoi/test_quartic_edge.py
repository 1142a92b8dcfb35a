"""The edge of two cylinders whose axes meet at a right angle: a degree, though no equation."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from flint import Ordering, fmpq, fmpq_mpoly_ctx, fmpq_poly

from decomp.carriers import Cylinder
from decomp.curves import intersect
from decomp.voronoi import Kind, PlaneSite, surface

RING = fmpq_mpoly_ctx.get(("t", "v"), Ordering.lex)
T, V = RING.gens()
A, B, HEIGHT = fmpq(3, 10), fmpq(1, 10), fmpq(1, 5)
"""Radii about the z axis and the x axis, and how far the plane is below both."""
Line = list[tuple[fmpq, fmpq]]


def on_line(line: Line) -> fmpq_poly:
    """What vanishes where the points x + t u of a line are as far from the edge as from the plane.

    At a point (u, v, w) of the edge u^2 = A^2 - v^2 and w^2 = B^2 - v^2. That p = (x, y, z) is in
    its normal plane at the distance d of the plane is

        x v w - y u w + z u v = u v w   and   2 x u + 2 z w = S,

    S = x^2 + y^2 + z^2 + A^2 + B^2 - d^2 - v^2 - 2 y v. The second gives u and w, linear in both
    and their squares known; then v is eliminated. Places without u and w so found are divided out.
    """
    x, y, z = (a + b * T for a, b in line)
    u2, w2 = A**2 - V**2, B**2 - V**2
    s = x**2 + y**2 + z**2 + A**2 + B**2 - (z + HEIGHT) ** 2 - V**2 - 2 * y * V
    # u = p / (4 x s), w = q / (4 z s)
    p, q = s**2 + 4 * x**2 * u2 - 4 * z**2 * w2, s**2 + 4 * z**2 * w2 - 4 * x**2 * u2
    one = p**2 - 16 * x**2 * s**2 * u2
    two = 4 * V * s * (x**2 * q + z**2 * p) - (y + V) * p * q
    found = one.resultant(two, "v")
    for extra in (x, z, s.resultant(x**2 * u2 - z**2 * w2, "v")):
        while not len((parts := divmod(found, extra))[1]):
            found = parts[0]
    coefficients = {int(e[0]): c for e, c in found.to_dict().items()}
    return fmpq_poly([coefficients.get(k, 0) for k in range(max(coefficients) + 1)])


def edge_and_plane():  # type: ignore[no-untyped-def]
    x, _, z = np.eye(3)
    found = intersect(Cylinder(0 * x, z, 0.3), Cylinder(0 * x, x, 0.1), 0 * x, 2.0, 1e-12)
    (edge,) = [c.curve for c in found.curves if c.curve.samples[0, 0] > 0]
    return surface(PlaneSite((0, 0, "-1/5"), (0, 0, 1)), edge, "even")


@pytest.mark.parametrize("seed", range(3))
def test_degree_is_24(seed: int) -> None:
    """That of a line in general position; its true points are among the zeros."""
    found = edge_and_plane()
    assert found.kind is Kind.GENERAL
    assert found.polynomial is None and found.degree is None
    assert found.remark is not None and "none that is known" in found.remark
    rng = np.random.default_rng(seed)
    on = found.project(np.array([0.5, 0.1, 0.1]) + rng.uniform(-0.05, 0.05, size=3))
    start = [fmpq(int(k), 2**20) for k in np.round(on * 2**20)]
    way = [fmpq(int(k), 64) for k in rng.integers(-64, 64, size=3)]
    equation = on_line(list(zip(start, way, strict=True)))
    assert equation.degree() == 24
    assert [n for _, n in equation.factor()[1]] == [1]

    def point(t: float) -> np.ndarray:
        return np.array(
            [
                float(Fraction(str(a))) + t * float(Fraction(str(b)))
                for a, b in zip(start, way, strict=True)
            ]
        )

    zeros = np.array([complex(z) for z, _ in equation.complex_roots()])
    real = zeros.real[np.abs(zeros.imag) < 1e-12]
    t = float(real[np.argmin(np.abs(real))])
    assert abs(t) < 1e-3
    assert abs(float(found.difference(point(t)))) <= 1e-12
