"""The scripts of docs/examples give what theory says, on coarse meshes."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

HERE = Path(__file__).parent.parent.parent / "docs" / "examples"
SCRIPTS = {path.stem for path in HERE.glob("*.py")} - {"table"}


def example(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"example_{name}", HERE / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
@pytest.mark.parametrize(("order", "rate"), [(1, 1.6), (2, 2.3)])
def test_heat_converges(order: int, rate: float) -> None:
    lengths, errors, _ = example("heat").convergence((0.2, 0.1), order)
    assert np.log(errors[0] / errors[1]) / np.log(lengths[0] / lengths[1]) > rate
    assert errors[0] < (2e-2, 1e-3)[order - 1]


def test_coaxial() -> None:
    module = example("coaxial")
    assert module.capacitance(0.25) == pytest.approx(module.EXACT, rel=5e-4)


def test_sphere_modes() -> None:
    module = example("sphere_modes")
    found = module.eigenvalues(0.4)
    assert found == pytest.approx(module.EXACT, rel=6e-3)
    # nodes are inside the ball, and Ritz values are above the exact ones
    assert (found > module.EXACT).all()


def test_plate() -> None:
    module = example("plate")
    assert module.concentration(1.0, 36) == pytest.approx(module.EXACT, rel=4e-2)


def test_wall_distance() -> None:
    assert max(example("wall_distance").errors()) < 1e-12


def test_all_scripts_are_tested_and_in_the_table() -> None:
    assert {"heat", "coaxial", "sphere_modes", "plate", "wall_distance"} == SCRIPTS
    table = (HERE / "README.md").read_text().split("<!-- table -->")[1].split("<!-- end -->")[0]
    assert all(f"]({name}.py)" in table for name in SCRIPTS)
