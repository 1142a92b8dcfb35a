"""One model to be meshed: what `decomp mesh` does itself, or hands to a process of a batch."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from decomp.cli.mesh_options import mesh_options
from decomp.cli.models import Around, model_of
from decomp.ways.options import MeshOptions

if TYPE_CHECKING:
    from decomp.meshes.model import TetMesh
    from decomp.meshes.report import Report


@dataclass(frozen=True, eq=False)
class MeshJob:
    """What is to be made.

    Args:
        model: its file.
        outputs: files of the mesh.
        around: the space around the model.
        options: of the mesh.
        text, version: of `.msh` files, as `TetMesh.write` takes them.
    """

    model: Path
    outputs: tuple[Path, ...]
    around: Around
    options: MeshOptions
    text: bool
    version: str

    @classmethod
    def of(cls, options: argparse.Namespace) -> MeshJob:
        """What the options of `decomp mesh` ask for, of the first model.

        Raises:
            InputError: they do not go together.
            FileError: the file of groups cannot be read, or holds something else.
        """
        model, version = options.models[0], "2.2" if options.msh2 else "4.1"
        outputs = tuple(options.output)
        asked = mesh_options(options)
        return cls(model, outputs, Around.of(options), asked, options.ascii, version)

    def as_json(self) -> dict[str, Any]:
        """As JSON values; of a job from the command line, whose sizes are no functions."""
        return {
            "model": str(self.model),
            "outputs": [str(path) for path in self.outputs],
            "around": asdict(self.around),
            "options": asdict(self.options),
            "text": self.text,
            "version": self.version,
        }

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> MeshJob:
        """The job again."""
        return cls(
            Path(values["model"]),
            tuple(Path(path) for path in values["outputs"]),
            Around(**values["around"]),
            MeshOptions(**values["options"]),
            values["text"],
            values["version"],
        )


def done(job: MeshJob, tell: Callable[[str, float], None]) -> tuple[TetMesh, Report]:
    """Load the model and mesh it; nothing is written.

    Args:
        job: what is to be made.
        tell: of the progress.

    Raises:
        DecompError: the model cannot be read, is no solid, or cannot be meshed.
    """
    from decomp.cli.stages import Stages
    from decomp.geometry import Geometry
    from decomp.meshes.report import report
    from decomp.ways.mesh import meshed

    stages = Stages(tell)
    stages("reading", 0.0)
    model = model_of(job.model, job.around)
    stages("boundary", 0.0)
    geometry = Geometry(model)
    made = meshed(geometry, job.options, stages)
    return made, report(made, stages=stages.spent(), ignored=geometry.model.ignored)


def written(mesh: TetMesh, job: MeshJob) -> None:
    """Write a mesh to the job's files."""
    from decomp.meshes.files import write

    for path in job.outputs:
        write(mesh, path, text=job.text, version=job.version)
