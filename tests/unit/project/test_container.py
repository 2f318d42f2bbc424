"""The recipes of container images: both use the same script, with the libraries of the set-up script."""

import re
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
FOLDER = EXAMPLES / "container"


def run_packages(script):
    """Return the packages in the list `run_packages` of a script."""
    text = re.search(r"^run_packages=\((.*?)^\)", script.read_text(), re.MULTILINE | re.DOTALL)[1]
    return {name for line in text.splitlines() if not line.lstrip().startswith("#") for name in line.split()}


def test_image_has_the_libraries_that_blender_loads():
    assert run_packages(EXAMPLES / "setup.sh") <= run_packages(FOLDER / "install.sh")


def test_both_recipes_agree():
    containerfile, definition = (FOLDER / "Containerfile").read_text(), (FOLDER / "firetwin.def").read_text()
    for recipe in (containerfile, definition):
        assert re.findall(r"install\.sh (build|run)", recipe) == ["build", "run"]
        assert "NVIDIA_DRIVER_CAPABILITIES=compute,utility,graphics" in recipe
        assert re.search(r"firetwin(\"\]| \"\$@\")$", recipe, re.MULTILINE)
    copied = {
        name
        for line in re.findall(r"^COPY (.*) /source", containerfile, re.MULTILINE)
        for name in line.split()
    }
    assert copied == set(re.findall(r"^    (\S+) /source/\S+$", definition, re.MULTILINE))
    releases = re.findall(r"^From: debian:(\d+)-slim$", definition, re.MULTILINE)
    assert set(releases) == {re.search(r"^ARG DEBIAN=(\d+)$", containerfile, re.MULTILINE)[1]}
