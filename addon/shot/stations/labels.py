"""Labels of a shot: named places and their positions in the scene."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ... import limits
from ...errors import input_error
from ...run import labels
from ...run.content import sha256
from ...run.labels import Label
from ..settings import Settings
from ..shot import Shot

Array = NDArray[np.float64]


class Labels(NamedTuple):
    """Names, positions (n, 3) on the ground in scene coordinates, m, and kinds ("town"; empty if unknown).

    Latitude and longitude (n,) are in degrees.
    """

    names: list[str]
    position: Array
    kinds: list[str]
    latitude: Array
    longitude: Array


_NONE = Labels([], np.empty((0, 3)), [], np.empty(0), np.empty(0))


def find(shot: Shot) -> Labels:
    """Find labels within the terrain, from the list of the user, or the built-in ones of the fire.

    Raises
    ------
    InputError
        The user's list cannot be read, or has too many labels there.
    """
    return _find(shot) if shot.settings.labels.enabled else _NONE


def of_forecast(shot: Shot) -> Labels:
    """Find the places that forecast pictures name; none if the visible picture has labels already."""
    return _find(shot) if _in_forecast(shot.settings) and not shot.settings.labels.enabled else _NONE


def _in_forecast(settings: Settings) -> bool:
    return settings.forecast.ensemble is not None and settings.forecast.places


def _first(shot: Shot) -> Shot:
    """Return the shot of the first run, whose places all runs of a comparison have."""
    first: Shot = getattr(shot, "first", shot)
    return first


def _find(shot: Shot) -> Labels:
    settings, ground = shot.settings.labels, shot.ground
    places = labels.find(_first(shot).run, settings.file)
    inside = _within(places, ground.fields.latitude, ground.fields.longitude)
    if not inside:
        return _NONE
    if settings.file:
        _check_count(settings.file, inside)
    names, latitude, longitude, kinds = zip(*inside, strict=True)
    points = ground.point(latitude, longitude)
    return Labels(list(names), points, list(kinds), np.array(latitude), np.array(longitude))


def check(settings: Settings, run: Run) -> None:
    """Check before the build that the user's list can be read, and has not too many labels in the run.

    Raises
    ------
    InputError
        It cannot, or has.
    """
    places = settings.labels
    if (places.enabled or _in_forecast(settings)) and places.file:
        _check_count(places.file, _within(labels.read(places.file), run.latitude, run.longitude))


def _within(places: list[Label], latitude: Array, longitude: Array) -> list[Label]:
    axes = latitude, longitude
    return [
        place
        for place in places
        if all(axis.min() <= at <= axis.max() for axis, at in zip(axes, place[1:3], strict=True))
    ]


def _check_count(path: Path, inside: list[Label]) -> None:
    if len(inside) > limits.LABELS:
        most = f"at most {limits.LABELS} are drawn"
        raise input_error(path, f"has {len(inside):,} labels in the scene; {most}: keep the main ones")


def inputs(settings: Settings) -> dict[str, str]:
    """Return the hash of the user's file of labels, if there is one."""
    places = settings.labels
    drawn = places.enabled or _in_forecast(settings)
    return {"labels": sha256(places.file)[:16]} if drawn and places.file else {}
