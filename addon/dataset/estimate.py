"""Estimate of time and size of a data set, before it is made."""

from __future__ import annotations

import os
import shutil
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from ..files import read_json
from ..progress import count, duration, size

_VISIT_SECONDS, _SAMPLE_SECONDS = 14.0, 20.0
"""Processor seconds of a visit (scene and smoke), and of a sample of 640 x 480 pixels: means of 200."""
_LEAST = 5
"""Finished samples from which an estimate takes their cost."""
_PIXELS = 640 * 480
_SAMPLE_BYTES = 2.4e6
"""Bytes of a sample of 640 x 480 pixels with all maps, by the mean of 200."""


@dataclass(frozen=True)
class Estimate:
    """Estimate of the missing samples.

    Attributes
    ----------
    samples, visits
        Number of samples to make, and of scenes to build for them.
    seconds
        Time on this machine, s.
    bytes
        Size of their files.
    free
        Free space of the disk, bytes; None if unknown.
    """

    samples: int
    visits: int
    seconds: float
    bytes: float
    free: int | None

    def lines(self) -> list[str]:
        """Describe the estimate in one or two lines."""
        if not self.samples:
            return ["all samples are finished"]
        work = f"{count(self.samples, 'sample')} in {count(self.visits, 'scene')}"
        found = [f"{work}: about {duration(self.seconds)} on this machine, {size(self.bytes)}"]
        if self.free is not None and self.free < self.bytes:
            found.append(f"the disk has {size(self.free)} left; free some space or choose another --out")
        return found


def estimate(
    missing: Collection[int],
    visits: int,
    resolution: tuple[int, int],
    out: Path,
    finished: Collection[Path] = (),
) -> Estimate:
    """Estimate time and size of missing samples.

    Parameters
    ----------
    missing
        Numbers of the samples.
    visits
        Number of scenes that contain them.
    resolution
        Size of a picture, pixels.
    finished
        Files with the processor seconds of finished samples (see `produce.cost_file`).
    """
    pixels = resolution[0] * resolution[1] / _PIXELS
    if len(finished) >= _LEAST:
        work = len(missing) * sum(map(_seconds, finished)) / len(finished)
    else:
        work = visits * _VISIT_SECONDS + len(missing) * _SAMPLE_SECONDS * pixels
    return Estimate(
        len(missing),
        visits,
        work / (os.cpu_count() or 1),
        len(missing) * _SAMPLE_BYTES * pixels,
        _free(out),
    )


def _seconds(cost: Path) -> float:
    """Read the processor seconds of a finished sample, with its share of its scene."""
    parts = read_json(cost)["processor_seconds"]
    return float(sum(parts.values()))


def _free(out: Path) -> int | None:
    folder = out.absolute()
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    try:
        return shutil.disk_usage(folder).free
    except OSError:
        return None
