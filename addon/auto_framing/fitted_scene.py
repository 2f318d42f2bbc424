"""Scene of a command line: a scene file, or settings fitted to a run folder."""

from __future__ import annotations

import argparse
import hashlib
import os
from datetime import datetime
from pathlib import Path

from .. import auto_framing, files
from ..errors import UsageError
from ..progress import READING, count, duration, notify_if_slow, say
from ..run import readers, times
from ..run.readers import folder
from ..shot.sections import Time
from ..shot.source import ShotSource

_FRAME_SECONDS = 28.0  # processor s of a frame of 640 x 360 pixels, rgb and thermal (the example's, measured)


def find_source(arguments: argparse.Namespace) -> ShotSource:
    """Find the shot source: a scene file, or for a run folder a fitted scene file in the cache."""
    scene, cache = arguments.scene, Path("cache")
    if folder.sniff(scene):
        text = fit_text(scene, cache / "scene.toml", cache)
        scene = cache / f"{scene.absolute().name}-{hashlib.sha256(text.encode()).hexdigest()[:12]}.toml"
        files.write_text(scene, text)
        say(f"these settings are in {scene}; to edit them, run: firetwin new {arguments.scene} -o SCENE.toml")
    return ShotSource(
        scene=str(scene),
        beside=getattr(arguments, "run", None) or "",
        preset=getattr(arguments, "preset", None) or "",
    )


def fit_text(
    run: Path, path: Path, cache: Path, asked: tuple[datetime | None, datetime | None] = (None, None)
) -> str:
    """Write the text of a scene file `path` that fits a run in the requested times; prints its choices."""
    opened, window = readers.open(run), Time(*asked)
    first, last = (times.utc(opened, float(opened.times[i])) for i in (0, -1))
    for name, moment in zip(("start", "end"), asked, strict=True):
        if moment is not None and not first <= moment <= last:
            raise UsageError(
                f"--{name}: is outside the run, which covers {times.iso(first)} to {times.iso(last)}"
            )
    if wrong := window.validate():
        raise UsageError(f"--end: {wrong[1]}")
    with notify_if_slow(READING):
        fitted = auto_framing.fit_folder(run, path, cache, window)
    for line in fitted.lines:
        say(line)
    frames, cores = fitted.settings.time.frames, os.cpu_count() or 1
    film = f"about {duration(frames * _FRAME_SECONDS / cores)} on {count(cores, 'core')}"
    say(f"a camera films {count(frames, 'frame')}: {film}, once its smoke is solved")
    return fitted.text
