"""What is installed is what stands in the folders, and what the README says can be typed."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from importlib import metadata
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

import propmdao
from propmdao.propeller.catalog import airfoil_file, airfoil_names, catalog_names, propeller_file

OPENMDAO_NAMES = {
    "openmdao_component": [
        "AcousticsComp",
        "AerodynamicsComp",
        "BroadbandComp",
        "GeometryComp",
        "MarchedAerodynamicsComp",
        "MotorComp",
        "NoiseObjectiveComp",
        "RotationSpeedComp",
        "TrimmedAerodynamicsComp",
    ],
    "openmdao_group": ["PropellerGroup"],
    "openmdao_driver": ["DifferentialEvolutionDriver", "SweepDriver"],
}


@pytest.fixture(scope="module")
def project(checkout: Path) -> dict[str, Any]:
    return tomllib.loads((checkout / "pyproject.toml").read_text())


@pytest.fixture(scope="module")
def distribution() -> metadata.Distribution:
    try:
        return metadata.distribution("propmdao")
    except metadata.PackageNotFoundError:
        pytest.skip("propmdao is not installed, only on the path")


def test_every_package_folder_is_listed(checkout: Path, project: dict[str, Any]) -> None:
    # setuptools drops a package that is not listed without a word.
    physics = {
        file.parent.relative_to(checkout)
        for file in (checkout / "propmdao").rglob("__init__.py")
        if not file.is_relative_to(checkout / "propmdao" / "components")  # through the link
    }
    layer = {
        Path("propmdao") / file.parent.relative_to(checkout)
        for file in (checkout / "components").rglob("__init__.py")
    }
    packages = {".".join(folder.parts) for folder in physics | layer}
    assert sorted(packages) == project["tool"]["setuptools"]["packages"]


def test_the_components_link_is_relative(checkout: Path) -> None:
    assert (checkout / "propmdao" / "components").readlink() == Path("../components")


def test_version_has_one_source(distribution: metadata.Distribution) -> None:
    assert distribution.version == propmdao.__version__


def test_catalogue_files_are_installed() -> None:
    assert len(catalog_names()) >= 3
    for name in catalog_names():
        assert propeller_file(name).is_file()
    for name in airfoil_names():
        assert airfoil_file(name).is_file()


def test_types_are_shipped() -> None:
    assert (files("propmdao") / "py.typed").is_file()


def test_only_the_package_is_installed(distribution: metadata.Distribution) -> None:
    # A checkout's own metadata lists its source; only an installed wheel shows what it holds.
    if (Path(propmdao.__file__).parents[1] / "pyproject.toml").is_file():
        pytest.skip("propmdao is not installed from a wheel")
    top_level = {file.parts[0] for file in distribution.files or ()}
    assert {part for part in top_level if not part.endswith(".dist-info")} == {"..", "propmdao"}


@pytest.mark.parametrize("group", OPENMDAO_NAMES)
def test_openmdao_finds_the_classes(distribution: metadata.Distribution, group: str) -> None:
    found = [point for point in distribution.entry_points if point.group == group]
    assert sorted(point.load().__name__ for point in found) == OPENMDAO_NAMES[group]


def test_openmdao_lists_the_components(distribution: metadata.Distribution) -> None:
    listing = subprocess.run(
        [sys.executable, "-m", "openmdao.utils.om", "list_installed", "-i", "propmdao"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    for names in OPENMDAO_NAMES.values():
        assert all(name.lower() in listing.lower() for name in names)


def test_the_command_line_does_without_openmdao_and_matplotlib() -> None:
    # They take seconds to import and nothing on the command line needs them.
    code = (
        "import sys, propmdao.commands.program as cli; cli.main(['list'])\n"
        "assert not {'openmdao', 'matplotlib'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
