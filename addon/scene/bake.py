"""The smoke volumes of a shot on disk: one OpenVDB file per frame, made once.

They lie in ``<cache>/<key>/smoke_000001.vdb``; the key is a hash of the run's files, of the settings that
change the smoke and of the core, so that a changed setting never shows old smoke, and a repeated bake has
nothing to do. Every file is complete: it is written under another name and then renamed.
"""

from __future__ import annotations

import functools
import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import firetwin_core
import numpy as np
from firetwin_core import volume
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import frame_list
from ..errors import input_error
from ..progress import Progress, silent
from ..project import Project
from ..times import frame_times
from . import air, burning, paths

_STEP_DEPTH = 0.8  # optical depth of a step through thick smoke; much longer steps lose smoke
_GLOW_BLOCK = 300.0  # m; flames this near each other light the smoke as one
_GLOW_COUNT = 400
_FLAME_HEIGHT = 20.0  # m over the ground, where their light comes from


@dataclass(frozen=True)
class Resolution:
    """How finely smoke is drawn, from the distance of the nearest camera.

    Attributes
    ----------
    voxel
        Edge of a voxel, m.
    step
        Step along rays through the smoke, m.
    extinction
        Of thick smoke, 1/m; see _STEP_DEPTH.
    """

    voxel: float
    step: float
    extinction: float


def resolution(project: Project, run: Run) -> Resolution:
    """The scene file's voxel size and extinction, where it gives them, else those for the cameras."""
    distance = _distance(project, run)
    voxel = project.smoke.voxel_size or float(np.clip(70.0 * (distance / 4000.0) ** 0.4, 50.0, 160.0))
    extinction = project.smoke.extinction or float(np.clip(_STEP_DEPTH / (1.2 * voxel), 0.009, 0.03))
    return Resolution(voxel, _STEP_DEPTH / extinction, extinction)


def folder(project: Project, run: Run) -> Path:
    """Where the smoke of this project is kept."""
    return _cache(project) / _key(project, run)


def file(project: Project, run: Run, frame: int) -> Path:
    """The volume of a frame."""
    return folder(project, run) / f"smoke_{frame:06d}.vdb"


def bake(
    project: Project, run: Run, progress: Progress | None = None, frames: list[int] | None = None
) -> Path:
    """Write the volumes of the shot (or of `frames`) that are not there yet.

    Returns
    -------
    The folder that holds them.

    Raises
    ------
    InputError
        The cache cannot be written.
    """
    progress = progress or silent
    place = folder(project, run)
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise input_error(
            place, 0, 0, f"cannot make the folder ({error.strerror}); set `cache` to one that can be written"
        ) from None
    wanted = frames if frames is not None else shot_frames(project)
    missing = [frame for frame in wanted if not (place / f"smoke_{frame:06d}.vdb").exists()]
    progress(len(wanted) - len(missing), len(wanted), "smoke")
    if missing:
        baker = Baker(project, run)
        for done, frame in enumerate(missing, len(wanted) - len(missing) + 1):
            baker.write(place / f"smoke_{frame:06d}.vdb", frame)
            progress(done, len(wanted), "smoke")
    return place


def shot_frames(project: Project) -> list[int]:
    """Frames that some camera sees smoke in: those of its visible pass."""
    last = project.time.frames
    if not project.cameras:
        return list(range(1, last + 1))
    shown: set[int] = set()
    for camera in project.cameras:
        if "rgb" in (camera.passes or project.render.passes):
            shown.update(frame_list.parse(camera.frames, last))
    return sorted(shown)


