"""The native JSON form: round trips, and a schema that says what is wrong."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from decomp import similarity
from decomp.csg.model import Ignored, Model, Region
from decomp.csg.primitives import (
    Block,
    Cone,
    Cylinder,
    EllipticCylinder,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    InfiniteEllipticCylinder,
    Sphere,
    Torus,
)
from decomp.csg.solid import (
    Complement,
    Copies,
    Difference,
    Intersection,
    Labelled,
    Solid,
    Transformed,
    Union,
    walk,
)
from decomp.errors import ParseError
from decomp.formats import loads
from decomp.formats.native import dumps
from decomp.vectors import norm, perpendicular
from tests.formats.membership import contains

coordinates = st.floats(-4, 4)
points = st.tuples(coordinates, coordinates, coordinates)
axes = points.filter(lambda v: max(map(abs, v)) > 1e-3)
sizes = st.floats(0.01, 4)
names = st.text(st.characters(codec="utf-8", categories=("L", "N")), min_size=1, max_size=6)
maybe_names = st.none() | names
numbers = st.integers() | st.floats(allow_nan=False, allow_infinity=False)
lengths = st.integers(1) | st.floats(0, exclude_min=True, allow_infinity=False)
texts = st.text(st.characters(codec="utf-8"), min_size=1, max_size=5)
of_faces = st.fixed_dictionaries(
    {}, optional={"maxh": lengths, "bc": st.integers(), "bcname": texts}
)
of_regions = st.fixed_dictionaries(
    {},
    optional={
        "maxh": lengths,
        "bc": st.integers(),
        "material": texts,
        "col": st.tuples(numbers, numbers, numbers),
        "transparent": st.booleans(),
        "layer": st.integers(),
    },
)


@st.composite
def cylinders(draw: st.DrawFn) -> Cylinder:
    base = np.array(draw(points))
    return Cylinder(base, base + draw(axes), draw(sizes), draw(maybe_names))


@st.composite
def elliptic_cylinders(draw: st.DrawFn) -> EllipticCylinder:
    base, axis = np.array(draw(points)), np.array(draw(axes))
    first = draw(sizes) * perpendicular(axis / norm(axis))
    return EllipticCylinder(base, base + axis, first, draw(sizes), draw(maybe_names))


@st.composite
def infinite_elliptic_cylinders(draw: st.DrawFn) -> InfiniteEllipticCylinder:
    first = np.array(draw(axes))
    second = draw(sizes) * perpendicular(first / norm(first))
    return InfiniteEllipticCylinder(draw(points), first, second, draw(maybe_names))


@st.composite
def cones(draw: st.DrawFn) -> Cone:
    base, radius = np.array(draw(points)), draw(sizes)
    top = draw(st.sampled_from([0.0, radius / 2, radius * 3]))
    return Cone(base, radius, base + draw(axes), top, draw(maybe_names))


@st.composite
def tori(draw: st.DrawFn) -> Torus:
    major = draw(sizes)
    minor = major * draw(st.floats(0.05, 0.95))
    return Torus(draw(points), draw(axes), major, minor, draw(maybe_names))


primitives = (
    st.builds(Block, points, st.tuples(sizes, sizes, sizes), maybe_names)
    | st.builds(Sphere, points, sizes, maybe_names)
    | cylinders()
    | cones()
    | tori()
    | st.builds(HalfSpace, points, axes, maybe_names)
    | st.builds(InfiniteCylinder, points, axes, sizes, maybe_names)
    | elliptic_cylinders()
    | infinite_elliptic_cylinders()
    | st.builds(InfiniteCone, points, axes, st.floats(1, 89), maybe_names)
)
moves = (
    st.builds(similarity.translation, points)
    | st.builds(similarity.rotation, axes, st.floats(-360, 360), points)
    | st.builds(similarity.reflection, axes, points)
    | st.builds(similarity.scaling, st.floats(0.1, 10), points)
)
moves |= st.builds(lambda a, b: a.after(b), moves, moves)


def grown(inner: st.SearchStrategy[Solid]) -> st.SearchStrategy[Solid]:
    lists = st.lists(inner, max_size=3).map(tuple)
    return (
        st.builds(Union, lists)
        | st.builds(Intersection, lists)
        | st.builds(Difference, inner, inner)
        | inner.map(lambda s: Difference(s, Complement(s)))
        | st.builds(Complement, inner)
        | st.builds(Transformed, inner, moves)
        | st.builds(Copies, inner, st.lists(moves, min_size=1, max_size=3).map(tuple))
        | st.builds(Labelled, inner, maybe_names, of_faces)
    )


solids = st.recursive(primitives, grown, max_leaves=6)
models = st.builds(
    Model,
    st.lists(
        st.builds(Region, names, solids, of_regions),
        min_size=1,
        max_size=3,
        unique_by=lambda r: r.name,
    ).map(tuple),
    st.text(st.characters(codec="utf-8"), max_size=8),
    st.lists(
        st.builds(Ignored, st.text(st.characters(codec="utf-8")), st.integers(1, 9)), max_size=2
    ).map(tuple),
)


@given(models)
@settings(max_examples=150, deadline=None)
def test_round_trip_is_exact(model: Model) -> None:
    text = dumps(model)
    again = loads(text, "json", name="another")
    assert dumps(again) == text
    assert again.name == model.name
    assert again.ignored == model.ignored
    for a, b in zip(model.regions, again.regions, strict=True):
        assert a.name == b.name
        assert dict(a.options) == dict(b.options)


@given(solids)
@settings(max_examples=100, deadline=None)
def test_round_trip_keeps_every_point(solid: Solid) -> None:
    again = loads(dumps(Model((Region("a", solid),))), "json").regions[0].solid
    cloud = np.random.default_rng(1).uniform(-6, 6, (200, 3))
    np.testing.assert_array_equal(contains(solid, cloud), contains(again, cloud))


@given(solids)
@settings(max_examples=50, deadline=None)
def test_round_trip_keeps_sharing(solid: Solid) -> None:
    shared = Union((solid, Complement(solid)))
    again = loads(dumps(Model((Region("a", shared), Region("b", solid)))), "json")
    assert len(list(walk([r.solid for r in again.regions]))) == len(list(walk([shared])))
    assert again.regions[1].solid is again.regions[0].solid.children()[0]


def test_numpy_options_become_plain() -> None:
    given_options = {"col": np.array([1.0, 0.5, 0]), "bc": np.int64(3), "maxh": np.float32(0.5)}
    text = dumps(Model((Region("a", Sphere((0, 0, 0), 1), given_options),)))
    found = dict(loads(text, "json").regions[0].options)
    assert found == {"col": (1.0, 0.5, 0.0), "bc": 3, "maxh": 0.5}


def document() -> dict[str, Any]:
    return {
        "format": "decomp",
        "version": 1,
        "name": "m",
        "regions": [{"name": "a", "solid": 1, "options": {}}],
        "ignored": [],
        "nodes": [
            {"type": "sphere", "name": "s", "centre": [0, 0, 0], "radius": 1},
            {
                "type": "transformed",
                "part": 0,
                "by": {
                    "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
                    "scale": 1,
                    "offset": [1, 2, 3],
                },
            },
        ],
    }


def test_a_small_document() -> None:
    model = loads(json.dumps(document()), "json")
    tree = model.regions[0].solid
    assert isinstance(tree, Transformed)
    assert isinstance(tree.part, Sphere)
    assert tree.part.name == "s"


def test_what_may_be_left_out() -> None:
    short = document()
    del short["name"], short["ignored"], short["regions"][0]["options"], short["nodes"][0]["name"]
    assert loads(json.dumps(short), "json", name="n").name == "n"


def change(*keys: Any, to: Any = None) -> Callable[[dict[str, Any]], None]:
    """A change at a place of the document; a removal where `to` is None."""

    def apply(top: Any) -> None:
        for key in keys[:-1]:
            top = top[key]
        if to is None:
            del top[keys[-1]]
        else:
            top[keys[-1]] = to

    return apply


CHANGES = {
    "no format": (change("format"), "the file has no 'format'"),
    "other format": (change("format", to="stl"), "must be 'decomp', not \"stl\""),
    "newer": (change("version", to=2), "version 2 is not known"),
    "no regions": (change("regions"), "the file has no 'regions'"),
    "empty regions": (change("regions", to=[]), "has no region"),
    "no nodes": (change("nodes"), "the file has no 'nodes'"),
    "nodes as object": (change("nodes", to={}), "nodes must be a list"),
    "node as number": (change("nodes", 0, to=5), r"nodes\[0\] must be an object"),
    "unknown type": (change("nodes", 0, "type", to="egg"), r"nodes\[0\] has an unknown type 'egg'"),
    "odd type": (change("nodes", 0, "type", to=[]), r"nodes\[0\].type must be a text"),
    "no radius": (change("nodes", 0, "radius"), r"nodes\[0\] has no 'radius'"),
    "negative": (
        change("nodes", 0, "radius", to=-1),
        r"nodes\[0\]: sphere radius must be positive",
    ),
    "text radius": (change("nodes", 0, "radius", to="1"), r"nodes\[0\].radius must be a number"),
    "true radius": (change("nodes", 0, "radius", to=True), "must be a number, not true"),
    "huge": (change("nodes", 0, "radius", to=10**400), r"nodes\[0\].radius must be finite"),
    "two numbers": (change("nodes", 0, "centre", to=[0, 0]), "must be three numbers, not 2"),
    "unknown key": (change("nodes", 0, "radus", to=1), "unknown key 'radus'; known are"),
    "unknown top key": (change("extra", to=1), "the file has an unknown key 'extra'"),
    "bad name": (change("nodes", 0, "name", to="a b"), "'a b' cannot be a name"),
    "part itself": (change("nodes", 1, "part", to=1), r"nodes\[1\].part is 1, which is no node"),
    "part below": (change("nodes", 1, "part", to=-1), r"nodes\[1\].part is -1"),
    "part text": (change("nodes", 1, "part", to="0"), "must be a whole number"),
    "region index": (change("regions", 0, "solid", to=2), r"regions\[0\].solid is 2"),
    "region name": (change("regions", 0, "name", to=""), "cannot be a name"),
    "region option": (
        change("regions", 0, "options", to=[]),
        r"regions\[0\].options must be an obj",
    ),
    "unknown option": (
        change("regions", 0, "options", to={"maxH": 1}),
        r"regions\[0\].options has an unknown option 'maxH'; there are maxh ",
    ),
    "wrong option": (
        change("regions", 0, "options", to={"maxh": None}),
        r"option maxh of regions\[0\].options must be a length above zero, got None",
    ),
    "deep option": (
        change("regions", 0, "options", to={"col": [[[[0]]]]}),
        r"option col of regions\[0\].options must be three numbers",
    ),
    "option of a region": (
        change(
            *("nodes", 1),
            to={"type": "labelled", "part": 0, "name": "x", "options": {"material": "tin"}},
        ),
        r"nodes\[1\].options has an unknown option 'material', which is an option of regions",
    ),
    "shear": (change("nodes", 1, "by", "rotation", 0, 1, to=1), "must be an orthogonal matrix"),
    "two rows": (change("nodes", 1, "by", "rotation", 2), "must be an orthogonal matrix"),
    "no scale": (change("nodes", 1, "by", "scale", to=0), "scale must be positive"),
    "bad line": (change("ignored", to=[{"statement": "x", "line": "1"}]), "must be a whole number"),
}


@pytest.mark.parametrize("case", CHANGES)
def test_schema_errors(case: str) -> None:
    apply, message = CHANGES[case]
    wrong = document()
    apply(wrong)
    with pytest.raises(ParseError, match=message):
        loads(json.dumps(wrong), "json", path="m.json")


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity", "1e999"])
def test_numbers_must_be_finite(word: str) -> None:
    text = json.dumps(document()).replace('"radius": 1', f'"radius": {word}')
    with pytest.raises(ParseError, match="finite"):
        loads(text, "json")


def test_wrong_json_has_line_and_column() -> None:
    with pytest.raises(ParseError, match="expecting") as caught:
        loads('{\n "format": decomp}', "json")
    assert (caught.value.line, caught.value.column) == (2, 12)


@pytest.mark.parametrize("start", ["[", '{"a":'])
def test_deep_json_is_an_error_in_words(start: str) -> None:
    with pytest.raises(ParseError, match="nested too deep"):
        loads(start * 100_000, "json")


def test_digits_without_end() -> None:
    with pytest.raises(ParseError, match="no usable JSON"):
        loads("1" * 10_000, "json")


@pytest.mark.parametrize("text", ["3", "null", '"decomp"', "[]"])
def test_other_json_is_refused(text: str) -> None:
    with pytest.raises(ParseError, match="the file must be an object"):
        loads(text, "json")
