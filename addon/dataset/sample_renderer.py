"""Renderer of samples: moves camera, sun and air in a built scene, and renders the maps of each sample."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import sensor, volume
from numpy.typing import NDArray

from ..blender.owned import Stage
from ..render import frame_cost, surfaces
from ..render.integrated import IntegratedRenderer
from ..render.picture import Picture
from ..scene import flame_field
from ..shot.fire import flame_map
from ..shot.shot import Shot
from . import metering
from .sample_eye import CentreEye, SampleEye

Array = NDArray[np.float32]

_FRAME = 1


class SampleRenderer(IntegratedRenderer):
    """Renderer of the samples of a built scene."""

    def __init__(self, shot: Shot, stage: Stage) -> None:
        super().__init__(shot, stage, frame_cost.FrameCost())

    def maps(
        self,
        shot: Shot,
        smoke: Sequence[volume.Bricks],
        folder: Path,
        cost: frame_cost.FrameCost,
        error: float,
    ) -> dict[str, Any]:
        """Render the maps of a sample (see `rendered.Rendered`) for the current state of the scene.

        Parameters
        ----------
        error
            Error of the exposure, stops.
        """
        self.shot, self.cost = shot, cost
        (view,) = shot.paths
        name = view.camera.name
        flame_field.set_reach(self.stage, flame_map.reach(shot, view))
        flames, outline = self._flames(_FRAME)
        cells = self._measure_cells(outline)
        self._set_distances(cells, [])  # the twin shows surfaces behind smoke
        if self.shadow:
            with cost.part(frame_cost.SHADOW):
                self.shadow.cast(self.stage, smoke)
        with self._kept_in_cycles():
            with cost.part(frame_cost.SURFACES):
                found = self._surfaces("rgb", folder)
            with cost.part("classes"):
                centres = self._surfaces("masks", folder, centres=True)
        burning = flames, outline, cells
        eye = SampleEye(shot, self.stage, found, 0, smoke, *burning)
        centre = CentreEye(shot, self.stage, centres, 0, smoke, *burning)
        with cost.part(frame_cost.MARCH):
            light = eye.light()
            away = eye.smoke_range(light.clear)
        with cost.part("labels"):
            classes, surface, instance = centre.classes(light.clear)
        with cost.part("thermal"):
            kelvin = eye.kelvin()
        film = float(self.scene.view_settings.exposure)
        risen = metering.rise(light.picture, film)
        factor = np.float32(2.0 ** (risen + error))
        rgb = self._displayed(factor * light.picture, name, folder)
        twin = rgb if light.twin is light.picture else self._displayed(factor * light.twin, name, folder)
        return {
            "rgb": rgb,
            "twin": twin,
            "light": light.picture,
            "twin_light": light.twin,
            "smoke_light": light.smoke,
            "exposure": film + risen + error,
            "risen": risen,
            "clear": light.clear,
            "smoke_range": away,
            "classes": classes,
            "surface": surface,
            "instance": instance,
            "depth": centre.depth,
            "range": centre.range,
            "fire": light.fire,
            "twin_fire": light.twin_fire,
            "kelvin": kelvin,
        }

    def _displayed(self, light: Array, name: str, folder: Path) -> Array:
        """Apply the film's contrast and bloom to radiance (h, w, 3)."""
        picture = Picture(name, _FRAME, "rgb")
        self._composite(light, picture, folder)
        file = folder / Path(picture.file("png")).name
        shown = sensor.read_image(file)[..., :3]
        file.unlink()
        return shown

    @contextmanager
    def _kept_in_cycles(self) -> Iterator[None]:
        """Let the renders of a sample share meshes and search trees in Cycles, during a `with` block."""
        render = self.scene.render
        render.use_persistent_data = True
        try:
            yield
        finally:
            render.use_persistent_data = False

    def _surfaces(self, name: str, folder: Path, centres: bool = False) -> surfaces.Channels:
        """Render the surfaces of a pass."""
        ((_, found),) = surfaces.render(self.scene, [name], folder, centres=centres)
        return found[name]
