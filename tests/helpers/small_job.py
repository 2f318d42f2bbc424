"""A job of two bakes and five renders, in a folder that needs quotes, for tests of what engines write."""

from __future__ import annotations

from pathlib import Path

from firetwin.farm.engines import Batch, known
from firetwin.farm.plan import Job, Task

BAKES, RENDERS = (1, 2), (3, 4, 5, 6, 7)


def batch(folder: Path, numbers: tuple[int, ...] = BAKES + RENDERS, options: tuple[str, ...] = ()) -> Batch:
    """Some of its tasks, to be submitted with options."""
    stages = ["bake"] * len(BAKES) + ["render"] * len(RENDERS)
    job = Job(
        scene="/the scene's/scene.toml",
        scene_sha256="",
        versions={"firetwin": "0", "blender": "4.5.15"},
        count=9,
        camera_frames={"drone": ""},
        passes={"drone": ("rgb",)},
        tasks=tuple(Task(stage, ("drone",), "1-9") for stage in stages),
        assets=(),
    )
    return Batch(job, folder / "it's a film", numbers, options)


def write(engine: str, found: Batch) -> tuple[Path, list[str]]:
    """The folder of an engine's text of a batch, and the command that submits it."""
    made = known()[engine]()
    command = made.write(found)
    return made.folder(found.out), command
