"""Labels of a sample: plumes and flames with boxes and masks, the front and the horizon. Needs no Blender.

Smoke counts where it hides at least `ALPHAS[0]` of the background and changes the picture by at least
`OUTLINE`, if some of its plume changes it by `CONTRAST`: smoke that nobody can see has no box. Fire counts
where the mask pass shows it, or where flames give at least `GLOW` of white and `SHARE` of the light of the
pixel. Parts with gaps of at most `GAP` of the picture's width are one instance: a trunk, a narrow ridge or a
thin spot does not divide a plume; wider terrain does. Smoke that nobody can see joins the parts of its plume,
but has no pixels in the mask beyond its holes and gaps (`visible_smoke`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..passes import masks as classes
from ..shot.cameras import path
from . import components, survey, truth
from .files import Masks
from .rendered import Rendered
from .survey import Place
from .truth import Annotation, Box, CameraPose, Polyline, Truth

ALPHAS = (0.05, 0.2, 0.5)
"""Opacities of smoke: the first one outlines a plume, each has a box."""
CONTRAST, OUTLINE = 0.08, 0.03
"""Least differences from the smoke-free twin, shares of full scale of a channel in display values: of some
pixels of a plume, and of its outline. The mean over 5 x 5 pixels counts, so that noise does not. In front of
a bright sky they are 23 % and 9 % of luminance; WMO-No. 8 sets the meteorological optical range at 5 %, at
which nobody would draw a box (assumed). Smoke between the two is doubtful: it has no box, and is ignored.
"""
HORIZON = 0.02
"""Least difference of land and sky at the horizon, as `CONTRAST`. In front of a bright sky it is 6 % of
luminance: a long edge is seen near the threshold.
"""
GLOW = 0.02
"""Least light of flames, share of white, in their brightest channel (assumed, as for smoke)."""
SHARE = 0.2
"""Least share of flames in the light of a pixel, in that channel: they then look orange (by eye)."""
GAP = 0.02
"""Largest gap within an instance, share of the picture's width."""
PIECE, AROUND = 0.05, 0.05
"""Least share of a plume's pixels: smaller smoke is a piece of the plume if invisible smoke joins them, or
their gap is at most the second number, a share of the picture's width. Pieces have no box, and the box of
their plume leaves them out."""
MIN_PIXELS = 16
"""Least number of visible pixels of an instance with a box."""

SMOKE_BAND = "visible: opacity in green light, contrast in red, green and blue"
FIRE_BAND = "visible"

HIDES = 0.5
"""Opacity of smoke that hides the front, as of the class smoke in `masks`."""

CLEARNESS = 0.1
"""Least share of light that air lets pass from a front. Burned and other ground, with a contrast of 50 %
(assumed), then differ by the 5 % of the meteorological optical range."""

_REACH = 2  # pixels on each side of the mean contrast

