"""Fields of the ground's grid for its material: images, as exact wherever the mesh has few points.

A mesh carries `grid`, the place in the images; a pixel is a point of the grid, and between them values are
bilinear.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...shot.shot import Shot
from ...shot.terrain import land_use, orthophoto
from ...shot.terrain.terrain import Ground
from ..forest import biomes, cover
from ..forest.stand import Stand

GRID = "grid"
_OUT = 40.0  # rows beyond the run, from which on an apron's cells are large: seven times the run's
_SOFT = 12.0  # rows beyond the run within which the apron's edges of forest become soft
_EDGE = 0.35  # kg/m2 of canopy fuel at which the shader has half forest and half open land
_LARGEST = 2048  # pixels of an image's side; of larger grids the means of some points
_FUEL, _FIRE, _FRONT, _COVER = (f"Firetwin Ground {name}" for name in ("Fuel", "Fire", "Front", "Cover"))
NAMES = {
    "canopy_fuel": (_FUEL, 0),
    "bare": (_FUEL, 1),
    "water": (_FUEL, 2),
    "burn_time": (_FIRE, 0),
    "burned": (_FIRE, 1),
    "stand": (_FIRE, 2),
    "speed": (_FRONT, 0),
    "residence": (_FRONT, 1),
    "ash": (_FRONT, 2),
    "shrub": (_COVER, 0),
    "hollow": (_COVER, 1),
    "mapped": (_COVER, 2),
}
"""In which image and channel each field is."""


def images(shot: Shot, grown: Stand | None) -> dict[str, bpy.types.Image]:
    """Make the images, by name: `canopy_fuel` (kg/m2), `bare` (part without fuel), `water` (1 on lakes).

    And `burn_time` (arrival in s, continued a little past the last perimeter), `burned` (1 inside it) and
    `stand` (part of the forest that is drawn tree by tree). And of the front its `speed` (m/s), how long
    flames stand over a spot (`residence`, s), and how pale what is left is (`ash`). Where the biome's open
    land asks for them also `shrub` (part of it under bushes), `hollow` (-1 on crests, 1 in hollows) and
    `mapped` (1 where a map says what there is, so that nothing is invented).
    """
    ground = shot.ground
    size = -(-max(ground.shape) // _LARGEST)
    known = {
        "canopy_fuel": _softened(ground),
        "bare": ground.bare,
        "water": ground.water,
        "burn_time": np.minimum(ground.burn_time, 1.0e7),
        "burned": ground.burned,
        "speed": shot.front.speed,
        "residence": shot.front.residence,
        "ash": shot.front.ash,
    }
    thin = {name: _thinned(field, size) for name, field in known.items()}
    thin["stand"] = _stand_cover(shot, grown, size)
    made = {}
    if biomes.choose(shot).biome.open_land is not None:
        thin |= {"shrub": _thinned(cover.shrubs(shot), size), "hollow": _thinned(cover.hollows(ground), size)}
        thin["mapped"] = _thinned(cover.mapped(shot), size)
    for image in dict.fromkeys(NAMES[name][0] for name in thin):
        made[image] = _image(
            image, [thin[name] for name, (holder, _) in NAMES.items() if holder == image and name in thin]
        )
    return made


def place(shape: tuple[int, int], row: NDArray, column: NDArray, margin: int = 0) -> NDArray[np.float32]:
    """`grid` of fractional rows and columns (n,) of a grid of this shape: (n, 3).

    The last of them is 0 within the run, and 1 where on an apron of `margin` rows its cells are large.
    """
    size = -(-max(shape) // _LARGEST)
    rows, columns = (size * -(-count // size) for count in shape)
    beyond = [_lines_beyond(at, count, margin) for at, count in zip((row, column), shape, strict=True)]
    out = np.clip(np.maximum(*beyond) / _OUT, 0.0, 1.0) if margin else 0.0 * row
    return np.stack([(column + 0.5) / columns, (row + 0.5) / rows, out], axis=-1).astype(np.float32)


def _softened(ground: Ground) -> NDArray[np.float64]:
    """Canopy fuel (ny, nx) kg/m2, on the apron with edges of forest as soft as its cells are large.

    So the shader's noise makes edges of all sizes of them, and not the steps of cells. Where half of what is
    near is wooded it is `_EDGE`, at which the shader has half forest: as much ground stays wooded.
    """
    canopy, margin = ground.fields.canopy_fuel, ground.fields.margin
    if not margin:
        return canopy
    wooded = (canopy > _EDGE).astype(np.float32)
    part = _blurred(wooded)
    beyond = np.maximum(*np.ix_(*(_beyond(count, margin) for count in canopy.shape)))
    edge = np.nonzero((part > 1.0e-4) & (part < 0.9999) & (beyond > 0.0))
    mean = _blurred(wooded * canopy.astype(np.float32))[edge] / part[edge]
    power = np.log2(np.maximum(mean / _EDGE, 1.05))
    soft = canopy.copy()
    soft[edge] += beyond[edge] * (mean * part[edge] ** power - canopy[edge])
    return soft


def _beyond(count: int, margin: int) -> NDArray[np.float32]:
    """How far (count,) lines are on the apron, 0 within the run and 1 from `_SOFT` lines beyond on."""
    at = np.arange(count, dtype=np.float32)
    return np.clip(_lines_beyond(at, count, margin) / np.float32(_SOFT), 0.0, 1.0)


def _lines_beyond(at: NDArray, count: int, margin: int) -> NDArray:
    """How many lines beyond the run places `at` are: of `count` lines `margin` on each side are apron."""
    return np.maximum(margin - at, at - (count - 1 - margin))


def _blurred(field: NDArray[np.float32]) -> NDArray[np.float32]:
    """Means with the neighbours, twice; beyond its ends a field goes on level."""
    for _ in range(2):
        for axis in (0, 1):
            padded = np.pad(field, [(1, 1) if k == axis else (0, 0) for k in (0, 1)], "edge")
            ahead, here, behind = (
                padded[tuple(slice(s, padded.shape[k] - 2 + s) if k == axis else slice(None) for k in (0, 1))]
                for s in (2, 1, 0)
            )
            field = (ahead + here + behind) * np.float32(1.0 / 3.0)
    return field


class Fields:
    """The fields as outputs of a material's nodes."""

    def __init__(self, tree: nodes.Tree, made: dict[str, bpy.types.Image]) -> None:
        at = tree.attribute(GRID, output="Vector")
        self.beyond = tree.separate(at)[2]
        self._none = at  # what no image has nobody asks for
        self._channels = {
            name: tree.separate(
                tree.output("ShaderNodeTexImage", {"Vector": at}, image=image, extension="EXTEND")
            )
            for name, image in made.items()
        }

    def __getitem__(self, name: str) -> nodes.Value:
        image, channel = NAMES[name]
        if image not in self._channels:
            return self._none
        return self._channels[image][channel]


