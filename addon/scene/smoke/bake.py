"""The smoke volumes of a shot on disk: one OpenVDB file per frame, made once.

They lie in ``<cache>/<key>/smoke_000001.vdb``; the key is a hash of what is in the run's files, of the
settings that change the smoke and of the core, so that a changed setting never shows old smoke, and a
repeated bake has nothing to do. Every file is complete: it is written under another name and then renamed.
"""

from __future__ import annotations

import functools
import os
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import firetwin_core
import numpy as np
from firetwin_core import volume
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import content
from ..errors import input_error
from ..progress import Progress, silent
from ..project import Project
from ..times import frame_times
from . import air, burning, heat
from .frame import local_frame
from .smoke_view import Sights, resolution, shot_frames

__all__ = ["SHOWN", "Baker", "bake", "file", "folder", "lights", "resolution", "shot_frames"]

SHOWN = ("density", "dilution", "shade", "size", "glow")  # grids that smoke_material asks for
_FRAME_MEMORY = 1 << 30  # bytes that a frame may need while it is made: 0.5 GB were measured
_MOST_AT_ONCE = 8
_GLOW_BLOCK = 300.0  # m; flames this near each other light the smoke as one
_GLOW_COUNT = 400
_FLAME_HEIGHT = 20.0  # m over the ground, where their light comes from


def folder(project: Project, run: Run) -> Path:
    """Where the smoke of this project is kept."""
    return _cache(project) / _key(project, run)


def file(project: Project, run: Run, frame: int) -> Path:
    """The volume of a frame."""
    return folder(project, run) / f"smoke_{frame:06d}.vdb"


def bake(
    project: Project, run: Run, progress: Progress | None = None, frames: list[int] | None = None
) -> Path:
    """Write the volumes of the shot (or of those of `frames` that it has) that are not there yet.

    Several frames are made at once, as many as there are processors and memory for.

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
    _sweep(place)
    wanted = shot_frames(project) if frames is None else frames
    wanted = [frame for frame in wanted if 1 <= frame <= project.time.frames]
    missing = [frame for frame in wanted if not (place / f"smoke_{frame:06d}.vdb").exists()]
    done = len(wanted) - len(missing)
    progress(done, len(wanted), "smoke")
    if not missing:
        return place
    baker = Baker(project, run)
    with ThreadPoolExecutor(_at_once(len(missing))) as pool:
        tasks = [pool.submit(baker.write, place / f"smoke_{frame:06d}.vdb", frame) for frame in missing]
        try:
            for task in as_completed(tasks):
                task.result()
                done += 1
                progress(done, len(wanted), "smoke")
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return place


def _at_once(frames: int) -> int:
    """How many frames are made at the same time."""
    try:
        free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        free = _FRAME_MEMORY
    return max(1, min(frames, os.cpu_count() or 1, _MOST_AT_ONCE, free // _FRAME_MEMORY))


def _sweep(place: Path) -> None:
    """Remove what killed processes left unfinished: ``smoke_000001.vdb.<process>.tmp``."""
    for path in place.glob("*.vdb.*.tmp"):
        process = path.name.split(".")[-2]
        if process.isdigit() and not _runs(int(process)):
            path.unlink(missing_ok=True)


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


class Baker:
    """Writes the smoke of single frames."""

    def __init__(self, project: Project, run: Run) -> None:
        self.project = project
        self.times = frame_times(project, run)
        self.resolution = resolution(project, run)
        whole = project.smoke.complete
        self.grids = None if whole else SHOWN
        self.sights = None if whole else Sights(project, run)
        self.run = run
        self.heat = heat.Heat(run, self.times[0], self.times[-1])
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
        """Write the volume of a frame: from the model's own smoke where the run has it, else from puffs."""
        time = float(self.times[frame - 1])
        position, power = lights(self.heat, time)
        own = self.run.has("smoke_3d")
        more: dict[str, Any] = {
            "grids": self.grids,
            "sight": self.sights.of(frame) if self.sights else None,
            "metadata": {
                "run": self.run.name,
                "smoke": "of the model, smoke_3d" if own else "puffs from burned fuel, heat and wind",
                "model_time_s": f"{time:.3f}",
                "origin": "centre of the model grid, height 0; x east, y north, z up, metres",
                "firetwin_core": firetwin_core.__version__,
            },
        }
        if len(power):
            more |= {"flame_position": position, "flame_power": power}
        if own:
            return self._write_levels(path, time, more)
        return volume.write_smoke(path, self.puffs(frame), self.resolution.voxel, **more)

    def _write_levels(self, path: Path, time: float, more: dict[str, Any]) -> volume.Frame:
        """Write the model's own smoke; outside of its times there is none."""
        run = self.run
        known = float(np.clip(time, run.times[0], run.times[-1]))
        smoke = run.smoke_3d_at(known)
        if known != time:
            smoke[:] = 0.0
        if run.has("temperature_3d"):
            more["temperature"] = run.temperature_3d_at(known)
        return volume.write_levels(
            path,
            local_frame(run),
            run.latitude,
            run.longitude,
            run.elevation,
            run.height_3d_at(known),
            smoke,
            self.resolution.voxel,
            **more,
        )


def lights(model: heat.Heat, time: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What lights the smoke from within: positions (n, 3) m and powers (n,) W of luminous heat."""
    found = heat.lights(model.sources(time).luminous(), _GLOW_BLOCK, _GLOW_COUNT)
    return found.position + np.array([0.0, 0.0, _FLAME_HEIGHT]), found.power


def _cache(project: Project) -> Path:
    """The project's cache folder, absolute: Blender takes other paths for places beside the .blend file."""
    return project.cache.absolute()


def _key(project: Project, run: Run) -> str:
    """Hash of everything that the smoke depends on."""
    complete = project.smoke.complete
    settings: dict[str, Any] = {
        "core": _core(),
        "run": content.inputs(Path(run.path), leave_out=("temperature",)),
        "times": frame_times(project, run).tolist(),
        "seed": project.seed,
        "max_age": project.smoke.max_age,
        "voxel": round(resolution(project, run).voxel, 3),
        "plume": [air.DAY, air.NIGHT, air.MERGE, burning.BURN_TIME],
        "flames": [_GLOW_BLOCK, _GLOW_COUNT, _FLAME_HEIGHT],
        "grids": None if complete else SHOWN,
        # What is left out depends on all that the cameras' paths do: their keys, the picture and the ground.
        "sight": None
        if complete
        else repr((project.cameras, project.render.resolution, project.render.passes, project.terrain)),
    }
    return content.fingerprint(settings)


@functools.cache
def _core() -> str:
    """Hash of the compiled core."""
    return content.sha256(Path(firetwin_core.__file__))
