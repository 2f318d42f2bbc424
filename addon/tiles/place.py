"""Transform from Earth-centred metres to a local frame."""

from __future__ import annotations

import numpy as np
from firetwin_core import geo
from numpy.typing import NDArray

from ..ellipsoid import ecef, enu_axes


def ecef_to_frame(
    frame: geo.LocalFrame, undulation: float = 0.0, slope: tuple[float, float] = (0.0, 0.0)
) -> NDArray[np.float64]:
    """Compute the matrix (4, 4) from Earth-centred (WGS84, EPSG:4978) to local east-north-up metres.

    Multiply it with the matrices of tiles in double precision: the product has local coordinates.
    Earth-centred coordinates in float32 are wrong by 0.5 m.

    Parameters
    ----------
    undulation
        Height of the geoid above the ellipsoid at the scene, m. In a scene of orthometric heights a point
        h above the ellipsoid is at h - undulation.
    slope
        Rise of the geoid per metre to the east and north.
    """
    latitude, longitude = np.radians(frame.latitude), np.radians(frame.longitude)
    matrix = np.eye(4)
    matrix[:3, :3] = enu_axes(latitude, longitude)
    origin = ecef(np.array(latitude), np.array(longitude), np.array(frame.height))
    matrix[:3, 3] = -matrix[:3, :3] @ origin
    matrix[2] -= slope[0] * matrix[0] + slope[1] * matrix[1]
    matrix[2, 3] -= undulation
    return matrix