def _thinned(field: NDArray[np.float64], size: int) -> NDArray[np.float64]:
    """Means of size x size points each; beyond its ends a field goes on level."""
    if size == 1:
        return field
    field = np.pad(field, [(0, -count % size) for count in field.shape], "edge")
    total = np.zeros([count // size for count in field.shape])
    for row, column in np.ndindex(size, size):
        total += field[row::size, column::size]
    return total / size**2


def _image(name: str, channels: list[NDArray[np.float64]]) -> bpy.types.Image:
    """An image of numbers, which is saved with the scene."""
    rows, columns = channels[0].shape
    image = bpy.data.images.new(name, columns, rows, alpha=False, float_buffer=True, is_data=True)
    pixels = np.ones((rows, columns, 4), np.float32)
    for index, channel in enumerate(channels):
        pixels[..., index] = channel
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return owned.mark(image)


def photos(shot: Shot) -> list[tuple[orthophoto.Picture, bpy.types.Image]]:
    """The user's orthophoto as images, which are saved with the scene; a finer one after a coarser."""
    return [
        (picture, _coloured(f"Firetwin Photo {number}", picture))
        for number, picture in enumerate(orthophoto.pictures(shot), 1)
    ]


def maps(shot: Shot) -> dict[str, list[tuple[orthophoto.Picture, bpy.types.Image]]]:
    """The user's land use as images, by `land_use.LAYERS`; a finer one after a coarser."""
    return {
        layer: [
            (picture, _coloured(f"Firetwin Land Use {layer.title()} {number}", picture))
            for number, picture in enumerate(drawn, 1)
        ]
        for layer, drawn in land_use.pictures(shot).items()
    }


def _coloured(name: str, picture: orthophoto.Picture) -> bpy.types.Image:
    """An image of colours, which is saved with the scene."""
    rows, columns = picture.pixels.shape[:2]
    image = bpy.data.images.new(name, columns, rows, alpha=True)
    image.alpha_mode = "CHANNEL_PACKED"
    image.pixels.foreach_set((picture.pixels / np.float32(255.0)).ravel())
    image.pack()
    return owned.mark(image)


def _stand_cover(shot: Shot, grown: Stand | None, size: int) -> NDArray[np.float64]:
    """Part of the forest's trees that stands there one by one, so that the ground need not draw it."""
    fields = shot.ground.fields
    latitude, longitude = (_thinned(axis[None], size)[0] for axis in (fields.latitude, fields.longitude))
    elevation = _thinned(fields.elevation, size)
    if grown is None or not shot.perspective_paths:
        return np.zeros(elevation.shape)
    place = shot.ground.frame.forward_grid(latitude, longitude, elevation)
    distance = shot.visibility.distance(place.reshape(-1, 3)).reshape(elevation.shape)
    cover = np.zeros(elevation.shape)
    close = distance < grown.radius
    cover[close] = grown.coverage(distance[close])
    return cover
