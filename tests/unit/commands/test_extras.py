"""Install commands of missing packages: extras of the project, with the NumPy that Blender needs."""

import importlib.metadata
import re
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from firetwin import extras
from firetwin.errors import Error
from firetwin.run.models import optional_packages

ROOT = Path(__file__).resolve().parents[3]
DECLARED = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]


@pytest.mark.parametrize("extra", extras.EXTRAS)
def test_packages_are_those_of_the_project(extra):
    assert set(extras.EXTRAS[extra]) == {re.split(r"[=<>]", each)[0] for each in DECLARED[extra]}


def test_a_command_names_the_extra_and_holds_numpy(monkeypatch):
    held = f"numpy=={np.__version__}"
    monkeypatch.setattr(importlib.metadata, "distribution", lambda name: name)
    monkeypatch.setattr(sys, "executable", "C:/Program Files/python")
    for platform, python in (("linux", "'C:/Program Files/python'"), ("win32", '"C:/Program Files/python"')):
        monkeypatch.setattr(sys, "platform", platform)
        brackets = "'firetwin[models]'" if platform == "linux" else "firetwin[models]"
        assert extras.install("models") == f"{python} -m pip install {brackets} {held}"
    monkeypatch.setitem(sys.modules, "netCDF4", None)
    with pytest.raises(Error, match=re.escape(extras.install("models"))):
        optional_packages.package("netCDF4")


def test_in_blender_a_command_names_the_packages(monkeypatch):
    """Its Python has the add-on as files, and not as a distribution."""

    def missing(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "distribution", missing)
    assert extras.install("score").endswith(f" install shapely pyproj pyshp numpy=={np.__version__}")
