"""Renders pictures: files are made under other names and get their own when their frame is complete."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import bpy

from ..blender.owned import Stage
from ..progress import Progress, silent
from ..shot import passes
from ..shot.shot import Shot
from . import engine, layers, plan, store
from .fingerprint import Fingerprints
from .part import part_folder
from .picture import Picture


def render(
    shot: Shot,
    stage: Stage,
    out: Path,
    wanted: list[Picture],
    made_with: Fingerprints,
    progress: Progress = silent,
    ready: Callable[[int], None] = lambda frame: None,
) -> None:
    """Render these pictures of a built scene into `out`, frame by frame, and enter them in its store.

    Parameters
    ----------
    ready
        Called before each frame: what it shows has to be on the disk when this returns.
    """
    engine.label(shot.run, stage.scene)
    frames = [
        (camera, frame, [picture.name for picture in group])
        for (camera, frame), group in itertools.groupby(wanted, key=lambda each: (each.camera, each.frame))
    ]
    with part_folder(out) as part:
        for done, (camera, frame, names) in enumerate(frames):
            progress(done, len(frames), "rendering")
            ready(frame)
            finished = _Frame(shot, stage, out, part, camera, frame, made_with).render(names)
            _publish(out, part, finished, made_with, shot.moment(frame).isoformat(timespec="seconds"))
    progress(len(frames), len(frames), "rendering")


class _Frame:
    """One moment seen by one camera."""

    def __init__(
        self,
        shot: Shot,
        stage: Stage,
        out: Path,
        part: Path,
        camera: str,
        frame: int,
        made_with: Fingerprints,
    ) -> None:
        self.shot, self.scene, self.out, self.part = shot, stage.scene, out, part
        self.pictures = {name: Picture(camera, frame, name) for name in passes.known()}
        self.made_with = made_with
        self.scene.camera = stage.camera(camera)
        self.scene.frame_set(frame)

    def render(self, names: list[str]) -> list[Picture]:
        """Make the files of these passes in the temporary folder, and of no others that can be spared."""
        known = passes.known()
        needed = {need for name in names for need in known[name].needs} - set(names)
        lacking = {need for need in needed if plan.missing(self.out, [self.pictures[need]], self.made_with)}
        drawn = [known[name] for name in known if name in names or name in lacking]
        for centres in (False, True):
            if group := [each.name for each in drawn if each.pixel_centres is centres]:
                self.draw(group, centres)
        for each in drawn:
            if each.finish:
                there = {need: self.files(need, need in needed - lacking) for need in each.needs}
                each.finish(self.files(each.name), there, self.shot.settings)
        return [self.pictures[name] for name in names]

    def draw(self, names: list[str], centres: bool) -> None:
        """Render the view layers of these passes."""
        layers.select(self.scene, names)
        layers.write_exr(self.scene, str(self.part), [self.pictures[name] for name in names])
        still = next((name for name in names if layers.still(passes.known()[name])), None)
        if still:
            self.scene.render.filepath = str(self.files(still)["png"])
        with engine.pixel_centres(self.scene, centres):
            bpy.ops.render.render(write_still=still is not None, scene=self.scene.name)

    def files(self, name: str, finished: bool = False) -> dict[str, Path]:
        """Files of a pass by suffix: where they are made, or where they are once they are finished."""
        paths = map(Path, self.pictures[name].files())
        return {path.suffix[1:]: self.out / path if finished else self.part / path.name for path in paths}


def _publish(out: Path, part: Path, pictures: list[Picture], made_with: Fingerprints, when: str) -> None:
    """Give the files of a complete frame their names, and only then enter them in the store."""
    for picture in pictures:
        entries = {}
        for name in picture.files():
            made = part / Path(name).name
            entries[name] = store.describe(made) | {
                "camera": picture.camera,
                "pass": picture.name,
                "frame": picture.frame,
                "time": when,
            }
            store.publish(made, out / name)
        store.add(out, made_with[picture.camera, picture.name], entries)
