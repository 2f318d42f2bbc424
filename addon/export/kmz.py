"""KMZ for Google Earth: fronts by time, a tour of each camera, ground overlays and named places.

Elements follow OGC KML 2.2 (OGC 07-147r2) with Google's extension. Absolute altitudes of KML are above mean
sea level (EGM96). A tour moves the time too. KML has perspective cameras alone. Overlays are drawn from the
run, so that the file has no imagery of others.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from .. import files
from ..imaging import map_symbols
from . import fronts, overlays, places, symbols, tracks
from .fronts import DatedFront
from .overlays import Overlay
from .places import Place
from .request import ExportRequest
from .texts import html, iso, xml
from .tracks import Track

FORMAT = {"title": "Google Earth (KMZ)", "help": "Google Earth: fronts by time, camera tours, overlays"}
ORDER = 50
NAME = "scene.kmz"
_START = 3.0  # s, flight to the first frame of a tour
_ZIP_TIME = (1980, 1, 1, 0, 0, 0)  # of all members, so that equal content is an equal file
_MODE = 0o100644 << 16  # a file that its owner may write and all may read
_COLOURS = {places.STATION: "#000000", places.LABEL: "#000000", places.IGNITION: map_symbols.FIRE_EDGE}

Array = NDArray[np.float64]


def write(request: ExportRequest) -> list[Path]:
    """Write scene.kmz."""
    drawn = overlays.draw(request.shot.run)
    members = {"doc.kml": "".join(_document(request, drawn)).encode()}
    for number, overlay in enumerate(drawn, 1):
        members[_overlay_path(number)] = _png(overlay.pixels)
    for symbol in _COLOURS:
        members[_icon_path(symbol)] = _png(_icon(symbol))

    def put(part: Path) -> None:
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, data in members.items():
                info = zipfile.ZipInfo(name, _ZIP_TIME)
                info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, _MODE
                archive.writestr(info, data)

    path = request.folder / NAME
    files.write(path, put)
    return [path]


def _document(request: ExportRequest, drawn: list[Overlay]) -> Iterator[str]:
    shot = request.shot
    yield '<?xml version="1.0" encoding="UTF-8"?>\n'
    yield '<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2">\n<Document>'
    note = "Synthetic run: not a record of the fire. " if shot.run.synthetic else ""
    yield f"<name>{xml(shot.run.name or 'Fire')}</name><open>1</open>"
    yield f"<description>{note}Written by Firetwin.</description>\n"
    yield from _styles()
    yield from _folder("Fire by time", map(_front, fronts.find(request)))
    found = tracks.find(request)
    if omitted := [track.name for track in found if track.projection != "perspective"]:
        request.tell(f"omitted, as KML has perspective cameras alone: {', '.join(omitted)}")
    shown = [track for track in found if track.projection == "perspective"]
    yield from (part for track in shown for part in _tour(track, request))
    yield from _folder("Camera paths", (_path(track, request) for track in shown))
    yield from _folder("Places", map(_place, places.find(shot)))
    yield from _folder("Maps", (_overlay(number, each) for number, each in enumerate(drawn, 1)))
    yield "</Document>\n</kml>\n"


def _folder(name: str, inside: Iterable[str]) -> Iterator[str]:
    parts = list(inside)
    if parts:
        yield f"<Folder><name>{name}</name>\n"
        yield from parts
        yield "</Folder>\n"


def _styles() -> Iterator[str]:
    edge = _colour(map_symbols.FIRE_EDGE, 255)
    yield (
        f'<Style id="front"><LineStyle><color>{edge}</color><width>2</width></LineStyle>'
        f"<PolyStyle><color>{_colour(map_symbols.FIRE_EDGE, 70)}</color></PolyStyle></Style>\n"
        '<Style id="path"><LineStyle><color>ffffffff</color><width>2</width></LineStyle></Style>\n'
    )
    for symbol in _COLOURS:
        yield (
            f'<Style id="{_icon_id(symbol)}"><IconStyle><Icon><href>{_icon_path(symbol)}</href></Icon>'
            "</IconStyle></Style>\n"
        )


def _front(front: DatedFront) -> str:
    end = f"<end>{iso(front.end)}</end>" if front.end else ""
    parts = "".join(
        "<Polygon><tessellate>1</tessellate>"
        f"<outerBoundaryIs><LinearRing>{_coordinates(polygon[0])}</LinearRing></outerBoundaryIs>"
        + "".join(
            f"<innerBoundaryIs><LinearRing>{_coordinates(hole)}</LinearRing></innerBoundaryIs>"
            for hole in polygon[1:]
        )
        + "</Polygon>"
        for polygon in front.polygons
    )
    return (
        f"<Placemark><name>{iso(front.begin)}</name>"
        f"<description>{front.area / 1e4:,.0f} ha</description>"
        f"<TimeSpan><begin>{iso(front.begin)}</begin>{end}</TimeSpan>"
        f"<styleUrl>#front</styleUrl><MultiGeometry>{parts}</MultiGeometry></Placemark>\n"
    )


def _tour(track: Track, request: ExportRequest) -> Iterator[str]:
    """Write a tour with a flight to each frame, of the frame's time in the film."""
    rate = float(request.shot.settings.time.rate)
    steps = np.diff(track.frames, prepend=track.frames[0]) / rate
    heading, tilt, roll = track.angles(request.georeference.matrix[:3, :3])
    altitude = request.georeference.above_sea(track.geodetic[:, 2])
    angle = np.degrees(2.0 * np.arctan(track.half[:, 0]))
    yield f"<gx:Tour><name>{xml(track.name)}</name><gx:Playlist>\n"
    for k, when in enumerate(track.times):
        mode, lasts = ("smooth", steps[k]) if k else ("bounce", _START)
        latitude, longitude = track.geodetic[k, :2].tolist()
        yield (
            f"<gx:FlyTo><gx:duration>{lasts:.6g}</gx:duration><gx:flyToMode>{mode}</gx:flyToMode><Camera>"
            f"<gx:horizFov>{angle[k]:.6f}</gx:horizFov><gx:TimeStamp><when>{iso(when)}</when></gx:TimeStamp>"
            f"<longitude>{longitude:.9f}</longitude><latitude>{latitude:.9f}</latitude>"
            f"<altitude>{altitude[k]:.4f}</altitude><heading>{heading[k]:.6f}</heading>"
            f"<tilt>{tilt[k]:.6f}</tilt><roll>{roll[k]:.6f}</roll>"
            "<altitudeMode>absolute</altitudeMode></Camera></gx:FlyTo>\n"
        )
    yield "</gx:Playlist></gx:Tour>\n"