class Baker:
    """Writes the smoke of single frames."""

    def __init__(self, project: Project, run: Run) -> None:
        self.project = project
        self.times = frame_times(project, run)
        self.resolution = resolution(project, run)
        self.run = run
        first = self.times[0] - project.smoke.max_age - burning.BURN_TIME
        # Cells of the interval that goes on at the last frame belong to its puffs.
        self.cells = burning.cells(run, first, self.times[-1] + 600.0)

    def puffs(self, frame: int) -> volume.Puffs:
        """Smoke of a frame."""
        cells = self.cells
        return volume.puffs(
            float(self.times[frame - 1]),
            cells.arrival,
            cells.fuel,
            cells.position,
            cells.wind,
            cells.area,
            max_age=self.project.smoke.max_age,
            burn_time=burning.BURN_TIME,
            stability=air.stability(self.run, float(self.times[frame - 1])),
            merge_radius=air.MERGE,
            seed=self.project.seed,
            smallest=1.2 * self.resolution.voxel,
        )

    def write(self, path: Path, frame: int) -> volume.Frame:
        """Write the volume of a frame."""
        position, power = flames(self.cells, float(self.times[frame - 1]))
        metadata = {
            "run": self.run.name,
            "model_time_s": f"{self.times[frame - 1]:.3f}",
            "origin": "centre of the model grid, height 0; x east, y north, z up, metres",
            "firetwin_core": firetwin_core.__version__,
        }
        lit = (position, power) if len(power) else (None, None)
        return volume.write_smoke(path, self.puffs(frame), self.resolution.voxel, *lit, metadata=metadata)


def flames(cells: burning.Cells, time: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The strongest groups of burning cells as lights: positions (n, 3) m and powers (n,) W."""
    power = cells.power(time)
    # A cell flares up in a minute and dies down, so that no light comes or goes at once.
    age = np.clip((time - cells.arrival) / burning.BURN_TIME, 0.0, 1.0)
    power = power * np.minimum(age * burning.BURN_TIME / 60.0, 1.0) * 2.0 * (1.0 - age)
    lit = np.flatnonzero(power > 0.0)
    if len(lit) == 0:
        return np.empty((0, 3)), np.empty(0)
    block = np.floor(cells.position[lit, :2] / _GLOW_BLOCK).astype(np.int64)
    _, member = np.unique(block, axis=0, return_inverse=True)
    member = member.ravel()
    total = np.bincount(member, power[lit])
    centre = np.stack(
        [np.bincount(member, power[lit] * cells.position[lit, axis]) / total for axis in range(3)], axis=-1
    )
    centre[:, 2] += _FLAME_HEIGHT
    strongest = np.sort(np.argsort(-total, kind="stable")[:_GLOW_COUNT])
    return np.ascontiguousarray(centre[strongest]), np.ascontiguousarray(total[strongest])


def _distance(project: Project, run: Run) -> float:
    """How near (m) cameras come to the fire: nearer than nine tenths of it in their nearest frame."""
    times = frame_times(project, run)
    burning_cells = burning.cells(run, times[0] - 1800.0, times[-1] + 1.0)
    if not project.cameras or len(burning_cells.arrival) == 0:
        return 20_000.0
    nearest = []
    for view in paths.paths(project, run):
        if view.perspective:
            nearest.append(float(np.percentile(view.distance(burning_cells.position[::5]), 10.0)))
        else:  # as if seen by a 28 mm lens with pixels of the same size on the ground
            nearest.append(2.0 * view.half[0] * 28.0 / paths.SENSOR)
    return min(nearest)


def _cache(project: Project) -> Path:
    """The project's cache folder, absolute: Blender takes other paths for places beside the .blend file."""
    return project.cache.absolute()


def _key(project: Project, run: Run) -> str:
    """Hash of everything that the smoke depends on."""
    drawn = resolution(project, run)
    inputs: dict[str, Any] = {
        "core": _core(),
        "run": _files(Path(run.path)),
        "times": frame_times(project, run).tolist(),
        "seed": project.seed,
        "max_age": project.smoke.max_age,
        "voxel": round(drawn.voxel, 3),
        "plume": [air.DAY, air.NIGHT, air.MERGE, burning.BURN_TIME],
    }
    return hashlib.sha256(json.dumps(inputs, sort_keys=True).encode()).hexdigest()[:16]


@functools.cache
def _core() -> str:
    """Hash of the compiled core."""
    with open(firetwin_core.__file__, "rb") as module:
        return hashlib.file_digest(module, "sha256").hexdigest()


def _files(path: Path) -> list[tuple[str, int, int]]:
    """Name, size and time of change of every file of a run."""
    found = (each for each in sorted(path.rglob("*")) if each.is_file())
    return [(str(f.relative_to(path)), f.stat().st_size, f.stat().st_mtime_ns) for f in found]
