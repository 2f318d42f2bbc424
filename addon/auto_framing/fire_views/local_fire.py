"""Fire around a place at a moment: flames, torching crowns, trees, and where the fire will be."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...scene.fire import flames
from ...scene.forest import stand, understorey
from ...shot.cameras.rigs import Rig
from ...shot.cameras.rigs._key import CameraKey
from ...shot.cameras.rigs.drone import Drone
from ...shot.cameras.rigs.satellite import Satellite
from ...shot.fire import flame_map
from ...shot.settings import Camera
from ...shot.shot import Shot
from . import line_of_sight
from .plume import Plume

_PIXELS = 640  # of the view from above in which trees grow
_WIDEST = 900.0  # m, width of that view; its pixels have to be below `scene.forest.visibility.PIXEL`
_ABOVE = 90.0  # m above the ground, of the camera that looks down on low plants; as far as it sees to a side
_PLANTS = (18.0, 1400, 1_000_000)  # mm, pixels across and limit: it sees plants of 0.2 m at that distance
_TALL = 0.7  # of the longest flames, length of flames that count as tall

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LocalFire:
    """Fire around a place in a clip.

    Attributes
    ----------
    shot
        The clip.
    centre
        (2,) m in the scene.
    """

    shot: Shot
    centre: Array

    @property
    def first(self) -> float:
        """Model time of the first frame, s."""
        return self.shot.frames.first

    def flame_heights(self, place: Array, time: float) -> Array:
        """Height of flames (n,), m, at scene points (n, 2) at a model time (s)."""
        return flame_map.lengths(self.shot, place, *self._indices(place), time)

    def arrival(self, place: Array) -> Array:
        """Arrival time (n,), s, at scene points (n, 2)."""
        return self.shot.bare_ground.arrival_at(*self._indices(place))

    def _indices(self, place: Array) -> tuple[Array, Array]:
        ground = self.shot.bare_ground
        return ground.indices(*ground.geodetic(*place.T))

    def tall_flames(self, reach: float) -> tuple[Array, float]:
        """Places (n, 2) of tall flames within `reach` (m) of the centre, and the height of the longest, m."""
        line = np.linspace(-reach, reach, 81)
        place = self.centre + np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
        height = self.flame_heights(place, self.first)
        if not (height > 0.0).any():
            return np.empty((0, 2)), 0.0
        top = float(np.percentile(height[height > 0.0], 90.0))
        return place[height >= _TALL * top], top

    @cached_property
    def stand(self) -> stand.Stand:
        """Trees within `_WIDEST` / 2 of the centre, in number and place as cameras near the fire see them."""
        rig = Satellite(swath=_WIDEST, keys=(CameraKey(0.0, *self._geodetic),))
        grown = stand.grow(self._from_above(rig, _PIXELS))
        return replace(grown, distance=np.zeros(len(grown.height)))

    @cached_property
    def trees(self) -> line_of_sight.Plants:
        """Trees of the stand."""
        return line_of_sight.Plants.of_stand(self.stand)

    @cached_property
    def low_plants(self) -> line_of_sight.Plants:
        """Low plants within about 100 m of the centre; it takes seconds."""
        latitude, longitude = self._geodetic
        focal_length, pixels, most = _PLANTS
        key = CameraKey(0.0, latitude, longitude, _ABOVE, "ahead", tilt=90.0)
        shot = self._from_above(Drone(focal_length=focal_length, keys=(key,)), pixels, most)
        return line_of_sight.Plants.of_understorey(understorey.grow(shot))

    @cached_property
    def torches(self) -> flames.Points:
        """Torching crowns among these trees."""
        return flames.torching_crowns(self.shot, self.stand)

    @cached_property
    def smoke(self) -> Plume:
        """Smoke of all fire in the first frame."""
        return Plume.of_shot(self.shot)

    @property
    def _geodetic(self) -> tuple[float, float]:
        """Latitude and longitude of the centre, degrees."""
        latitude, longitude = self.shot.bare_ground.geodetic(*self.centre[:, None])
        return float(latitude[0]), float(longitude[0])

    def _from_above(self, rig: Rig, pixels: int, understorey: int = 0) -> Shot:
        """Return the clip with one camera in square pictures."""
        settings = self.shot.settings
        settings = replace(
            settings,
            cameras=(Camera("above", rig=rig),),
            render=replace(settings.render, resolution=(pixels, pixels)),
            forest=replace(settings.forest, understorey=understorey),
        )
        return self.shot.with_settings(settings)
