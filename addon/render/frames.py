"""Renders shots: files are made under other names and get their own when their frame is complete."""

from __future__ import annotations

import itertools
from pathlib import Path

import bpy
from firetwin_core import sensor
from firetwin_core.run import Run

from .. import times
from ..progress import Progress, silent
from ..project import Project
from ..scene import sensors
from . import engine, manifest, plan
from .part import part_folder
from .passes import Shot


def render(
    project: Project,
    run: Run,
    scene: bpy.types.Scene,
    out: Path,
    shots: list[Shot],
    settings: plan.Settings,
    progress: Progress = silent,
) -> None:
    """Render these shots of a built scene into `out`, frame by frame, and enter them in its manifest."""
    engine.apply(project, scene)
    engine.label(run, scene)
    frames = [
        (camera, frame, [shot.name for shot in group])
        for (camera, frame), group in itertools.groupby(shots, key=lambda shot: (shot.camera, shot.frame))
    ]
    with part_folder(out) as part:
        progress(0, len(frames), "rendering")
        for done, (camera, frame, names) in enumerate(frames, start=1):
            finished = _Frame(project, scene, out, part, camera, frame, settings).render(names)
            when = times.moment(run, times.model_time(project, run, frame)).isoformat(timespec="seconds")
            _publish(out, part, finished, settings, when)
            progress(done, len(frames), "rendering")


class _Frame:
    """One moment seen by one camera."""

    def __init__(
        self,
        project: Project,
        scene: bpy.types.Scene,
        out: Path,
        part: Path,
        camera: str,
        frame: int,
        settings: plan.Settings,
    ) -> None:
        self.project, self.scene, self.out, self.part = project, scene, out, part
        self.shots = {name: Shot(camera, frame, name) for name in sensors.LAYERS}
        self.settings = settings
        scene.camera = bpy.data.objects[f"Firetwin Camera {camera}"]
        scene.frame_set(frame)

    def render(self, names: list[str]) -> list[Shot]:
        """Make the files of these passes in the temporary folder, and of no others that can be spared."""
        picture = self.path("rgb", "png")
        layers = [name for name in ("rgb", "thermal") if name in names]
        if "thermal" in names and "rgb" not in names:
            if plan.missing(self.out, [self.shots["rgb"]], self.settings):
                layers.insert(0, "rgb")
            else:
                picture = self.out / self.shots["rgb"].file("png")
        if layers:
            self.draw(layers)
        if "depth" in names:
            with engine.pixel_centres(self.scene):
                self.draw(["depth"])
        if "thermal" in names:
            self.thermal_picture(picture)
        return [self.shots[name] for name in names]

    def draw(self, layers: list[str]) -> None:
        """Render these view layers."""
        sensors.select(self.scene, layers)
        sensors.write_exr(self.scene, str(self.part), {name: self.shots[name].stem() for name in layers})
        self.scene.render.filepath = str(self.path("rgb", "png"))
        bpy.ops.render.render(write_still="rgb" in layers, scene=self.scene.name)

    def thermal_picture(self, picture: Path) -> None:
        """Add the gradient of the temperatures to the picture, as the paper does."""
        kelvin = sensor.read_image(self.path("thermal", "exr"))[..., 0]
        rgb = sensor.read_image(picture)[..., :3]
        low, high = self.project.render.thermal_low, self.project.render.thermal_high
        sensor.write_image(self.path("thermal", "png"), sensor.thermal_composite(rgb, kelvin, low, high))

    def path(self, name: str, suffix: str) -> Path:
        """Where a file is made."""
        return self.part / Path(self.shots[name].file(suffix)).name


def _publish(out: Path, part: Path, shots: list[Shot], settings: plan.Settings, when: str) -> None:
    """Give the files of a complete frame their names, and only then enter them in the manifest."""
    for shot in shots:
        entries = {}
        for name in shot.files():
            made = part / Path(name).name
            entries[name] = manifest.describe(made) | {
                "camera": shot.camera,
                "pass": shot.name,
                "frame": shot.frame,
                "time": when,
            }
            manifest.publish(made, out / name)
        manifest.add(out, settings[shot.camera, shot.name], entries)
