"""A heat sink of aluminium on a chip: how much heat leaves for each kelvin.

The chip is warmed evenly, air takes heat away from the fins and from the base between them, all
other faces are insulated. The seven fins part the base's top into eight pieces, which are one group
by their face's name, `sink/base.zmax`.

Reference: straight fins of rectangular section with a warm tip, of length L, perimeter P and
section A give off h P tanh(m L') / m for each kelvin of their foot, with m^2 = h P / (k A) and
L' = L + A / P, the length with the tip's area added to the sides. Fins and the free part of the
base make the conductance from the base's top to the air: Incropera and DeWitt, Fundamentals of
Heat and Mass Transfer, section 3.6. How much warmer the chip is the elements tell alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import tanh

import numpy as np
import skfem
from skfem.helpers import dot, grad

import decomp

FINS, PITCH, THICK, HEIGHT, DEEP, BASE = 7, 5.0, 1.5, 20.0, 20.0, 4.0
"""In mm, as all lengths; fins stand inside the base's ends by half a gap."""
WIDTH = FINS * PITCH
CHIP = (12.0, 12.0, 2.0)
CONDUCTIVITY = {"sink": 0.2, "chip": 0.12}
"""In W / (mm K)."""
AIR = 2e-4
"""In W / (mm^2 K): a strong fan."""
POWER = 10.0
"""In W."""
SIZE = 2.0
GROUPS = {"cooled": ["sink/fin*.x*", "sink/fin*.zmax"], "between": "sink/base.zmax"}


def by_fin_theory() -> float:
    """Heat to the air for each kelvin of the base's top, in W / K.

    The fins' ends (y) are insulated: their perimeter is that of two sides.
    """
    m = (2 * AIR / (CONDUCTIVITY["sink"] * THICK)) ** 0.5
    length = HEIGHT + THICK / 2
    fin = 2 * AIR * DEEP * tanh(m * length) / m
    return FINS * fin + AIR * (WIDTH - FINS * THICK) * DEEP


@dataclass(frozen=True)
class Warm:
    """A solution.

    Attributes:
        conductance: heat to the air for each kelvin that the base's top is above it, in W / K.
        balance: heat to the air over the chip's.
        pressed: heat through the face where chip and sink meet, over the chip's.
        chip: the chip's greatest temperature above the air, in K.
    """

    conductance: float
    balance: float
    pressed: float
    chip: float


def meshed(size: float, order: int = 2) -> decomp.TetMesh:
    """The regions `sink` and `chip`, with edges up to a size in mm."""
    base = decomp.Block((0, 0, 0), (WIDTH, DEEP, BASE), name="base")
    first = decomp.Block(((PITCH - THICK) / 2, 0, BASE), (THICK, DEEP, HEIGHT), name="fin")
    fins = first.linear_copies((PITCH, 0, 0), FINS)
    corner = ((WIDTH - CHIP[0]) / 2, (DEEP - CHIP[1]) / 2, -CHIP[2])
    chip = decomp.Block(corner, CHIP, name="chip")
    part = {"sink": base | fins, "chip": chip}
    return decomp.mesh(part, size=size, order=order, groups=GROUPS, cells="none")


def solved(made: decomp.TetMesh) -> Warm:
    """With elements of the mesh's order."""
    mesh = made.to_skfem()
    element = skfem.ElementTetP1() if made.order == 1 else skfem.ElementTetP2()
    basis = skfem.Basis(mesh, element)
    on = {name: skfem.Basis(mesh, element, elements=name) for name in CONDUCTIVITY}
    inner = {name: k * conduction.assemble(on[name]) for name, k in CONDUCTIVITY.items()}
    between, cooled = (
        skfem.FacetBasis(mesh, element, facets=name) for name in ("between", "cooled")
    )
    to_air = AIR * (mass.assemble(between) + mass.assemble(cooled))
    source = unit.assemble(on["chip"])
    load = POWER / np.prod(CHIP) * source
    t = skfem.solve(inner["sink"] + inner["chip"] + to_air, load)
    area = unit.assemble(between)
    leaves = float((to_air @ t).sum())
    # what the sink's own nodes take in where the chip is pressed on it
    meet = basis.get_dofs("sink/base.zmin|chip/chip.zmax").all()
    pressed = float((inner["sink"] @ t)[meet].sum())
    top = float(area @ t / area.sum())
    return Warm(leaves / top, leaves / POWER, pressed / POWER, float(t.max()))


@skfem.BilinearForm
def conduction(u: skfem.DiscreteField, v: skfem.DiscreteField, w: object) -> np.ndarray:
    """Of conductivity 1."""
    return dot(grad(u), grad(v))


@skfem.BilinearForm
def mass(u: skfem.DiscreteField, v: skfem.DiscreteField, w: object) -> np.ndarray:
    """Of a film of conductance 1 on a face."""
    return u * v


@skfem.LinearForm
def unit(v: skfem.DiscreteField, w: object) -> np.ndarray:
    """A source of 1."""
    return 1.0 * v


if __name__ == "__main__":
    warm = solved(meshed(SIZE))
    theory = by_fin_theory()
    print(f"{warm.conductance:.4f} W/K, by fin theory {theory:.4f}:", end=" ")
    print(f"off by {warm.conductance / theory - 1:.1e}")
    print(f"heat to the air over the chip's {warm.balance:.12f}, into the sink {warm.pressed:.12f}")
    print(f"the chip is at most {warm.chip:.2f} K above the air")
