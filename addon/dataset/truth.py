"""Truth of a sample: annotations, lines, camera and origin, as ``meta/000137.json`` keeps them.

Pixel coordinates count from the upper left corner of the picture; the centre of the first pixel is
(0.5, 0.5). Boxes are x0, y0, x1, y1 in these pixels, and exclude x1 and y1: one pixel is 0, 0, 1, 1.
Lengths are metres, temperatures kelvin, times seconds. A value of None is unknown or does not apply.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from .. import files
from ..errors import input_error, read_fault
from ..output import is_plain_name
from ..passes import masks

FORMAT = "firetwin sample 1"
FOLDER = "meta"

Box = tuple[float, float, float, float]
Polyline = list[tuple[float, float]]


@dataclass(frozen=True)
class Category:
    """Category of labels.

    Attributes
    ----------
    id
        Number in all formats, from 1: many trainers reserve 0 for the background.
    has_instances
        True if its instances have boxes; a class of the background has none.
    value
        Value in the class map (see `passes.masks`).
    """

    id: int
    name: str
    has_instances: bool
    value: int


CATEGORIES = (
    Category(1, "fire", True, masks.FIRE),
    Category(2, "smoke", True, masks.SMOKE),
    Category(3, "burned ground", False, masks.BURNED),
    Category(4, "ground", False, masks.GROUND),
    Category(5, "tree", False, masks.TREE),
    Category(6, "building", False, masks.BUILDING),
    Category(7, "sky", False, masks.SKY),
)
FIRE, SMOKE = CATEGORIES[0].id, CATEGORIES[1].id


@dataclass(frozen=True)
class Annotation:
    """One plume of smoke, or one group of flames.

    Attributes
    ----------
    id
        Number within the picture, from 1, and value of its pixels in the mask (see `files.Masks`).
    category
        `Category.id`.
    box, pixels
        Box and number of the visible pixels.
    amodal_box, amodal_pixels
        The same without the smoke in front of it; terrain and trees still hide it. Smoke: as visible.
    visible_fraction
        pixels / amodal_pixels.
    cut_by_edge
        True if a pixel lies on the edge of the picture.
    band
        Spectral band of the label: a plume that is visible in green light can be clear in the infrared.
    boxes_by_alpha
        Smoke: boxes of the pixels whose alpha (1 - transmittance) is at least the key, such as "0.2".
    contrast
        Smoke: mean over the plume of the largest difference of a channel from the picture without smoke,
        0..1 of full scale.
    distance_m
        Distance from the camera along the line of sight, m: the median over the pixels.
    nearest_m
        Distance of the nearest pixel, m.
    top_above_ground_m, top_above_sea_m
        Height of the highest point that the picture shows, m above the ground below it and above sea level.
    ground_area_m2
        Fire: area of the ground that the pixels cover, m2, measured in the horizontal plane.
    max_temperature_k
        Highest brightness temperature of the pixels in the thermal band, K.
    seconds_since_ignition
        Model time since the first fire of the run, s.
    """

    id: int
    category: int
    box: Box
    pixels: int
    amodal_box: Box
    amodal_pixels: int
    visible_fraction: float
    cut_by_edge: bool
    band: str
    boxes_by_alpha: dict[str, Box] = field(default_factory=dict)
    contrast: float | None = None
    distance_m: float | None = None
    nearest_m: float | None = None
    top_above_ground_m: float | None = None
    top_above_sea_m: float | None = None
    ground_area_m2: float | None = None
    max_temperature_k: float | None = None
    seconds_since_ignition: float | None = None


@dataclass(frozen=True)
class CameraPose:
    """Pose and lens of a perspective camera without distortion.

    Attributes
    ----------
    fx, fy, cx, cy
        Focal lengths and principal point, pixels; a point (x, y, z) of the camera projects to
        u = cx + fx x / -z, v = cy - fy y / -z.
    camera_to_world
        Matrix (4, 4) from camera axes (x right, y up, looks along -z: OpenGL) to the run's local metres,
        east, north and up of the origin.
    latitude, longitude, ellipsoidal_height_m
        Position of the camera, degrees and m above the WGS84 ellipsoid.
    origin_latitude, origin_longitude, origin_ellipsoidal_height_m
        Origin of the local metres.
    geoid_m
        Height of mean sea level above the ellipsoid, m.
    height_above_ground_m, heading, pitch, roll
        m and degrees; the heading counts from north through east, a pitch below the horizon is negative.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    camera_to_world: list[list[float]]
    latitude: float
    longitude: float
    ellipsoidal_height_m: float
    origin_latitude: float
    origin_longitude: float
    origin_ellipsoidal_height_m: float
    geoid_m: float = 0.0
    height_above_ground_m: float | None = None
    heading: float | None = None
    pitch: float | None = None
    roll: float | None = None


