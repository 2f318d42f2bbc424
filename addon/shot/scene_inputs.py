"""Further inputs of a scene file, which features read.

A feature's ``scene_inputs.py`` has, each for the settings:

- ``ASPECT``, the aspect of passes that depend on its files, and ``files``, which lists the files
- ``check``, with the run, and ``check_others``, with the comparison runs by name: errors have the line
- ``window``, UTC between which shots show them; None without inputs
- ``sources``, rows of citations, and ``sentences`` for the paragraph on methods
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from datetime import datetime
from pathlib import Path

from firetwin_core.run import Run

from .. import plugins
from ..progress import Progress, silent
from ..run import content
from .settings import Settings

_NAME = "scene_inputs"


def files(settings: Settings) -> list[Path]:
    """List the files."""
    return [path for feature in plugins.of_features(_NAME) for path in feature.files(settings)]


def inputs(settings: Settings, aspects: Collection[str], progress: Progress = silent) -> dict[str, str]:
    """SHA-256 of the files on which passes with these aspects depend."""
    return {
        f"{feature.ASPECT} {file.name}": content.of_file(file, settings.cache, progress)
        for feature in plugins.of_features(_NAME)
        if feature.ASPECT in aspects
        for file in feature.files(settings)
    }


def check(settings: Settings, run: Run) -> None:
    """Check the inputs, and that they fit the run.

    Raises
    ------
    InputError
        Names the line of the scene file and what to do.
    """
    for feature in plugins.of_features(_NAME):
        feature.check(settings, run)


def check_others(settings: Settings, runs: Mapping[str, Run]) -> None:
    """Check that they fit the comparison runs; errors as `check`."""
    for feature in plugins.of_features(_NAME):
        feature.check_others(settings, runs)


def windows(settings: Settings) -> list[tuple[datetime, datetime]]:
    """List the times, UTC, between which shots show the inputs."""
    every = (feature.window(settings) for feature in plugins.of_features(_NAME))
    return [window for window in every if window is not None]


def sources(settings: Settings) -> list[dict[str, str]]:
    """List the sources to cite, as rows of `kind` and `text`."""
    return [row for feature in plugins.of_features(_NAME) for row in feature.sources(settings)]


def sentences(settings: Settings) -> list[str]:
    """Describe the inputs for the paragraph on methods."""
    return [text for feature in plugins.of_features(_NAME) for text in feature.sentences(settings)]
