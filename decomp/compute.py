"""The old place of `decomp.skeletons.compute`, for scripts that import it. It goes next."""

from __future__ import annotations

import warnings

from decomp.skeletons.compute import skeleton as skeleton

warnings.warn(
    "decomp.compute has moved, and is private: `decomp.skeleton` computes skeletons",
    DeprecationWarning,
    stacklevel=2,
)
