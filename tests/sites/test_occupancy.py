"""Membership and the on-boundary test against plain evaluation of the program."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from decomp.csg.halfspaces import HalfSpaceForm, half_space_form
from decomp.csg.model import model
from decomp.csg.primitives import HalfSpace, Sphere
from decomp.csg.solid import Solid, intersection
from decomp.sites import on_boundary as kernels
from decomp.sites.occupancy import labels_of, occupancy_tree, private
from decomp.sites.on_boundary import NOWHERE
from tests.sites.random_solids import trees
from tests.sites.reference import accepted, clear_of, labels

on_boundary = njit(kernels.on_boundary.py_func)
BOX = np.array([[-3.0, -3, -3], [3, 3, 3]])


def check(form: HalfSpaceForm, seed: int, box: np.ndarray = BOX) -> None:
    rng = np.random.default_rng(seed)
    occupancy = private(occupancy_tree(form, box))
    points = rng.uniform(box[0], box[1], (2000, 3))
    found = np.empty(len(points), dtype=np.int32)
    labels_of(occupancy, points, found)
    np.testing.assert_array_equal(found, labels(form, points))
    for k, carrier in enumerate(form.carriers):
        feet = carrier.project(points[:60])
        feet = feet[((feet > box[0]) & (feet < box[1])).all(axis=1)]
        feet = feet[clear_of(form, feet, 1e-9, k)]
        for label in range(-1, len(form.program.roots)):
            there = [on_boundary(occupancy, label, k, *q) != NOWHERE for q in feet]
            np.testing.assert_array_equal(there, accepted(form, label, k, feet))


@settings(max_examples=60, deadline=None)
@given(trees, st.integers(0, 999))
def test_octree_equals_program(tree: Solid, seed: int) -> None:
    check(half_space_form(model(tree), 10.0), seed)


@settings(max_examples=30, deadline=None)
@given(st.lists(trees, min_size=2, max_size=4), st.integers(0, 999))
def test_octree_equals_program_for_several_regions(parts: list[Solid], seed: int) -> None:
    # later regions leave out the earlier ones, so that they are disjoint
    regions, taken = {}, parts[0]
    for k, part in enumerate(parts):
        regions[f"r{k}"] = part if k == 0 else part - taken
        taken = taken | part
    check(half_space_form(model(regions), 10.0), seed)


def pyramid(sides: int) -> Solid:
    """Many planes through one point."""
    angles = np.arange(sides) * 2 * np.pi / sides
    normals = [(np.cos(a), np.sin(a), 0.7) for a in angles]
    return intersection([HalfSpace((0.1, 0.2, 0.3), n) for n in normals])


def fan(blades: int) -> Solid:
    """Many planes through one line, inside and outside in turn."""
    angles = np.arange(blades) * np.pi / blades
    planes = [HalfSpace((0.1, 0.2, 0), (np.cos(a), np.sin(a), 0)) for a in angles]
    result: Solid = planes[0]
    for plane in planes[1:]:
        result = (result - plane) | (plane - result)
    return result


def onion(skins: int, gap: float) -> Solid:
    """Nearly coincident spheres."""
    balls = [Sphere((0.1, 0, 0), 1 + k * gap) for k in range(2 * skins)]
    result: Solid = balls[0]
    for inner, outer in zip(balls[1::2], balls[2::2], strict=False):
        result = result | (outer - inner)
    return result


@pytest.mark.parametrize("solid", [pyramid(12), fan(9), onion(4, 1e-3), onion(4, 1e-7)])
def test_crowded_places(solid: Solid) -> None:
    check(half_space_form(model(solid), 10.0), 1)
    near = np.array([[0.0999, 0.1999, 0.2999], [0.1001, 0.2001, 0.3001]])
    check(half_space_form(model(solid), 10.0), 2, near)


def test_many_planes_meet_in_a_boundary_point() -> None:
    form = half_space_form(model(pyramid(12)), 10.0)
    occupancy = private(occupancy_tree(form, BOX))
    apex = (0.1, 0.2, 0.3)
    assert all(on_boundary(occupancy, 0, k, *apex) != NOWHERE for k in range(12))
    for k in range(12):
        above = (0.1, 0.2, 0.4)
        assert on_boundary(occupancy, 0, k, *form.carriers[k].foot(np.array(above))) == NOWHERE
