"""Work of other features that a farm divides: a feature can have a module `farm_work`, which declares how.

``sniff(path)`` recognises the file that describes the work. ``split(path, out)`` returns the number of units
and lists of those that are made together, ``make(path, out, units)`` makes the units of a list such as
``1-20``, ``missing(out, units)`` lists the unfinished ones, and ``finish(path, out)`` completes the work. The
constants `UNIT` and `KIND` name a unit and its result, as a camera and a pass name a picture.
"""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from .. import plugins
from ..render import fingerprint
from ..render.picture import Picture
from ..run.content import sha256
from ..shot.schema.frame_list import FrameList
from .plan import Job, Task


def find(path: Path) -> str:
    """Return the feature whose work a file describes; "" for a scene file or a run."""
    return next((feature for feature, work in _works().items() if work.sniff(path)), "")


def work(job: Job) -> ModuleType:
    """Return the module of the feature of a job."""
    return _works()[job.feature]


def make_job(feature: str, path: Path, out: Path, size: int) -> Job:
    """Divide work into tasks of at most `size` units, or of the units that are made together."""
    module = _works()[feature]
    count, groups = module.split(path, out)
    tasks: list[list[int]] = []
    for units in groups:
        if tasks and len(tasks[-1]) + len(units) <= size:
            tasks[-1] += units
        else:
            tasks.append(list(units))
    return Job(
        scene=str(path),
        scene_sha256=sha256(path),
        versions=fingerprint.versions(),
        count=count,
        camera_frames={module.UNIT: ""},
        passes={module.UNIT: (module.KIND,)},
        tasks=tuple(Task("render", (module.UNIT,), FrameList.of(sorted(each))) for each in tasks),
        assets=(),
        feature=feature,
    )


def missing(job: Job, out: Path) -> dict[Picture, str]:
    """Find the units that are not finished, as pictures with the reason."""
    module = work(job)
    unfinished = module.missing(out, range(1, job.count + 1))
    return {Picture(module.UNIT, unit, module.KIND): "not rendered" for unit in unfinished}


def _works() -> dict[str, ModuleType]:
    return {each.__name__.split(".")[-2]: each for each in plugins.of_features("farm_work")}
