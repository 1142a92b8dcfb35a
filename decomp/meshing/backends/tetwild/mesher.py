"""fTetWild as a mesher of the table."""

from __future__ import annotations

from collections.abc import Callable

from decomp.meshing.backends.base import Mesher, Repair, Task, Tetrahedra, TimeLimit
from decomp.meshing.backends.tetwild.child import Settings, tetrahedralized
from decomp.meshing.backends.tetwild.soup import soup


def run(task: Task, limit: TimeLimit, tell: Callable[[str], None]) -> Tetrahedra:
    """Fill the box around a task's triangles with tetrahedra that conform to them.

    It tells points and tetrahedra alone, so what they belong to is to be asked.

    Args:
        task: what is to be filled.
        limit: of each of at most two tries.
        tell: is told of a failed first try.

    Raises:
        InputError: the task would crash or hang it; pytetwild is missing.
        FileError: there is no room for its files in the directory for temporary ones.
        MeshingError: both tries failed.
    """
    settings = Settings(task.length, task.tolerance)
    made = tetrahedralized(*soup(task, settings), settings, task.field, limit, tell)
    return Tetrahedra(made.points, made.tets, made.settings.epsilon)


MESHER = Mesher("TetWild", frozenset(Repair), run)
