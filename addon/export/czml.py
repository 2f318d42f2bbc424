"""CZML for Cesium: clock, fronts by time, cameras and named places.

Positions are Earth-centred metres (WGS84), quaternions turn a camera's axes into Earth-centred ones: x is
the direction of view, y the left and z the top of the picture. Fronts and places are clamped to the terrain.
Format: https://github.com/AnalyticalGraphicsInc/czml-writer/wiki/CZML-Guide
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..ellipsoid import ecef
from ..geometry.quaternion import quaternions
from ..imaging import map_symbols
from ..shot.georeference import earth_centred
from . import fronts, places, tracks
from .fronts import DatedFront, Polygon
from .places import Place
from .request import ExportRequest
from .texts import html, iso
from .tracks import Track

FORMAT = {"title": "Cesium (CZML)", "help": "Cesium: clock, fronts, cameras, labels"}
ORDER = 60
NAME = "scene.czml"
_FILL = 60  # opacity of burned ground, of 255
_DIGITS = 9  # of degrees, 0.1 mm

Array = NDArray[np.float64]
Packet = dict[str, Any]


def write(request: ExportRequest) -> list[Path]:
    """Write scene.czml."""
    found = fronts.find(request)
    packets = [
        _document(request, found),
        *(packet for number, front in enumerate(found, 1) for packet in _front(number, front, request)),
        *(_camera(number, track, request) for number, track in enumerate(tracks.find(request), 1)),
        *(_place(number, place) for number, place in enumerate(places.find(request.shot), 1)),
    ]
    text = ",\n".join(json.dumps(each, ensure_ascii=False, separators=(",", ":")) for each in packets)
    files.write_text(request.folder / NAME, f"[\n{text}\n]\n")
    return [request.folder / NAME]


def _document(request: ExportRequest, found: list[DatedFront]) -> Packet:
    shot = request.shot
    first, last = (shot.utc(request.frames[at]) for at in (0, -1))
    begin = min([first, *(front.begin for front in found)])
    end = max([last, *(front.begin for front in found)])
    clock = {
        "interval": f"{iso(begin)}/{iso(end)}",
        "currentTime": iso(first),
        "multiplier": shot.speed or 1.0,
        "range": "LOOP_STOP",
        "step": "SYSTEM_CLOCK_MULTIPLIER",
    }
    return {"id": "document", "name": shot.run.name or "Fire", "version": "1.0", "clock": clock}


def _front(number: int, front: DatedFront, request: ExportRequest) -> Iterator[Packet]:
    """Make a packet of each polygon of a front, with the line around it."""
    end = front.end or request.shot.utc(request.shot.frames.count)
    span = {"availability": f"{iso(front.begin)}/{iso(max(end, front.begin))}"}
    name = f"Fire {iso(front.begin)}"
    for part, polygon in enumerate(front.polygons, 1):
        key = f"front-{number}-{part}"
        yield {"id": key, "name": name, **span, "polygon": _polygon(polygon), "polyline": _line(polygon[0])}


def _polygon(polygon: Polygon) -> Packet:
    outer, *holes = ([*map(float, _degrees(ring[:-1]))] for ring in polygon)
    made: Packet = {"positions": {"cartographicDegrees": outer}, "material": _solid(_FILL)}
    if holes:
        made["holes"] = {"cartographicDegrees": holes}
    return made


def _line(ring: Array) -> Packet:
    return {
        "positions": {"cartographicDegrees": [*map(float, _degrees(ring))]},
        "clampToGround": True,
        "width": 2.0,
        "material": _solid(255),
    }


def _degrees(ring: Array) -> Array:
    """List longitude, latitude and height 0 of each point."""
    return np.column_stack([np.round(ring, _DIGITS), np.zeros(len(ring))]).ravel()


def _solid(alpha: int) -> Packet:
    colour = [int(map_symbols.FIRE_EDGE[i : i + 2], 16) for i in (1, 3, 5)]
    return {"solidColor": {"color": {"rgba": [*colour, alpha]}}}


def _camera(number: int, track: Track, request: ExportRequest) -> Packet:
    epoch = track.times[0]
    since = np.array([(each - epoch).total_seconds() for each in track.times])
    position = earth_centred(track.geodetic)
    turned = request.georeference.matrix[:3, :3] @ track.rotation @ _FORWARD
    quaternion = np.roll(quaternions(turned), -1, axis=1)  # x, y, z, w
    samples = {"epoch": iso(epoch), "interpolationAlgorithm": "LINEAR", "interpolationDegree": 1}
    packet: Packet = {
        "id": f"camera-{number}",
        "name": track.name,
        "availability": f"{iso(epoch)}/{iso(track.times[-1])}",
        "position": samples | {"cartesian": _samples(since, np.round(position, 4))},
        "orientation": samples | {"unitQuaternion": _samples(since, np.round(quaternion, 9))},
        "point": {"pixelSize": 8, "color": {"rgba": [255, 255, 255, 255]}},
        "label": _label(track.name),
        "path": {"material": {"solidColor": {"color": {"rgba": [255, 255, 255, 160]}}}, "width": 1.0},
    }
    if track.projection == "perspective":
        angle = np.degrees(2.0 * np.arctan(track.half))
        names = ("horizontalFieldOfView", "verticalFieldOfView")
        packet["properties"] = {
            name: samples | {"number": _samples(since, np.round(angle[:, [k]], 6))}
            for k, name in enumerate(names)
        }
    return packet


def _place(number: int, place: Place) -> Packet:
    where = np.radians([place.latitude, place.longitude])
    position = ecef(where[0], where[1], np.asarray(0.0))
    return {
        "id": f"place-{number}",
        "name": place.name,
        "description": html(place.lines),
        "position": {"cartesian": np.round(position, 4).tolist()},
        "point": {
            "pixelSize": 8,
            "color": {"rgba": [255, 255, 255, 255]},
            "outlineColor": {"rgba": [0, 0, 0, 255]},
            "outlineWidth": 2.0,
            "heightReference": {"heightReference": "CLAMP_TO_GROUND"},
        },
        "label": _label(place.name) | {"heightReference": {"heightReference": "CLAMP_TO_GROUND"}},
    }


def _label(text: str) -> Packet:
    return {
        "text": text,
        "font": "14px sans-serif",
        "style": "FILL_AND_OUTLINE",
        "outlineColor": {"rgba": [0, 0, 0, 255]},
        "outlineWidth": 3.0,
        "pixelOffset": {"cartesian2": [0, -18]},
    }


def _samples(since: Array, values: Array) -> list[float]:
    """Join times (n,), s, and values (n, k) to one list: t, v1, ... vk, t, ..."""
    return np.column_stack([np.round(since, 6), values]).ravel().tolist()


_FORWARD = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
"""Axes forward, left and top as columns, in a camera's axes right, up and back."""
