"""How many designs put together at random have a skeleton, and why the others have none.

Run: python -m benchmarks.random_designs [--count 100] [--first 0] [--oblique] [--limit 60]

It is `python -m benchmarks.success --designs parallel` (or `oblique`) by another name.
"""

from __future__ import annotations

import argparse

from benchmarks.designs import design as design
from benchmarks.success import counted, designs


def main() -> None:
    """Compute all designs and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="seed of the first")
    parser.add_argument("--oblique", action="store_true", help="axes in any direction")
    parser.add_argument("--limit", type=int, default=60, help="seconds of computing for one design")
    options = parser.parse_args()
    counted(designs(options.count, options.first, options.oblique), None, "traced", options.limit)


if __name__ == "__main__":
    main()
