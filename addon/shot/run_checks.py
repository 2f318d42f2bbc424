"""Checks of settings against their run."""

from __future__ import annotations

import numpy as np
from firetwin_core.run import Run

from ..run import areas, times
from . import frames, scene_inputs
from .schema import scene_text
from .settings import Settings
from .stations import labels, station_signs
from .surface import globe_picture, land_use, observed, orthophoto
from .terrain import elevation

_HIGHEST, _WIDEST = 89.9, 170.0  # degrees of latitude, and of longitude to each side of a run


def check(settings: Settings, run: Run) -> None:
    """Check time window, camera positions, other run-dependent settings, and the user's own files.

    Raises
    ------
    InputError
        Names the line of the scene file, or the file.
    """
    _window(settings, run)
    _pole(settings, run)
    elevation.check(settings, run)
    orthophoto.check(settings, run)
    land_use.check(settings, run)
    globe_picture.check(settings)
    _smoke(settings)
    observed.check(settings)
    scene_inputs.check(settings, run)
    labels.check(settings, run)
    station_signs.check(settings, run)
    for index, camera in enumerate(settings.cameras):
        for where, latitude, longitude in (*camera.rig.coordinates(), *camera.rig.coordinates_in(run)):
            _near(settings, run, ("cameras", index, *where), camera.name, latitude, longitude)
        if invalid := camera.rig.validate_against(run, frames.resolve(settings.time, run)):
            reason = f'camera "{camera.name}" {invalid[1]}'
            raise scene_text.error_at(settings.path, ("cameras", index, *invalid[0]), reason)


def _smoke(settings: Settings) -> None:
    if settings.light.smoke and any(camera.rig.beyond for camera in settings.cameras):
        reason = "light.smoke is not drawn in scenes with a globe camera; remove one of them"
        raise scene_text.error_at(settings.path, ("light", "smoke"), reason)


def _window(settings: Settings, run: Run) -> None:
    first, last = float(run.times[0]), float(run.times[-1])
    time = settings.time.resolved()
    for name in ("start", "end"):
        moment = getattr(time, name)
        if moment is not None and not first <= times.seconds(run, moment) <= last:
            span = " to ".join(f"{times.utc(run, t):%Y-%m-%dT%H:%M:%SZ}" for t in (first, last))
            reason = f"time.{name} lies outside of the run, which has {span}"
            if getattr(settings.time, name) is None:
                name = "speed"
                reason = (
                    f"time.speed leads to {moment:%Y-%m-%dT%H:%M:%SZ}, outside of the run, which has {span}"
                )
            raise scene_text.error_at(settings.path, ("time", name), reason)


def _pole(settings: Settings, run: Run) -> None:
    """Raise an error if the ground around a run reaches a pole, or meets itself around it."""
    size = areas.cell_size(run.latitude, run.longitude)
    cells = settings.terrain.apron / min(size)  # of the apron's half-width, which keeps the shape of a cell
    north, east = (
        float(np.ptp(axis)) / max(len(axis) - 1, 1) * cells for axis in (run.latitude, run.longitude)
    )
    highest = float(np.abs(run.latitude).max())
    if highest + north > _HIGHEST or east > _WIDEST:
        ground = f"the ground of {settings.terrain.apron / 1e3:g} km around it would reach the pole"
        reason = f"the run lies at {highest:.2f} degrees of latitude, and {ground}; choose a smaller apron"
        raise scene_text.error_at(settings.path, ("terrain", "apron"), reason)


def _near(
    settings: Settings,
    run: Run,
    where: tuple[str | int, ...],
    camera: str,
    latitude: float,
    longitude: float,
) -> None:
    """Raise an error if a point lies beyond the terrain."""
    middle = [float(axis[0] + axis[-1]) / 2 for axis in (run.latitude, run.longitude)]
    place = float(areas.turned(longitude, middle[1]))
    if -90 < latitude < 90:
        dx, dy = areas.spacing([middle[0] - 0.5, middle[0] + 0.5], [middle[1] - 0.5, middle[1] + 0.5])
        east, north = (place - middle[1]) * dx, (latitude - middle[0]) * dy
        far = float(np.hypot(east, north))
    else:
        far = np.inf
    inside = min(run.latitude) <= latitude <= max(run.latitude)
    inside = inside and min(run.longitude) <= place <= max(run.longitude)
    if not inside and far > settings.terrain.apron:
        what = "looks at a point" if str(where[-1]).startswith("target") else "is"
        reason = (
            f'camera "{camera}" {what} at {latitude:g} N {longitude:g} E, {far / 1e3:,.0f} km from the '
            f"middle of the run ({middle[0]:.2f} N {middle[1]:.2f} E); "
            f"the ground ends at {settings.terrain.apron / 1e3:g} km"
        )
        raise scene_text.error_at(settings.path, where, reason)
