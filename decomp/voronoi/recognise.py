"""From how two sites lie to each other to the kind of their Voronoi surface."""

from __future__ import annotations

from decomp.voronoi.coaxial import coaxial_surface
from decomp.voronoi.common_apex import about_one_sphere
from decomp.voronoi.differences import (
    ball_and_tube,
    equal_tubes,
    level_rings,
    parallel_tubes,
    tubes_for_cones,
    two_planes,
)
from decomp.voronoi.focal import focal_form, focal_surface
from decomp.voronoi.found import Found
from decomp.voronoi.position import Axis, aligned, common_axis
from decomp.voronoi.rings import ring_and_level_tube, threaded_rings
from decomp.voronoi.sites import (
    CarrierSite,
    ConeSite,
    CylinderSite,
    PlaneSite,
    SphereSite,
    TorusSite,
)


def recognise(
    f: CarrierSite, g: CarrierSite, e: int, tolerance: float, angle: float
) -> Found | None:
    """Shape and polynomial of the surface s_f = e s_g, None if it is of no special kind.

    Args:
        f, g: the sites.
        e: +1 for the even surface, -1 for the odd one.
        tolerance: lengths below it count as zero.
        angle: angles (radians) below it count as zero.

    Raises:
        InputError: the sites coincide.
    """
    axis = common_axis(f, g, tolerance, angle)
    if axis is not None:
        return coaxial_surface(f, g, e, axis, tolerance, angle)
    if isinstance(f, PlaneSite) and isinstance(g, PlaneSite):
        return two_planes(f, g, e)
    form = focal_form(f, g, e, tolerance)
    if form is not None:
        return focal_surface(form, tolerance, angle)
    if isinstance(f, SphereSite) and isinstance(g, CylinderSite):
        equal = abs(float(f.radius - e * g.radius)) <= tolerance
        return ball_and_tube(f, g) if equal else None
    if isinstance(f, CylinderSite) and isinstance(g, SphereSite):
        return recognise(g, f, e, tolerance, angle)
    if isinstance(f, CylinderSite) and isinstance(g, CylinderSite):
        if aligned(f.axis, g.axis, angle):
            return parallel_tubes(f, g, e, tolerance, angle)
        equal = abs(float(f.radius - e * g.radius)) <= tolerance
        return equal_tubes(f, g, tolerance) if equal else None
    if isinstance(f, ConeSite) and isinstance(g, ConeSite) and aligned(f.axis, g.axis, angle):
        tubes = tubes_for_cones(f, g, e, angle)
        return None if tubes is None else parallel_tubes(*tubes, e, tolerance, angle)
    if isinstance(f, TorusSite) and isinstance(g, TorusSite) and aligned(f.axis, g.axis, angle):
        level = abs(float(Axis(f.centre, f.axis).height(g.centre))) <= tolerance
        equal = abs(float(f.minor - e * g.minor)) <= tolerance
        return level_rings(f, g, tolerance, angle) if level and equal else None
    if isinstance(f, CylinderSite) and isinstance(g, TorusSite):
        return recognise(g, f, e, tolerance, angle)
    if isinstance(f, TorusSite) and isinstance(g, CylinderSite):
        equal = abs(float(f.minor - e * g.radius)) <= tolerance
        return ring_and_level_tube(f, g, tolerance, angle) if equal else None
    if isinstance(f, TorusSite) and isinstance(g, TorusSite):
        threaded = threaded_rings(f, g, e, tolerance, angle)
        if threaded is not None:
            return threaded
    return about_one_sphere(f, g, e, tolerance, angle)
