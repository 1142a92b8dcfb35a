"""What a source distribution and a wheel hold, and what they say of the package."""

from __future__ import annotations

import subprocess
import sys
import tarfile
import zipfile
from email.parser import Parser
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with both, the wheel made from the source distribution, as it is published.

    Only files that belong to the repository are built, without what is left of other builds.
    """
    out = tmp_path_factory.mktemp("dist")
    source = tmp_path_factory.mktemp("source") / "decomp"
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    for name in filter(None, listed.stdout.decode().split("\0")):
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            (source / name).write_bytes((ROOT / name).read_bytes())
    build = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(out), str(source)]
    subprocess.run(build, check=True, capture_output=True)
    return out


@pytest.mark.slow
def test_a_source_distribution_holds_what_its_tests_need(built: Path) -> None:
    (path,) = built.glob("*.tar.gz")
    with tarfile.open(path) as archive:
        names = {"/".join(name.split("/")[1:]) for name in archive.getnames()}
    wanted = (
        "CHANGELOG.md",
        "CITATION.cff",
        "CONTRIBUTING.md",
        "LICENSE",
        "README.md",
        "benchmarks/success.py",
        "docs/index.md",
        "docs/pictures/mesh-bearing.png",
        "meshes/bearing.geo",
        "mkdocs.yml",
        "tests/solids.py",
        "tests/test_package.py",
    )
    assert [name for name in wanted if name not in names] == []
    assert not [name for name in names if "__pycache__" in name]


@pytest.mark.slow
def test_a_wheel_holds_the_package_alone(built: Path) -> None:
    (path,) = built.glob("*.whl")
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
        said = archive.read(next(name for name in names if name.endswith("/METADATA"))).decode()
    metadata = Parser().parsestr(said)
    assert {name.split("/")[0] for name in names} == {
        "decomp",
        path.name.split("-py3")[0] + ".dist-info",
    }
    wanted = ("py.typed", "formats/netgen.lark", "view/page.css", "view/script/main.js")
    for each in (*wanted, "view/report.js"):
        assert f"decomp/{each}" in names
    licences = [name for name in names if "/licenses/" in name]
    assert [name.split("/licenses/")[1] for name in sorted(licences)] == [
        "LICENSE",
        "decomp/view/three.LICENSE",
    ]
    assert metadata["Keywords"]
    assert metadata["Project-URL"]
    assert "Programming Language :: Python :: 3.13" in metadata.get_all("Classifier", [])


def test_the_citation_is_of_this_version() -> None:
    import tomllib

    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert citation["version"] == project["version"]
    assert citation["license"] == project["license"]
