"""Which method finds the intersection of which pair.

1. Parallel planes' lines, conics of planes with cylinders, elliptic ones and cones, lines of
   parallel cylinders, circles of coaxial pairs: closed form.
2. Quadrics whose pencil holds a pair of planes: conics in these planes.
3. Everything else: one carrier's rulings or tube circles are met with the other carrier.
"""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, EllipticCylinder, Plane
from decomp.curves.intersect.coaxial import coaxial, common_axis
from decomp.curves.intersect.elliptic import plane_elliptic_cylinder
from decomp.curves.intersect.general import general
from decomp.curves.intersect.parallel import parallel_cylinders
from decomp.curves.intersect.pencil import plane_pair
from decomp.curves.intersect.planes import plane_cone, plane_cylinder, plane_plane
from decomp.curves.intersect.result import Intersection, Window
from decomp.errors import ContactError
from decomp.vectors import Array


def intersect(
    a: Carrier, b: Carrier, centre: Array, radius: float, tolerance: float
) -> Intersection:
    """Find all of the intersection of two carriers inside a ball.

    Args:
        a: a carrier.
        b: another one, not the same surface.
        centre: centre of the ball.
        radius: its radius; infinite curves are cut off near it, closed ones are kept whole.
        tolerance: carriers that miss each other by no more than this count as touching.

    Raises:
        ContactError: the carriers coincide, or touch in a way that cannot be resolved.
    """
    window = Window(np.asarray(centre, dtype=np.float64), float(radius), float(tolerance))
    if a.coincides(b, tolerance, radius):
        raise ContactError(f"{a.kind} and {b.kind} are the same surface")
    if (a.code, a.packed().tolist()) > (b.code, b.packed().tolist()):
        a, b = b, a
    found = _closed_form(a, b, window)
    if found is None:
        found = plane_pair(a, b, window)
    return general(a, b, window) if found is None else found


def _closed_form(a: Carrier, b: Carrier, window: Window) -> Intersection | None:
    if isinstance(a, Plane) and isinstance(b, Plane):
        return plane_plane(a, b, window)
    if isinstance(a, Plane) and isinstance(b, Cylinder):
        return plane_cylinder(a, b, window)
    if isinstance(a, Plane) and isinstance(b, Cone):
        return plane_cone(a, b, window)
    if isinstance(a, Cylinder) and isinstance(b, Cylinder):
        found = parallel_cylinders(a, b, window)
        if found is not None:
            return found
    if isinstance(a, Plane) and isinstance(b, EllipticCylinder):
        return plane_elliptic_cylinder(a, b, window)
    if not (a.revolved and b.revolved):
        return None
    axis = common_axis(a, b, window)
    if axis is None:
        return None
    origin, direction, off = axis
    found = coaxial(a, b, origin, direction, window)
    touching = len(found.contacts) or any(c.tangent for c in found.curves)
    return found if off <= window.exact or touching else None
