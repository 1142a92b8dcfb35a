"""How long the command line takes to start: best and median of several runs.

python benchmarks/startup.py
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from pathlib import Path

MODEL = Path(__file__).parent.parent / "meshes" / "flange.geo"
RUNS = 7


def seconds(*arguments: str) -> list[float]:
    """Wall times of `decomp` with some arguments, after one run that is not counted."""
    times = []
    for _ in range(RUNS + 1):
        start = time.perf_counter()
        command = [sys.executable, "-m", "decomp.cli.main", *arguments]
        subprocess.run(command, check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    return times[1:]


def main() -> None:
    """Print a table."""
    bare = []
    for _ in range(RUNS):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", "pass"], check=True)
        bare.append(time.perf_counter() - start)
    rows = [("python -c pass", bare), ("decomp --help", seconds("--help"))]
    rows.append((f"decomp info {MODEL.name}", seconds("info", str(MODEL))))
    print(f"{'command':<24} {'best s':>8} {'median s':>9} {'/ bare':>7}")
    for name, times in rows:
        ratio = statistics.median(times) / statistics.median(bare)
        print(f"{name:<24} {min(times):8.3f} {statistics.median(times):9.3f} {ratio:7.1f}")


if __name__ == "__main__":
    main()
