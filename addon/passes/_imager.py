"""Satellite imager picture, registered to a camera's picture, with pixels of the imager's size.

A camera above the equator represents GOES-R's ABI at its longitude, any other camera VIIRS (see
`shot.satellites.imager`). Each visible ground point, from depth, shows the imager's pixel that contains it.
Points outside of all complete pixels in the run's domain are grey.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..imaging import colour_bar
from ..shot.cameras import pixel_rays
from ..shot.cameras.rigs.satellite import Satellite
from ..shot.passes import DerivedPass, Files
from ..shot.satellites import imager
from ..shot.shot import Shot

KNEE = 20.0  # K; warm ground and the burn scar take half of the palette
PALETTE = "inferno"
_GREY = 0.12


PASS = DerivedPass(
    files=("png",),
    film=True,
    aspects=frozenset({"time", "camera"}),
    needs=("depth",),
    code=("shot/satellites",),
)


def finish(
    files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int, *, long: bool
) -> None:
    """Write the brightness temperature of the long or the short band, with colour bar, time and label."""
    view = pixel_rays.path_of(shot.paths, camera)
    instrument, grid = _instrument(shot, view.camera.rig)
    moment = shot.utc(frame)
    try:
        measured = imager.picture(instrument, grid, shot.fire, float(shot.frames.time(frame)))
    except imager.NothingSeenError:
        measured = None
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0]
    kelvin = np.full(planar.shape, np.nan)
    if measured is not None:
        kelvin = _register(
            shot, pixel_rays.points(view, frame, planar), measured, measured.long if long else measured.short
        )
    most = instrument.saturation[long]
    low = min(shot.air.coldest, most - 1.0)
    shown = sensor.colour(kelvin, low, most, PALETTE, KNEE)
    shown[np.isnan(kelvin)] = _GREY
    colour_bar.draw(shown, low, most, PALETTE, KNEE)
    wave = instrument.long if long else instrument.short
    lines = [f"{instrument.name} {wave:g} um", f"{moment:%Y-%m-%d %H:%M}Z", instrument.label(moment.year)]
    colour_bar.write_title(shown, lines)
    sensor.write_image(files["png"], shown)


def _instrument(shot: Shot, rig: object) -> tuple[imager.Instrument, imager.ImagerGrid]:
    """Return the imager that a camera represents, and its pixel grid."""
    longitude = rig.geostationary if isinstance(rig, Satellite) else None
    instrument = imager.VIIRS if longitude is None else imager.ABI
    return instrument, imager.grid_of(instrument, shot.run, longitude or 0.0)


def _register(
    shot: Shot, points: NDArray[np.float64], measured: imager.ImagerPicture, band: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Sample the imager's brightness temperature (h, w), K, at scene points (h, w, 3); NaN outside."""
    kelvin = np.full(points.shape[:2], np.nan)
    ground = np.isfinite(points).all(axis=-1)
    if not ground.any():
        return kelvin
    latitude, longitude, _ = shot.local_frame.reverse(points[ground])
    place = zip(
        measured.grid.forward(latitude, longitude), (measured.row, measured.column), band.shape, strict=True
    )
    inside, index = np.ones(len(latitude), bool), []
    for fractional, first, count in place:
        at = np.floor(np.nan_to_num(fractional, nan=-1e9)).astype(np.int64) - first
        inside &= (at >= 0) & (at < count)
        index.append(np.clip(at, 0, count - 1))
    kelvin[ground] = np.where(inside, band[tuple(index)], np.nan)
    return kelvin
