"""Whether a mesh will fit into memory, told before a mesher is started."""

from __future__ import annotations

import os
from math import ceil, floor, log10
from pathlib import Path

from decomp.errors import InputError

BYTES_PER_TET = 2000
"""What a mesh takes for each of its tetrahedra: on blocks of 4,000 to 66,000, TetWild grew by 700
bytes for each and decomp by 1,200 (highest resident sizes)."""
CGROUP = Path("/sys/fs/cgroup")
MEMINFO = Path("/proc/meminfo")


def check_memory(tets: float, size: float | None = None, available: int | None = None) -> None:
    """Refuse what cannot fit.

    Args:
        tets: how many tetrahedra are expected.
        size: the largest edge that alone asks for so many, in model units.
        available: bytes; by default what the machine has free, and no check where it cannot tell.

    Raises:
        InputError: there is too little memory; says what size would do.
    """
    have = available_memory() if available is None else available
    need = tets * BYTES_PER_TET
    if have is None or need <= have:
        return
    advice = "longer edges or fewer layers make fewer"
    if size is not None:
        advice = f"a size of {_rounded_up(size * (need / have) ** (1 / 3))} makes as many as fit"
    raise InputError(
        f"the mesh would have some {tets:.1e} tetrahedra, which take {_gigabytes(need)} of memory, "
        f"but {_gigabytes(have)} are free: {advice}"
    )


def available_memory() -> int | None:
    """Bytes that this process and its children may still take, None where nothing tells."""
    found = [value for value in (_free(), _left_in_group()) if value is not None]
    return min(found) if found else None


def _free() -> int | None:
    """What Linux can give without swapping; elsewhere all memory that there is."""
    if MEMINFO.exists():
        for line in MEMINFO.read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None


def _left_in_group() -> int | None:
    """What a container's limit leaves."""
    limit, used = CGROUP / "memory.max", CGROUP / "memory.current"
    if not limit.exists() or not used.exists():
        return None
    text = limit.read_text().strip()
    return None if text == "max" else max(0, int(text) - int(used.read_text()))


def _gigabytes(size: float) -> str:
    return f"{size / 1e9:,.{1 if size < 1e11 else 0}f} GB"


def _rounded_up(length: float) -> str:
    """With two digits, not below it."""
    unit = 10.0 ** (floor(log10(length)) - 1)
    return f"{ceil(length / unit) * unit:.2g}"