@dataclass(frozen=True)
class Truth:
    """All labels of a sample except its maps.

    Attributes
    ----------
    index
        Number of the sample in its data set, from 1.
    utc
        Time of the picture, ISO 8601.
    model_time_s
        The same, s since the run began.
    seconds_since_ignition
        Model time since the first fire of the run, s; negative before it; None without fire.
    annotations
        Instances with at least `labels.MIN_PIXELS` visible pixels, ids from 1.
    below_size
        Smaller and completely hidden instances; they are in no mask, and their ids follow.
    front
        Visible parts of the outline of burned ground while it grows, moving or not; polylines of pixels.
    front_geojson
        Complete outline as a GeoJSON geometry (RFC 7946), degrees east and north; None without fire.
    horizon
        Border between sky and solid surfaces without smoke, polylines of pixels.
    groups
        Groups of the split: "place", "run" and "camera".
    split
        Split that contains the sample, such as "train"; empty if the set has none.
    draw
        All drawn values, by parameter.
    source
        Origin: hash of the run, member, licences, credits, versions, device.
    labelling
        Thresholds and bands of the labels.
    sensor
        Properties of the visible camera (see `sensor`).
    thermal
        Properties of the thermal camera (see `sensor`).
    files
        Written files, by kind (see `files`), relative to the folder of the data set.
    """

    index: int
    camera: CameraPose
    utc: str
    model_time_s: float
    seconds_since_ignition: float | None = None
    annotations: tuple[Annotation, ...] = ()
    below_size: tuple[Annotation, ...] = ()
    front: list[Polyline] = field(default_factory=list)
    front_geojson: dict[str, Any] | None = None
    horizon: list[Polyline] = field(default_factory=list)
    groups: dict[str, str] = field(default_factory=dict)
    split: str = ""
    draw: dict[str, Any] = field(default_factory=dict)
    source: dict[str, Any] = field(default_factory=dict)
    labelling: dict[str, Any] = field(default_factory=dict)
    sensor: dict[str, Any] = field(default_factory=dict)
    thermal: dict[str, Any] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)

    @property
    def is_negative(self) -> bool:
        """True if the picture has no fire and no smoke, not even below the smallest size."""
        return not self.annotations and not self.below_size


MOST = 255
"""Maximum number of annotations of a picture, as ids have 8 bits in masks."""


def stem(index: int) -> str:
    """Return the file name of a sample without extension: ``000137``."""
    return f"{index:06d}"


def name(index: int) -> str:
    """Return the path of the metadata of a sample in its data set, with / on every system."""
    return f"{FOLDER}/{stem(index)}.json"


def path(folder: Path, index: int) -> Path:
    """Return the path of the metadata of a sample."""
    return folder / name(index)


def write(folder: Path, truth: Truth) -> Path:
    """Write the metadata of a sample, one value on a line; equal truths give equal bytes.

    Raises
    ------
    ValueError
        A number is infinite or NaN.
    """
    written = path(folder, truth.index)
    content = {"format": FORMAT} | asdict(truth)
    lines = (f"{json.dumps(name)}: {json.dumps(value, allow_nan=False)}" for name, value in content.items())
    files.write_text(written, "{" + ",\n ".join(lines) + "}\n")
    return written


def read(folder: Path, index: int) -> Truth:
    """Read the metadata of a sample.

    Raises
    ------
    InputError
        The file is missing, damaged or of another version.
    """
    file = path(folder, index)
    try:
        content = files.read_json(file)
        if content.pop("format") != FORMAT:
            raise input_error(file, f'is not "{FORMAT}"; write the data set again with this version')
        return from_json(content)
    except OSError as error:
        raise input_error(file, read_fault(error)) from None
    except (ValueError, TypeError, KeyError, AttributeError):
        raise input_error(file, "is damaged; delete it and resume the data set") from None


def indices(folder: Path) -> Iterator[int]:
    """Yield the numbers of the samples of a data set, ascending."""
    for file in sorted((folder / FOLDER).glob("[0-9]*.json")):
        if file.stem.isdecimal():
            yield int(file.stem)


def from_json(content: Mapping[str, Any]) -> Truth:
    """Make a truth from the content of its file; unknown keys are ignored.

    Raises
    ------
    ValueError
        A path leads out of the data set.
    """
    values = _known(Truth, content)
    if len(content.get("annotations", ())) > MOST:
        raise ValueError(f"more than {MOST} annotations")
    for name in ("annotations", "below_size"):
        values[name] = tuple(_annotation(each) for each in content.get(name, ()))
    for name in ("front", "horizon"):
        values[name] = [[(x, y) for x, y in line] for line in content.get(name, ())]
    if (split := content.get("split", "")) and not is_plain_name(split):
        raise ValueError(split)
    if not all(map(_is_within, content.get("files", {}).values())):
        raise ValueError("a file outside of the data set")
    values["camera"] = CameraPose(**_known(CameraPose, content["camera"]))
    return Truth(**values)


def _is_within(path: str) -> bool:
    """Check that a path leads to a file within the folder of the data set."""
    return all(map(is_plain_name, path.split("/")))


def _annotation(content: Mapping[str, Any]) -> Annotation:
    known = _known(Annotation, content)
    for name in ("box", "amodal_box"):
        known[name] = _box(known[name])
    known["boxes_by_alpha"] = {key: _box(box) for key, box in known.get("boxes_by_alpha", {}).items()}
    return Annotation(**known)


def _box(corners: list[float]) -> Box:
    x0, y0, x1, y1 = corners
    return x0, y0, x1, y1


def _known(kind: type, content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries of an object that are fields of a dataclass."""
    names = {each.name for each in fields(kind)}
    return {name: value for name, value in content.items() if name in names}
