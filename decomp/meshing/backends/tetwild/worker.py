"""The child process in which fTetWild runs: `python -P worker.py IN.npz OUT.npz SECONDS`.

It is a script of its own, run by path and without the rest of the package: fTetWild may crash, hang
or end the process, and it starts sooner this way. Its extension module is loaded without its
package, whose import takes longer than some meshes because it needs pyvista. Its standard input is
a pipe whose end tells it to end too (`decomp/processes/lifeline.py`).
"""

from __future__ import annotations

import importlib.util
import io
import math
import sys
from pathlib import Path
from types import ModuleType

VERSION = "0.4.2"
"""Of pytetwild, whose extension's arguments are given by place."""
MISSING = 3
"""Exit code: pytetwild is not installed."""
FULL = 4
"""Exit code: the result cannot be written; stderr says why."""
SPENT = 24
"""Signal that ends it when its seconds of computing are spent (SIGXCPU)."""
LIFELINE = Path(__file__).parents[3] / "processes" / "lifeline.py"


def extension() -> ModuleType:
    """pytetwild's extension module.

    Raises:
        ImportError: pytetwild is not installed, or is another one.
    """
    package = importlib.util.find_spec("pytetwild")
    if package is None or package.origin is None:
        raise ImportError("pytetwild is not installed")
    for file in sorted(Path(package.origin).parent.glob("PyfTetWildWrapper*")):
        if file.suffix in (".so", ".pyd"):
            return loaded("PyfTetWildWrapper", file)
    raise ImportError("pytetwild has no extension module")


def loaded(name: str, file: Path) -> ModuleType:
    """The module in a file.

    Raises:
        ImportError: the file holds none.
    """
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"{file} is no module")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def limit_work(seconds: float) -> None:
    """Ask the system to end this process when it has computed for so long."""
    if math.isfinite(seconds) and sys.platform != "win32":
        import resource

        whole = math.ceil(seconds)
        # where a batch system, or `ulimit -t`, allows less, it is not to be raised
        allowed = resource.getrlimit(resource.RLIMIT_CPU)[1]
        most = whole + 5 if allowed == resource.RLIM_INFINITY else min(whole + 5, allowed)
        resource.setrlimit(resource.RLIMIT_CPU, (min(whole, most), most))


def main(source: str, target: str, seconds: str) -> int:
    loaded("lifeline", LIFELINE).die_with_parent()
    limit_work(float(seconds))
    # only now: whatever takes time comes after the watch has begun
    import numpy as np

    try:
        wrapper = extension()
    except ImportError as error:
        print(error, file=sys.stderr)
        return MISSING
    given = np.load(source)
    points, tets = wrapper.tetrahedralize_mesh(
        given["points"],
        given["triangles"].astype(np.uint32),
        True,  # optimize
        not bool(given["simplify"]),
        0.05,  # edge length relative to the diagonal: not used, an absolute one is given
        float(given["edge_length"]),
        float(given["epsilon"]),
        float(given["stop_energy"]),
        bool(given["coarsen"]),
        int(given["threads"]),
        int(given["iterations"]),
        6,  # least log
        True,  # quiet
        True,  # VTK's order of vertices, else all tetrahedra are negative
        True,  # no filter: with it sheets inside upset the winding number
        given["field_points"],
        given["field_tets"].astype(np.int32),
        given["field_sizes"],
    )
    packed = io.BytesIO()
    np.savez(packed, points=points, tets=tets)
    # written in place: the parent reads only after this process has ended well
    try:
        Path(target).write_bytes(packed.getvalue())
    except OSError as error:
        print(error.strerror or error, file=sys.stderr)
        return FULL
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
