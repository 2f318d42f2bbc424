"""Place of a scene on the Earth: its origin, heights, and the transform to Earth-centred metres.

The scene's x, y and z are east, north and up at its origin. A scene of heights above sea level is shifted by
the height of the geoid along z. Geodetic positions keep the run's latitude and longitude, and add the height
of the geoid; `matrix` is rigid, and agrees with them at the origin. At a distance d both differ by
geoid_m d / R, R being the radius of the Earth: 0.1 m at 25 km for 25 m.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from firetwin_core import geo
from numpy.typing import ArrayLike, NDArray

from .. import files
from ..ellipsoid import ecef, enu_axes
from ..tiles import geoid
from .shot import Shot

Array = NDArray[np.float64]
NAME = "georeference.json"
_ELLIPSOIDAL, _ORTHOMETRIC = "height above the WGS84 ellipsoid", "height above mean sea level (EGM96)"


@dataclass(frozen=True)
class Georeference:
    """Place of a scene on the Earth.

    Attributes
    ----------
    frame
        Local frame of the scene, with the height of its origin in the heights of the run.
    geoid_m
        Height of the geoid above the ellipsoid at the origin, m.
    source
        Source of `geoid_m`.
    orthometric
        True if heights of the run are above mean sea level, False if above the ellipsoid.
    """

    frame: geo.LocalFrame
    geoid_m: float
    source: str
    orthometric: bool = True

    @property
    def offset(self) -> float:
        """Difference between heights above the ellipsoid and heights of the run, m."""
        return self.geoid_m if self.orthometric else 0.0

    @property
    def latitude(self) -> float:
        """Latitude of the origin, degrees."""
        return self.frame.latitude

    @property
    def longitude(self) -> float:
        """Longitude of the origin, degrees."""
        return self.frame.longitude

    @property
    def model_height(self) -> float:
        """Height of the origin in the heights of the run, m."""
        return self.frame.height

    @property
    def height(self) -> float:
        """Height of the origin above the ellipsoid, m."""
        return self.frame.height + self.offset

    @cached_property
    def matrix(self) -> Array:
        """Matrix (4, 4) from local metres to Earth-centred metres (WGS84, EPSG:4978), for columns."""
        latitude, longitude = np.radians(self.latitude), np.radians(self.longitude)
        matrix = np.eye(4)
        matrix[:3, :3] = enu_axes(latitude, longitude).T
        matrix[:3, 3] = ecef(latitude, longitude, np.asarray(self.height))
        return matrix

    def geodetic(self, local: ArrayLike) -> Array:
        """Convert local positions (n, 3) to latitude, longitude (degrees) and height above the ellipsoid."""
        latitude, longitude, height = self.frame.reverse(np.asarray(local, np.float64).reshape(-1, 3))
        return np.column_stack([latitude, longitude, np.asarray(height) + self.offset])

    def local(self, geodetic: ArrayLike) -> Array:
        """Convert latitude, longitude (degrees) and height above the ellipsoid (n, 3) to local positions."""
        latitude, longitude, height = np.asarray(geodetic, np.float64).reshape(-1, 3).T
        return self.frame.forward(latitude, longitude, height - self.offset)

    def above_sea(self, height: ArrayLike) -> Array:
        """Convert heights above the ellipsoid to heights above mean sea level, m."""
        return np.asarray(height, np.float64) - self.geoid_m

    def ecef(self, local: ArrayLike) -> Array:
        """Convert local positions (n, 3) to Earth-centred metres by their geodetic positions."""
        return earth_centred(self.geodetic(local))

    @property
    def wkt(self) -> str:
        """WKT 2 (ISO 19162:2019) of the east-north-up frame, which PROJ reads."""
        return _WKT.format(latitude=self.latitude, longitude=self.longitude, height=self.height)

    def as_json(self) -> dict[str, object]:
        """Return the content of georeference.json."""
        return {
            "latitude": self.latitude,
            "longitude": self.longitude,
            "ellipsoidal_height_m": self.height,
            "model_height_m": self.model_height,
            "geoid_m": self.geoid_m,
            "geoid_source": self.source,
            "model_datum": _ORTHOMETRIC if self.orthometric else _ELLIPSOIDAL,
            "axes": "x east, y north, z up, m",
            "local_to_ecef": self.matrix.tolist(),
            "wkt": self.wkt,
        }

    def write(self, folder: Path) -> Path:
        """Write georeference.json."""
        files.write_text(folder / NAME, json.dumps(self.as_json(), indent=1) + "\n")
        return folder / NAME


def resolve(shot: Shot, geoid_m: float | None = None) -> Georeference:
    """Find the place of a shot's scene.

    Parameters
    ----------
    geoid_m
        Height of the geoid, m; None: `tiles.geoid`, else EGM96 at the origin, else 0.
    """
    return Georeference(
        shot.local_frame, *_undulation(shot, geoid_m), orthometric=shot.run.vertical == "orthometric"
    )


UNKNOWN = "unknown: 0 is assumed"
"""Source of the height of the geoid without a value and without a grid."""


def _undulation(shot: Shot, asked: float | None) -> tuple[float, str]:
    """Find the height of the geoid at a scene, m, and its source."""
    if asked is not None:
        return asked, "--geoid"
    if shot.settings.tiles.geoid is not None:
        return shot.settings.tiles.geoid, "tiles.geoid of the scene file"
    found = geoid.find()
    if found is None:
        return 0.0, UNKNOWN
    return found.plane(shot.local_frame)[0], "EGM96 at the origin"


def earth_centred(geodetic: ArrayLike) -> Array:
    """Convert latitude, longitude (degrees) and height above the ellipsoid (n, 3) to Earth-centred metres."""
    latitude, longitude, height = np.asarray(geodetic, np.float64).reshape(-1, 3).T
    return ecef(np.radians(latitude), np.radians(longitude), height)


_WKT = """\
GEODCRS["Firetwin scene, east-north-up",
 BASEGEOGCRS["WGS 84",
  DATUM["World Geodetic System 1984",
   ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]],
  PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]],
  ID["EPSG",4979]],
 DERIVINGCONVERSION["Topocentric at the scene's origin",
  METHOD["Geographic/topocentric conversions",ID["EPSG",9837]],
  PARAMETER["Latitude of topocentric origin",{latitude!r},
   ANGLEUNIT["degree",0.0174532925199433],ID["EPSG",8834]],
  PARAMETER["Longitude of topocentric origin",{longitude!r},
   ANGLEUNIT["degree",0.0174532925199433],ID["EPSG",8835]],
  PARAMETER["Ellipsoidal height of topocentric origin",{height!r},
   LENGTHUNIT["metre",1],ID["EPSG",8836]]],
 CS[Cartesian,3],
  AXIS["topocentric east (U)",east,ORDER[1]],
  AXIS["topocentric north (V)",north,ORDER[2]],
  AXIS["topocentric up (W)",up,ORDER[3]],
  LENGTHUNIT["metre",1]]"""
