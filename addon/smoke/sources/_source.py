"""What a source of smoke is, and what all sources share."""

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
from ...shot.code_fingerprint import PACKAGE
from ...shot.shot import Shot
from .. import flame_light
from ..cost_estimate import Cost
from ..domains import Domain

Lights = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Positions (n, 3) m and powers (n,) W of flames."""


@dataclass(frozen=True)
class VolumeLayer:
    """Volumes of one name, and how Cycles draws them.

    Attributes
    ----------
    name
        Their files are ``NAME_000001.vdb``.
    voxel, step
        Edge of a voxel and step along rays, m.
    extinction
        Of dense smoke, 1/m.
    """

    name: str
    voxel: float
    step: float
    extinction: float

    def file(self, folder: Path, frame: int) -> Path:
        """Its volume of a frame."""
        return folder / f"{self.name}_{frame:06d}.vdb"


class Source(ABC):
    """Smoke of a shot from one source.

    Attributes
    ----------
    name
        Of its module; the value of `smoke.method` that chooses it.
    help
        One line.
    fields
        Fields of the run that it draws. It is the source of every run that has them, whatever `smoke.method`
        says. A source without such fields is chosen by `smoke.method`.
    history
        Key of [smoke] that says how long before the first frame its smoke begins, s. Empty where it needs
        nothing of the time before.
    preview_of
        The source that it is a quick preview of, if any.
    illuminated
        Whether its volumes hold the light that reaches the smoke.
    unused_settings
        Keys of [smoke] that do not change its volumes.
    code
        Files and folders of the package that decide its volumes, beside its own module, this folder's helpers
        (`_NAME.py`) and the folder ``smoke``.
    """

    name: ClassVar[str]
    help: ClassVar[str]
    fields: ClassVar[tuple[str, ...]] = ()
    history: ClassVar[str] = ""
    preview_of: ClassVar[str] = ""
    illuminated: ClassVar[bool] = False
    unused_settings: ClassVar[tuple[str, ...]] = ()
    code: ClassVar[tuple[str, ...]] = ()

    def __init__(self, shot: Shot) -> None:
        self.shot, self.times = shot, shot.frames.times
        self.progress: Progress = silent
        """Told of preparations while frames are written."""
        self.elsewhere: Callable[[], bool] = lambda: False
        """Whether another process of ours prepares the shot."""
        self.stop = threading.Event()
        """Ends preparations that still go on."""

    @classmethod
    def code_files(cls) -> list[str]:
        """Files and folders whose code decides its volumes, beside the folder ``smoke``."""
        own = [Path(inspect.getfile(cls)), *sorted(Path(__file__).parent.glob("_*.py"))]
        return [_relative(path) for path in own] + list(cls.code)

    # what its volumes depend on, beside the run, the time and [smoke]

    def inputs(self) -> dict[str, Any]:
        """What else decides its volumes, as JSON can carry it."""
        return {}

    @abstractmethod
    def voxels(self) -> list[Any]:
        """How fine its volumes are, as JSON can carry it."""

    # what has to be done once, before frames are written

    @property
    def domains(self) -> list[Domain]:
        """Where a flow is solved for it: the whole fire's domain, and the nested one if there is one."""
        return []

    def cost(self) -> Cost | None:
        """What preparing the shot takes; None where that is nothing."""
        return None

    def is_prepared(self, frame: int) -> bool:
        """Whether a frame can be written at once."""
        return True

    def prepare(self, frames: Iterable[int], progress: Progress = silent) -> None:
        """Do once what these frames need, before several threads write them."""
        _ = self.visibility

    def in_use(self) -> AbstractContextManager[None]:
        """Keep others from clearing meanwhile what it has prepared."""
        return nullcontext()

    # what is drawn

    @property
    def marched(self) -> bool:
        """Whether rays can be marched through its `bricks`."""
        return False

    @abstractmethod
    def layers(self) -> list[VolumeLayer]:
        """The volumes of a frame, the last of which is named "smoke"."""

    @abstractmethod
    def write(self, path: Path, frame: int) -> volume.VdbSummary:
        """Write the volumes of a frame beside `path`, and that of the layer "smoke" last, as `path`.

        A file is there when it is complete, also where several threads or processes write it at once.
        """

    def bricks(self, frame: int) -> list[volume.Bricks]:
        """The smoke of a frame for rays to be marched through. None where it is not `marched`."""
        return []

    def painted_voxels(self) -> int:
        """Voxels of the largest box that `bricks` paints."""
        return 0

    # what sources share

    @property
    def visibility(self) -> Any:
        """What the cameras see (see `visibility.Visibility`), if only that is wanted. Else None."""
        return None if self.shot.settings.smoke.complete else self.shot.visibility

    def sight(self, frame: int) -> lod.ViewSet | None:
        """What the cameras see in a frame, if only that is wanted."""
        return self.visibility.view_set(frame) if self.visibility else None

    def lights(self, time: float) -> Lights:
        """Flames that light the smoke at a model time, s."""
        return flame_light.luminous(self.shot.fire, time, self.shot.scale)

    def metadata(self, time: float, smoke: str) -> dict[str, str]:
        """What a volume says of itself. `smoke` are a few words about what it is made from."""
        return {
            "run": self.shot.run.name,
            "smoke": smoke,
            "model_time_s": f"{time:.3f}",
            "origin": "centre of the model grid, height 0; x east, y north, z up, metres",
            "firetwin_core": firetwin_core.__version__,
        }


def _relative(path: Path) -> str:
    """A file of the package, relative to it. Another as it is."""
    return path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else str(path)