def _path(track: Track, request: ExportRequest) -> str:
    latitude, longitude, height = track.geodetic.T
    points = np.column_stack([longitude, latitude, request.georeference.above_sea(height)])
    line = " ".join(f"{x:.9f},{y:.9f},{z:.4f}" for x, y, z in points)
    return (
        f"<Placemark><name>{xml(track.name)}</name><visibility>0</visibility><styleUrl>#path</styleUrl>"
        f"<LineString><altitudeMode>absolute</altitudeMode><coordinates>{line}</coordinates></LineString>"
        "</Placemark>\n"
    )


def _place(place: Place) -> str:
    lines = xml(html(place.lines))
    return (
        f"<Placemark><name>{xml(place.name)}</name><description>{lines}</description>"
        f"<styleUrl>#{_icon_id(place.symbol)}</styleUrl>"
        f"<Point><coordinates>{place.longitude:.7f},{place.latitude:.7f}</coordinates></Point></Placemark>\n"
    )


def _overlay(number: int, overlay: Overlay) -> str:
    return (
        f"<GroundOverlay><name>{overlay.title}</name><visibility>{int(number == 1)}</visibility>"
        f"<color>b0ffffff</color><drawOrder>{number}</drawOrder>"
        f"<Icon><href>{_overlay_path(number)}</href></Icon><LatLonBox>"
        f"<north>{overlay.north:.9f}</north><south>{overlay.south:.9f}</south>"
        f"<east>{overlay.east:.9f}</east><west>{overlay.west:.9f}</west></LatLonBox></GroundOverlay>\n"
    )


def _overlay_path(number: int) -> str:
    return f"files/map-{number}.png"


def _png(pixels: NDArray[np.uint8]) -> bytes:
    return sensor.encode_png(pixels / np.float32(255.0))


def _icon_id(symbol: str) -> str:
    return symbol.lower().replace(" ", "-")


def _icon_path(symbol: str) -> str:
    return f"files/{_icon_id(symbol)}.png"


def _icon(symbol: str) -> NDArray[np.uint8]:
    cross = map_symbols.FIRE_EDGE if symbol == places.IGNITION else ""
    return symbols.draw(_COLOURS[symbol], symbol == places.STATION, cross)


def _coordinates(ring: Array) -> str:
    inside = " ".join(f"{x:.9f},{y:.9f}" for x, y in ring)
    return f"<coordinates>{inside}</coordinates>"


def _colour(colour: str, alpha: int) -> str:
    """Format a colour as alpha, blue, green, red."""
    return f"{alpha:02x}{colour[5:7]}{colour[3:5]}{colour[1:3]}"
