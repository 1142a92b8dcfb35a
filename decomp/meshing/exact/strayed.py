"""Nodes that are off the surface of a boundary triangle that has them.

Where faces meet tangentially a node can be on one face and in a triangle of the other.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.meshing.naming.tagging import Tagged
from decomp.meshing.surface.layout import Layout
from decomp.vectors import Array, Ints


def strayed(points: Array, tagged: Tagged, plan: Layout, elements: Elements, least: float) -> Ints:
    """The nodes, ascending.

    Args:
        points: (n, 3) nodes.
        tagged: triangles with their patches.
        plan: tells which patches are faces or interfaces.
        elements: of its complex.
        least: nodes that are farther off are told.
    """
    outer = np.array([bool(sides) for sides in plan.sides])[tagged.patches]
    patches = np.repeat(tagged.patches[outer], 3)
    nodes, patches = np.unique(np.stack([tagged.triangles[outer].reshape(-1), patches]), axis=1)
    gap = elements.gap(np.asarray(elements.of_patch)[patches], points[nodes])
    return np.unique(nodes[gap > least])
