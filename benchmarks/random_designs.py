"""How many designs put together at random have a skeleton, and why the others have none.

Run: python -m benchmarks.random_designs [--count 100] [--first 0] [--oblique] [--limit 60]

A design is a block with one to three parts added or cut out: blocks, cylinders, spheres and cones
at random places, through faces, edges and corners alike. Their axes are parallel to the block's
edges, with --oblique not all of them. Each is computed in this process, with a limit of wall
seconds; the last lines count the errors by their words.
"""

from __future__ import annotations

import argparse
import re
import signal
import time
from collections import Counter
from types import FrameType

import numpy as np

import decomp
from decomp.csg.solid import Solid
from decomp.vectors import Array


def design(seed: int, oblique: bool = False) -> Solid:
    """A solid of its own for every seed."""
    rng = np.random.default_rng(seed)
    sides = rng.uniform(2, 5, 3)
    solid: Solid = decomp.Block((0, 0, 0), sides, name="base")
    for k in range(int(rng.integers(1, 4))):
        part = _part(rng, sides, oblique, f"part{k}")
        solid = solid | part if rng.random() < 0.5 else solid - part
    return solid


def _part(rng: np.random.Generator, sides: Array, oblique: bool, name: str) -> Solid:
    kind = rng.choice(["block", "cylinder", "cylinder", "sphere", "cone"])
    centre = rng.uniform(-0.1, 1.1, 3) * sides
    radius, length = rng.uniform(0.2, 0.45) * sides.min(), rng.uniform(0.6, 2.5) * sides.min()
    axis = np.eye(3)[rng.integers(3)]
    turn, angle = rng.normal(size=3), 0.0
    if oblique and rng.random() < 0.5:
        axis, angle = turn / np.linalg.norm(turn), float(rng.uniform(0, 360))
    start, end = centre - axis * length / 2, centre + axis * length / 2
    if kind == "sphere":
        return decomp.Sphere(centre, radius, name=name)
    if kind == "cylinder":
        return decomp.Cylinder(start, end, radius, name=name)
    if kind == "cone":
        return decomp.Cone(start, radius, end, 0.4 * radius, name=name)
    half = np.array([radius, 1.3 * radius, length / 2])
    return decomp.Block(-half, half, name=name).rotate(turn, angle).translate(centre)


def outcome(solid: Solid, limit: int) -> str:
    """`certified`, or the error in words that do not tell of the place."""

    def over(number: int, frame: FrameType | None) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, over)
    signal.alarm(limit)
    try:
        decomp.skeleton(solid)
        return "certified"
    except TimeoutError:
        return f"over {limit} s"
    except decomp.DecompError as error:
        return _words(str(error))
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def _words(message: str) -> str:
    """A message without places, numbers and names of sites."""
    text = re.sub(r"\([^)]*\)", "P", message)
    text = re.sub(r"\b(base|part\d)[\w.|@]*", "S", text)
    return re.sub(r"\d[\d.e-]*", "N", text)[:90]


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="seed of the first")
    parser.add_argument("--oblique", action="store_true", help="axes in any direction")
    parser.add_argument("--limit", type=int, default=60, help="seconds for one design")
    options = parser.parse_args()
    found: Counter[str] = Counter()
    for seed in range(options.first, options.first + options.count):
        start = time.perf_counter()
        what = outcome(design(seed, options.oblique), options.limit)
        found[what] += 1
        print(f"{seed}: {what} ({time.perf_counter() - start:.1f} s)", flush=True)
    print()
    for what, count in found.most_common():
        print(f"{count:4d}  {what}")


if __name__ == "__main__":
    main()
