"""One model of a batch, in a process of its own: `python -m decomp.cli.batch_worker`.

A job (`MeshJob`) comes as a line of JSON on stdin, whose end tells it to end too; on stdout go JSON
lines: `{"what": ..., "done": ...}` while it works, then `{"figures": ...}` (the report) or
`{"error": ..., "code": ...}`.
"""

from __future__ import annotations

import json
import sys
from typing import Any

from decomp.cli.ending import EndedError, endings, leave
from decomp.processes.lifeline import die_with_parent


def main() -> int:
    """Mesh a model and write it.

    Returns:
        0 or an error's exit code; when ended by signal n, it ends with 128 + n.
    """
    try:
        with endings():
            given = sys.stdin.readline()
            die_with_parent()
            return _meshed(json.loads(given))
    except EndedError as end:
        leave(end.exit_code)


def _meshed(given: dict[str, Any]) -> int:
    from decomp.cli.mesh_job import MeshJob, done, written
    from decomp.errors import DecompError
    from decomp.meshes.report import as_json

    job = MeshJob.from_json(given)
    try:
        mesh, figures = done(job, lambda what, part: _say({"what": what, "done": part}))
        written(mesh, job)
    except DecompError as error:
        _say({"error": str(error), "code": error.exit_code})
        return error.exit_code
    _say({"figures": as_json(figures)})
    return 0


def _say(values: dict[str, Any]) -> None:
    print(json.dumps(values), flush=True)


if __name__ == "__main__":
    sys.exit(main())
