"""Interface of smoke sources, and shared methods."""

from __future__ import annotations

import inspect
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import firetwin_core
import numpy as np
from firetwin_core import lod, volume
from numpy.typing import NDArray

from ...progress import Progress, silent
from ...shot.settings.code_fingerprint import PACKAGE
from ...shot.shot import Shot
from .. import flame_light
from ..cost_estimate import Cost
from ..domains import Domain

Lights = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Positions (n, 3) m and powers (n,) W of flames."""


@dataclass(frozen=True)
class VolumeLayer:
    """Volume layer: volumes with one name, and their rendering parameters in Cycles.

    Attributes
    ----------
    name
        Files are ``NAME_000001.vdb``.
    voxel, step
        Voxel size and ray step, m.
    extinction
        Extinction of dense smoke, 1/m.
    """

    name: str
    voxel: float
    step: float
    extinction: float

    def file(self, folder: Path, frame: int) -> Path:
        """Return the volume file of a frame."""
        return folder / f"{self.name}_{frame:06d}.vdb"


def allows_ray_march(shot: Shot) -> bool:
    """Return whether the settings let the integrated renderer march rays: in Cycles, without volumes."""
    return shot.settings.smoke.draw == "integrated" and shot.settings.render.engine == "cycles"


class Source(ABC):
    """A source of a shot's smoke.

    Attributes
    ----------
    name
        Name of its module, and its value of `smoke.method`.
    fields
        Run fields that it draws. Every run that has them uses this source, whatever `smoke.method` is. A
        source without such fields is selected by `smoke.method`, and its module has `METHOD`, its help.
    preview_of
        Name of the source that it previews, if any.
    marched
        True if its volumes contain the light that reaches the smoke, and its `bricks` can be ray-marched.
    unused_settings
        Keys of [smoke] that do not affect its volumes.
    code
        Files and folders of the package that determine its volumes, in addition to its module, this folder's
        helpers (`_NAME.py`) and the folder ``smoke``.
    """

    name: ClassVar[str]
    fields: ClassVar[tuple[str, ...]] = ()
    preview_of: ClassVar[str] = ""
    marched: ClassVar[bool] = False
    unused_settings: ClassVar[tuple[str, ...]] = ()
    code: ClassVar[tuple[str, ...]] = ()

    def __init__(self, shot: Shot) -> None:
        self.shot, self.times = shot, shot.frames.times
        self.progress: Progress = silent
        """Called during preparations while frames are written."""
        self.elsewhere: Callable[[], bool] = lambda: False
        """True while another Firetwin process prepares the shot."""
        self.stop = threading.Event()
        """Event that stops preparations."""

    @classmethod
    def code_files(cls) -> list[str]:
        """List files and folders whose code determines its volumes, in addition to the folder ``smoke``."""
        own = [Path(inspect.getfile(cls)), *sorted(Path(__file__).parent.glob("_*.py"))]
        return [_relative(path) for path in own] + list(cls.code)

    # inputs of its volumes, in addition to the run, the time and [smoke]

    def inputs(self) -> dict[str, Any]:
        """Return further inputs of its volumes, in JSON form."""
        return {}

    @abstractmethod
    def voxels(self) -> list[Any]:
        """Return the voxel sizes of its volumes, in JSON form."""

    # preparation, once before frames are written

    @property
    def domains(self) -> list[Domain]:
        """Return the flow domains of the source: around the fire, and the nested one if there is one."""
        return []

    def cost(self) -> Cost | None:
        """Estimate the cost of preparing the shot; None if there is nothing to prepare."""
        return None

    def is_prepared(self, frame: int) -> bool:
        """Return whether a frame can be written without preparation."""
        return True

    def solutions(self) -> frozenset[str]:
        """Return names of the cache folders of the solutions to paint frames from; views may share them."""
        return frozenset()

    def prepare(self, frames: Iterable[int], progress: Progress = silent) -> None:
        """Prepare these frames before several threads write them."""
        _ = self.visibility

    def in_use(self) -> AbstractContextManager[None]:
        """Protect prepared files from eviction while in use."""
        return nullcontext()

    # rendering

    @abstractmethod
    def layers(self) -> list[VolumeLayer]:
        """Return the volume layers of a frame; the last one is named "smoke"."""

    @abstractmethod
    def write(self, path: Path, frame: int) -> volume.VdbSummary:
        """Write a frame's volumes next to `path`, with the layer "smoke" last, as `path`.

        A file appears when it is complete, even if several threads or processes write it.
        """

    def bricks(self, frame: int) -> list[volume.Bricks]:
        """Return the bricks of a frame for ray marching; empty if the source is not `marched`."""
        return []

    def snapshot(self, frame: int) -> int:
        """Return the number of a frame's snapshot in the source's `domains`."""
        return frame

    def painted_voxels(self) -> int:
        """Return the number of voxels of the largest box that `bricks` paints."""
        return 0

    # shared by all sources

    @property
    def visibility(self) -> Any:
        """Visibility for culling (see `visibility.Visibility`); None if all smoke is wanted."""
        return None if self.shot.settings.smoke.complete else self.shot.visibility

    def view_set(self, frame: int) -> lod.ViewSet | None:
        """Return the view set of a frame for culling; None if all smoke is wanted."""
        return self.visibility.view_set(frame) if self.visibility else None

    def lights(self, time: float) -> Lights:
        """Return the lights of the flames in smoke at a model time, s."""
        return flame_light.lights(self.shot.fire, time, self.shot.scale)

    def metadata(self, time: float, smoke: str) -> dict[str, str]:
        """Return the metadata of a volume. `smoke` describes its origin."""
        return {
            "run": self.shot.run.name,
            "smoke": smoke,
            "model_time_s": f"{time:.3f}",
            "origin": "centre of the model grid, height 0; x east, y north, z up, metres",
            "firetwin_core": firetwin_core.__version__,
        }


def _relative(path: Path) -> str:
    """Make a path relative to the package; other paths are unchanged."""
    return path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else str(path)
