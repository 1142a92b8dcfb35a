"""The notebook of the documentation is executed, and shows what it says."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

import decomp

NOTEBOOK = Path(decomp.__file__).parent.parent / "docs" / "notebook.ipynb"


@pytest.mark.slow
def test_the_notebook(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(NOTEBOOK.parent.parent))
    book = nbformat.read(NOTEBOOK, as_version=4)
    assert not any(cell.get("outputs") for cell in book.cells)
    NotebookClient(
        book, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    shown = [
        {kind: text for out in cell.outputs for kind, text in out.get("data", {}).items()}
        | {"said": "".join(out.get("text", "") for out in cell.outputs)}
        for cell in book.cells
        if cell.cell_type == "code"
    ]
    geometry, bracket, mesh, summary, names, again, picture = shown
    assert geometry["text/plain"].startswith("<Geometry model: regions (bracket, pad), faces 14,")
    assert '<td style="text-align:left">pad</td>' in geometry["text/html"]
    assert "'bolt#2.side'" in bracket["said"]
    assert "<b>RegionBoundary</b>" in bracket["text/html"]
    assert "volumes (bracket, pad)" in mesh["text/plain"]
    assert '<td style="text-align:left">bolts</td>' in mesh["text/html"]
    assert "  group bolts: bracket/bolt#1.side, " in summary["said"]
    assert "pad/pad.zmax interface" in names["said"].splitlines()[-1]
    assert again["said"] == "True\nTrue ()\n"
    assert len(picture["image/png"]) > 10_000
    assert (tmp_path / "bracket.msh").exists()