Mask = NDArray[np.bool_]
Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Instance:
    """Pixels of an instance: rows and columns without smoke, and which of them are visible."""

    category: int
    row: NDArray[np.int64]
    column: NDArray[np.int64]
    visible: Mask

    @property
    def pixels(self) -> int:
        return int(self.visible.sum())

    def place(self, chosen: Mask) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return rows and columns of some of the pixels."""
        return self.row[chosen], self.column[chosen]


def label(rendered: Rendered, place: Place, index: int) -> tuple[Truth, Masks]:
    """Label a rendered sample.

    Parameters
    ----------
    place
        Ground and fire at the model time of the sample.
    index
        Number of the sample.

    Returns
    -------
    The truth without the fields that only its draw knows (split, groups, source, sensor), and the masks.
    """
    contrast = smoke_contrast(rendered)
    smoke = rendered.alpha >= ALPHAS[0]
    width = rendered.camera.width
    seen, doubtful = visible_smoke(smoke, contrast, width)
    visible, amodal = fire_masks(rendered)
    pieces = _pieces(seen, smoke, width)
    plumes = seen & ~pieces
    found = [
        *_instances(truth.FIRE, amodal, visible, amodal, width),
        *_instances(truth.SMOKE, plumes, plumes, smoke, width),
    ]
    large = [each for each in found if each.pixels >= MIN_PIXELS][: truth.MOST]
    small = [each for each in found if not any(each is other for other in large)]
    for each in (pieces, doubtful):
        small += _instances(truth.SMOKE, each, each, each, width)
    annotations = [
        _annotation(number, each, rendered, place, contrast) for number, each in enumerate(large + small, 1)
    ]
    since = None if place.ignition is None else rendered.model_time - place.ignition
    sample_truth = Truth(
        index=index,
        camera=camera_pose(rendered, place),
        utc=rendered.time.isoformat(),
        model_time_s=rendered.model_time,
        seconds_since_ignition=since,
        annotations=tuple(annotations[: len(large)]),
        below_size=tuple(annotations[len(large) :]),
        front=_polylines(
            survey.front_in_picture(
                place, rendered.camera, rendered.alpha >= HIDES, rendered.facts.get("haze", 0.0), CLEARNESS
            )
        ),
        front_geojson=place.geojson(),
        horizon=_polylines(survey.skyline(rendered.depth, rendered.rgb, HORIZON)),
        labelling=thresholds() | {"smoke_without_contrast_pixels": int((smoke & ~seen).sum())},
    )
    return sample_truth, _paint(large, rendered.depth.shape)


def thresholds() -> dict[str, Any]:
    """Return the thresholds and bands of the labels for the metadata."""
    return {
        "smoke": {"band": SMOKE_BAND, "alpha": list(ALPHAS), "contrast": CONTRAST, "outline": OUTLINE},
        "fire": {"band": FIRE_BAND, "glow_of_white": GLOW, "share_of_light": SHARE, "class": "masks: fire"},
        "front": {"hiding_alpha": HIDES, "clearness_of_air": CLEARNESS},
        "gap_of_width": GAP,
        "pieces": {"share": PIECE, "gap_of_width": AROUND},
        "min_pixels": MIN_PIXELS,
    }


def visible_smoke(smoke: Mask, contrast: Array, width: int) -> tuple[Mask, Mask]:
    """Find the pixels (h, w) of smoke that are visible, and those that are doubtful.

    Visible smoke reaches down to the outline's contrast, so that a plume does not fall into the splinters
    that a threshold cuts out of it. Holes of a plume and gaps of at most `AROUND`, where its light equals
    the background's, belong to it.
    """
    outlined = smoke & (contrast >= OUTLINE)
    plumes, count = components.group(outlined, round(GAP * width))
    sure = np.bincount(plumes[outlined & (contrast >= CONTRAST)], minlength=count + 1) >= MIN_PIXELS
    seen = outlined & sure[plumes]
    return smoke & components.fill(seen, round(AROUND * width)), outlined & ~seen


def smoke_contrast(rendered: Rendered) -> Array:
    """Compute how much smoke changes the picture (h, w), 0..1 of full scale, in the channel with the most."""
    difference = rendered.rgb.astype(np.float64) - rendered.twin
    contrast: Array = np.abs(components.local_mean(difference, _REACH)).max(axis=-1)
    return contrast


def fire_masks(rendered: Rendered) -> tuple[Mask, Mask]:
    """Find the pixels (h, w) that show fire, and those that would without smoke."""
    least = GLOW * 2.0**-rendered.exposure
    visible = (rendered.classes == classes.FIRE) | _is_bright(rendered.fire, rendered.light, least)
    amodal = (rendered.surface == classes.FIRE) | _is_bright(rendered.twin_fire, rendered.twin_light, least)
    return visible, visible | amodal


def _is_bright(flames: NDArray, light: NDArray, least: float) -> Mask:
    """Find the pixels (h, w) in which flames are bright enough, and bright compared with all light."""
    return np.any((flames >= least) & (flames >= SHARE * light), axis=-1)


def camera_pose(rendered: Rendered, place: Place) -> CameraPose:
    """Describe pose and lens of the camera."""
    camera, origin = rendered.camera, place.georeference
    here = camera.to_world[:3, 3]
    latitude, longitude, height = origin.geodetic(here)[0].tolist()
    heading, pitch, roll = _angles(camera.to_world[:3, :3], place, here)
    return CameraPose(
        width=camera.width,
        height=camera.height,
        fx=float(camera.fx),
        fy=float(camera.fy),
        cx=float(camera.cx),
        cy=float(camera.cy),
        camera_to_world=camera.to_world.tolist(),
        latitude=latitude,
        longitude=longitude,
        ellipsoidal_height_m=height,
        origin_latitude=origin.latitude,
        origin_longitude=origin.longitude,
        origin_ellipsoidal_height_m=origin.height,
        geoid_m=origin.geoid_m,
        height_above_ground_m=float(place.height_above_ground(here[None])[0]),
        heading=heading,
        pitch=pitch,
        roll=roll,
    )


def _angles(turned: Array, place: Place, here: Array) -> tuple[float, float, float]:
    """Compute heading, pitch and roll of a rotation at a point, degrees."""
    east, north, up = path.compass(place.georeference.frame, here)
    right, above, ahead = turned[:, 0], turned[:, 1], -turned[:, 2]
    # for a camera looking straight down, the upper edge of the picture defines the heading
    level = ahead if abs(ahead @ up) < 0.9999 else above
    heading = np.degrees(np.arctan2(level @ east, level @ north)) % 360.0
    pitch = np.degrees(np.arcsin(np.clip(ahead @ up, -1.0, 1.0)))
    roll = 0.0 if level is above else np.degrees(np.arctan2(-(right @ up), above @ up))
    return float(heading), float(pitch), float(roll)


def _instances(category: int, amodal: Mask, visible: Mask, joined: Mask, width: int) -> list[_Instance]:
    """Separate masks into instances, with the most visible pixels first; `joined` connects their parts."""
    labels, count = components.group(joined | amodal, round(GAP * width))
    row, column = np.nonzero(amodal)
    number = labels[row, column]
    order = np.argsort(number, kind="stable")
    bounds = np.searchsorted(number[order], np.arange(1, count + 2))
    instances = []
    for first, last in pairwise(bounds.tolist()):
        some = order[first:last]
        if not len(some):
            continue  # smoke that nobody can see
        instances.append(_Instance(category, row[some], column[some], visible[row[some], column[some]]))
    return sorted(instances, key=lambda each: -each.pixels)


def _pieces(seen: Mask, smoke: Mask, width: int) -> Mask:
    """Find the pieces of plumes among the pixels (h, w) of visible smoke."""
    parts, count = components.group(seen, round(GAP * width))
    near, groups = components.group(smoke, round(AROUND * width))
    sizes, plumes = np.bincount(parts[seen], minlength=count + 1), np.zeros(groups + 1, np.int64)
    np.maximum.at(plumes, near[seen], sizes[parts[seen]])
    return seen & (sizes[parts] < PIECE * plumes[near])


def _annotation(
    number: int, instance: _Instance, rendered: Rendered, place: Place, contrast: Array
) -> Annotation:
    """Measure an instance."""
    row, column = instance.row, instance.column
    shown = instance.place(instance.visible)
    annotation = Annotation(
        id=number,
        category=instance.category,
        box=_box(*shown),
        pixels=instance.pixels,
        amodal_box=_box(row, column),
        amodal_pixels=len(row),
        visible_fraction=instance.pixels / len(row),
        cut_by_edge=_touches_edge(row, column, rendered.depth.shape),
        band=SMOKE_BAND if instance.category == truth.SMOKE else FIRE_BAND,
        max_temperature_k=float(rendered.kelvin[row, column].max()),
        seconds_since_ignition=None if place.ignition is None else rendered.model_time - place.ignition,
    )
    if instance.category == truth.SMOKE:
        return _measure_smoke(annotation, instance, rendered, place, contrast)
    return _measure_fire(annotation, instance, rendered, place)


def _measure_smoke(
    annotation: Annotation, instance: _Instance, rendered: Rendered, place: Place, contrast: Array
) -> Annotation:
    """Add opacity boxes, contrast, distance and top of a plume."""
    row, column = instance.row, instance.column
    alpha, away = rendered.alpha[row, column], rendered.smoke_range[row, column]
    boxes = {f"{least:g}": _box(*instance.place(alpha >= least)) for least in ALPHAS if alpha.max() >= least}
    has_range = np.isfinite(away)
    annotation = replace(annotation, boxes_by_alpha=boxes, contrast=float(contrast[row, column].mean()))
    if not has_range.any():
        return annotation
    points = survey.at_range(rendered.camera, *instance.place(has_range), away[has_range])
    top = points[[np.argmax(place.height_above_sea(points))]]
    return replace(
        annotation,
        distance_m=float(np.median(away[has_range])),
        nearest_m=float(away[has_range].min()),
        top_above_ground_m=float(place.height_above_ground(top)[0]),
        top_above_sea_m=float(place.height_above_sea(top)[0]),
    )


def _measure_fire(
    annotation: Annotation, instance: _Instance, rendered: Rendered, place: Place
) -> Annotation:
    """Add distance and ground area of flames, from the burning ground behind their pixels."""
    row, column = instance.row, instance.column
    away, depth = rendered.range[row, column], rendered.depth[row, column]
    has_range = np.isfinite(away)
    points = survey.at_range(rendered.camera, *instance.place(has_range), away[has_range])
    has_range[has_range] = place.burns(points[:, 0], points[:, 1])
    if not has_range.any():
        return annotation
    return replace(
        annotation,
        distance_m=float(np.median(away[has_range])),
        nearest_m=float(away[has_range].min()),
        ground_area_m2=survey.ground_area(
            place, rendered.camera, *instance.place(has_range), depth[has_range]
        ),
    )


def _paint(instances: list[_Instance], shape: tuple[int, ...]) -> Masks:
    """Write the numbers of instances into masks (h, w)."""
    smoke, fire, amodal = (np.zeros(shape, np.uint8) for _ in range(3))
    for number, each in enumerate(instances, 1):
        if each.category == truth.SMOKE:
            smoke[each.row, each.column] = number
        else:
            amodal[each.row, each.column] = number
            fire[each.place(each.visible)] = number
    return Masks(smoke, fire, amodal)


def _box(row: NDArray, column: NDArray) -> Box:
    """Return the box around pixels; zeros without pixels."""
    if not len(row):
        return 0.0, 0.0, 0.0, 0.0
    return float(column.min()), float(row.min()), float(column.max() + 1), float(row.max() + 1)


def _touches_edge(row: NDArray, column: NDArray, shape: tuple[int, ...]) -> bool:
    height, width = shape
    return bool(row.min() == 0 or column.min() == 0 or row.max() == height - 1 or column.max() == width - 1)


def _polylines(lines: list[Array]) -> list[Polyline]:
    """Round polylines to hundredths of a pixel."""
    return [[(round(float(u), 2), round(float(v), 2)) for u, v in line] for line in lines]
