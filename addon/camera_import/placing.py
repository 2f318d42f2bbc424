"""Place of a foreign scene on the Earth, and the transform from its metres to the scene's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..ellipsoid import ecef, enu_axes
from ..errors import input_error, reading
from ..shot.shot import Shot
from ..tiles import geoid

Array = NDArray[np.float64]
Origin = tuple[float, float, float]

SIDECAR = "georeference.json"


def earth_matrix(latitude: float, longitude: float, height: float) -> Array:
    """Compute the matrix (4, 4) from metres east, north and up of a place to Earth-centred metres.

    Parameters
    ----------
    latitude, longitude, height
        Degrees, and metres above the WGS84 ellipsoid.
    """
    place = np.radians(latitude), np.radians(longitude)
    matrix = np.eye(4)
    matrix[:3, :3] = enu_axes(*place).T
    matrix[:3, 3] = ecef(*place, np.asarray(height))
    return matrix


def read_sidecar(path: Path) -> tuple[Origin, float | None] | None:
    """Read the origin, and the height of the geoid, of the georeference.json next to a file, if there is one.

    Raises
    ------
    InputError
        It is not a file of `firetwin export`.
    """
    beside = path.with_name(SIDECAR)
    if not beside.is_file():
        return None
    with reading(beside):
        try:
            found = files.read_json(beside)
            keys = "latitude", "longitude", "ellipsoidal_height_m"
            latitude, longitude, height = (float(found[key]) for key in keys)
            undulation = found.get("geoid_m")
            if not (abs(latitude) <= 90.0 and abs(longitude) <= 180.0 and abs(height) < 1.0e7):
                raise ValueError
            return (latitude, longitude, height), None if undulation is None else float(undulation)
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
            reason = "has no latitude, longitude and ellipsoidal_height_m; export it again, or move it away"
            raise input_error(beside, reason) from None


def find_geoid(shot: Shot, asked: float | None, sidecar: float | None = None) -> float | None:
    """Find the height of the geoid at a scene, m; None: unknown.

    Parameters
    ----------
    asked
        Option of the command line, which has precedence; then `sidecar`, `tiles.geoid` and EGM96.
    """
    for value in (asked, sidecar, shot.settings.tiles.geoid):
        if value is not None:
            return value
    grid = geoid.find()
    return None if grid is None else float(grid.plane(shot.local_frame)[0])


def scene_from(shot: Shot, origin: Origin, undulation: float) -> Array:
    """Compute the matrix (4, 4) from metres at `origin` to the scene's metres, for columns.

    Parameters
    ----------
    undulation
        Height of the geoid, m.
    """
    frame = shot.local_frame
    above = undulation if shot.run.vertical == "orthometric" else 0.0
    scene = earth_matrix(frame.latitude, frame.longitude, frame.height + above)
    return np.linalg.inv(scene) @ earth_matrix(*origin)
