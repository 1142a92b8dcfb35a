"""scikit-fem solves Laplace's equation on two regions, with the mesh's own names.

With conductivity 1 on the left, 3 on the right, u = 0 at x = 0 and u = 1 at x = 2, u is linear on
each side of the interface x = 1: it is 3/4 there, and the flux is 3/4 throughout.
"""

from __future__ import annotations

import numpy as np
import pytest
import skfem
from skfem.helpers import dot, grad

from tests.meshes.shapes import bar, quadratic


@pytest.mark.parametrize("order", [1, 2])
def test_laplace(order: int) -> None:
    mesh = bar() if order == 1 else quadratic(bar())
    made = mesh.to_skfem()
    basis = skfem.Basis(made, skfem.ElementTetP1() if order == 1 else skfem.ElementTetP2())
    conductivity = basis.with_element(skfem.ElementTetP0()).zeros() + 1.0
    conductivity[made.subdomains["right"]] = 3.0
    field = basis.with_element(skfem.ElementTetP0()).interpolate(conductivity)

    @skfem.BilinearForm
    def energy(u, v, w):  # type: ignore[no-untyped-def]
        return w.k * dot(grad(u), grad(v))

    matrix = energy.assemble(basis, k=field)
    cold = basis.get_dofs("left/left.xmin")
    hot = basis.get_dofs("right/right.xmax")
    u = basis.zeros()
    u[hot] = 1.0
    u = skfem.solve(*skfem.condense(matrix, x=u, D=np.concatenate([cold.all(), hot.all()])))
    x = basis.doflocs[0]
    assert np.abs(u - np.where(x < 1, 0.75 * x, 0.75 + 0.25 * (x - 1))).max() < 1e-12

    @skfem.Functional
    def flux(w):  # type: ignore[no-untyped-def]
        return dot(grad(w.u), w.n)

    # out of the left region through the interface, whose triangles point from left to right
    facets = skfem.FacetBasis(made, basis.elem, facets="left|right")
    assert flux.assemble(facets, u=facets.interpolate(u)) == pytest.approx(0.75, rel=1e-10)
    inner = skfem.FacetBasis(made, basis.elem, facets="left:front|back")
    assert abs(flux.assemble(inner, u=inner.interpolate(u))) < 1e-12


@pytest.mark.parametrize("bend", [0.0, 0.2])
def test_volumes(bend: float) -> None:
    """Bent elements keep their volume only if their middle nodes are where they belong."""
    mesh = quadratic(bar(), bend)
    made = mesh.to_skfem()
    one = skfem.Functional(lambda w: 1.0 + 0 * w.x[0])
    basis = skfem.Basis(made, skfem.ElementTetP2(), intorder=6)
    assert one.assemble(basis) == pytest.approx(2.0, rel=1e-12)
    for name, volume in (("left/front", 0.5), ("left", 1.0), ("right/side", 1.0)):
        part = skfem.Basis(made, skfem.ElementTetP2(), elements=name, intorder=6)
        assert one.assemble(part) == pytest.approx(volume, rel=1e-12)
