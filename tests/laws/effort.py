"""How many examples each law gets."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from hypothesis import HealthCheck, Phase, settings

FACTOR = float(os.environ.get("LAWS", "1"))
"""The environment variable LAWS multiplies the number of examples and makes them random."""


def examples(count: int) -> Callable[[Any], Any]:
    """Settings for a law: by default a few examples, always the same ones."""
    return settings(
        max_examples=max(1, int(count * FACTOR)),
        deadline=None,
        derandomize=FACTOR == 1,
        database=None,
        print_blob=False,
        phases=(Phase.generate, Phase.shrink),
        suppress_health_check=list(HealthCheck),
    )
