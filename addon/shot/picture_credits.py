"""Credits that a shot's pictures must show: for tiles, orthophoto and picture of the Earth."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ..errors import input_error
from ..imaging import credits
from ..imaging.credits import Credits
from ..tiles import notices
from . import comparison
from .surface import orthophoto
from .tiles import tile_cut

if TYPE_CHECKING:
    from .settings import Settings
    from .shot import Shot
    from .tiles.tile_cut import TileCut


def of_settings(settings: Settings) -> Credits:
    """Collect the credits in the settings: of the orthophoto, and of the picture of the Earth."""
    terrain, found = settings.terrain, list[str]()
    if orthophoto.photographed(settings):
        found += notices.split(terrain.photo_credit)
    if terrain.globe is not None and any(camera.rig.beyond for camera in settings.cameras):
        found += notices.split(terrain.globe_credit)
    return Credits(tuple(dict.fromkeys(found)))


def of_cuts(settings: Settings, cuts: Iterable[TileCut]) -> Credits:
    """Collect the credits of the settings and of these cuts."""
    return functools.reduce(Credits.merge, (cut.words for cut in cuts), of_settings(settings))


def of_shot(shot: Shot) -> Credits:
    """Collect the credits of a shot, including its tiles if they are prepared."""
    cut = tile_cut.prepared(shot)
    return of_cuts(shot.settings, [cut] if cut else [])


def foot(shot: Shot, width: int, height: int, compares: bool = False) -> int:
    """Compute the rows of credits along the bottom of a one-camera shot's picture (see `imaging.credits`).

    Parameters
    ----------
    compares
        The picture shows all runs.
    """
    return credits.strip_height(_of_runs(shot, compares), width, height)


@functools.lru_cache(maxsize=1)
def _of_runs(shot: Shot, compares: bool) -> Credits:
    """Collect the credits of a shot, or of all its runs; cached for the next frame."""
    labels = shot.others if compares else ()
    shots = [shot, *(comparison.for_run(shot, label) for label in labels)]
    return functools.reduce(Credits.merge, map(of_shot, shots))


def check_room(shot: Shot, words: Credits) -> None:
    """Check that each camera's pictures have room for the credits.

    Raises
    ------
    InputError
        A camera's have not.
    """
    for camera in shot.settings.cameras:
        try:
            credits.blocks(words, *shot.resolution(camera), camera.rig.around)
        except ValueError as error:
            raise input_error(shot.settings.path, f'camera "{camera.name}": {error}') from None
