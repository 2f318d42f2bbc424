"""Terrain fields as textures of the ground's material, in full resolution even if the mesh is coarse.

The mesh attribute `grid` is its texture coordinates. A pixel is a point of the terrain grid; values are
bilinear between pixels.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...shot.shot import Shot
from ...shot.surface import land_use, orthophoto
from ...shot.terrain.terrain import Terrain
from ..forest import biomes, cover
from ..forest.stand import Stand

GRID = "grid"
_OUT = 40.0  # rows beyond the run at which the apron's cells reach their full size: seven run cells
_SOFT = 12.0  # rows beyond the run over which the apron's forest edges are softened
_EDGE = 0.35  # kg/m2 of canopy fuel at which the shader has half forest and half open land
_LARGEST = 2048  # pixels along an image's side; larger grids are averaged to this size
_FUEL, _FIRE, _FRONT, _COVER, _SCAR = (
    f"Firetwin Ground {name}" for name in ("Fuel", "Fire", "Front", "Cover", "Scar")
)
_HALF = 2048.0  # up to which half precision is finer than 1
_FAINTEST = 30.0  # kW/m, least intensity of a fire that spreads (assumed)
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
    "heat": (_SCAR, 0),
    "load": (_SCAR, 1),
    "shrub": (_COVER, 0),
    "hollow": (_COVER, 1),
    "mapped": (_COVER, 2),
}
"""Image and channel of each field."""


def create_images(shot: Shot, grown: Stand | None) -> dict[str, bpy.types.Image]:
    """Create images, by name: `canopy_fuel` (kg/m2), `bare` (fraction without fuel), `water` (1 on lakes).

    Other fields are `burn_time` (arrival time in s, extrapolated a little past the last perimeter), `burned`
    (1 inside it), `stand` (fraction of the forest that is instanced trees), the front's rate of spread
    `speed` (m/s), the `residence` time of flames at a point (s), and the brightness of the residue (`ash`).
    The scar has `heat`, the natural logarithm of the fireline intensity in kW/m, and `load`, the surface fuel
    that burned (kg/m2).
    If the biome's open land uses them, `shrub` (shrub cover), `hollow` (-1 on crests, 1 in hollows) and
    `mapped` (1 where a map has data, so that nothing is procedural) are added.
    """
    ground = shot.ground
    size = block_size(ground.shape)
    fields = {
        "canopy_fuel": _soften_edges(ground),
        "bare": ground.bare,
        "water": ground.water,
        "burn_time": np.minimum(ground.burn_time, 1.0e7),
        "burned": ground.burned,
        "speed": shot.front.speed,
        "residence": shot.front.residence,
        "ash": shot.front.ash,
        "heat": np.log(np.maximum(shot.front.intensity, _FAINTEST)),
        "load": ground.fields.surface_fuel,
    }
    thin = {name: downsample(field, size) for name, field in fields.items()}
    thin["stand"] = _stand_cover(shot, grown, size)
    images = {}
    if biomes.choose(shot).biome.open_land is not None:
        thin |= {
            "shrub": downsample(cover.shrubs(shot), size),
            "hollow": downsample(cover.hollows(ground), size),
        }
        thin["mapped"] = downsample(cover.mapped(shot), size)
    for image in dict.fromkeys(NAMES[name][0] for name in thin):
        images[image] = float_image(
            image, [thin[name] for name, (holder, _) in NAMES.items() if holder == image and name in thin]
        )
    return images


def texture_coordinates(
    shape: tuple[int, int], row: NDArray, column: NDArray, margin: int = 0
) -> NDArray[np.float32]:
    """Return texture coordinates `grid` (n, 3) of fractional rows and columns (n,) of a grid of this shape.

    The third coordinate is 0 within the run, and 1 on an apron of `margin` rows where its cells have full
    size.
    """
    size = block_size(shape)
    rows, columns = (size * -(-count // size) for count in shape)
    beyond = [_lines_to_run(at, count, margin) for at, count in zip((row, column), shape, strict=True)]
    out = np.clip(np.maximum(*beyond) / _OUT, 0.0, 1.0) if margin else 0.0 * row
    return np.stack([(column + 0.5) / columns, (row + 0.5) / rows, out], axis=-1).astype(np.float32)


def _soften_edges(ground: Terrain) -> NDArray[np.float64]:
    """Return canopy fuel (ny, nx) kg/m2 with the apron's forest edges blurred in proportion to its cell size.

    The shader's noise turns soft edges into edges of all sizes, without the steps of cells. If half of a
    neighbourhood is wooded, the value is `_EDGE`, at which the shader shows half forest: the wooded area
    stays the same.
    """
    canopy, margin = ground.fields.canopy_fuel, ground.fields.margin
    if not margin:
        return canopy
    wooded = (canopy > _EDGE).astype(np.float32)
    part = _blur(wooded)
    beyond = np.maximum(*np.ix_(*(_apron_position(count, margin) for count in canopy.shape)))
    edge = np.nonzero((part > 1.0e-4) & (part < 0.9999) & (beyond > 0.0))
    mean = _blur(wooded * canopy.astype(np.float32))[edge] / part[edge]
    power = np.log2(np.maximum(mean / _EDGE, 1.05))
    soft = canopy.copy()
    soft[edge] += beyond[edge] * (mean * part[edge] ** power - canopy[edge])
    return soft


def _apron_position(count: int, margin: int) -> NDArray[np.float32]:
    """Return the position of lines (count,) on the apron: 0 in the run, 1 from `_SOFT` lines beyond it."""
    at = np.arange(count, dtype=np.float32)
    return np.clip(_lines_to_run(at, count, margin) / np.float32(_SOFT), 0.0, 1.0)


def _lines_to_run(at: NDArray, count: int, margin: int) -> NDArray:
    """Return lines from positions `at` to the run; `margin` of `count` lines on each side are apron."""
    return np.maximum(margin - at, at - (count - 1 - margin))


def _blur(field: NDArray[np.float32]) -> NDArray[np.float32]:
    """Average with the neighbours, twice; edge values extend the field."""
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
    """Terrain fields as outputs of a material's nodes."""

    def __init__(self, tree: nodes.Tree, images: dict[str, bpy.types.Image]) -> None:
        at = tree.attribute(GRID, output="Vector")
        self.beyond = tree.separate(at)[2]
        self._none = at  # fields without an image are not used
        self._channels = {
            name: tree.separate(
                tree.output("ShaderNodeTexImage", {"Vector": at}, image=image, extension="EXTEND")
            )
            for name, image in images.items()
        }

    def __getitem__(self, name: str) -> nodes.Value:
        image, channel = NAMES[name]
        if image not in self._channels:
            return self._none
        return self._channels[image][channel]


def block_size(shape: tuple[int, int]) -> int:
    """Return the side of the blocks of points that a pixel of an image averages."""
    return -(-max(shape) // _LARGEST)


def downsample(field: NDArray[np.float64], size: int) -> NDArray[np.float64]:
    """Average blocks of size x size points; edge values extend the field."""
    if size == 1:
        return field
    field = np.pad(field, [(0, -count % size) for count in field.shape], "edge")
    total = np.zeros([count // size for count in field.shape])
    for row, column in np.ndindex(size, size):
        total += field[row::size, column::size]
    return total / size**2


def float_image(name: str, channels: list[NDArray[np.float64]]) -> bpy.types.Image:
    """Create a float image without colour management, packed into the .blend file.

    EEVEE reads float images in half precision by default, which is too coarse for times.
    """
    rows, columns = channels[0].shape
    image = bpy.data.images.new(name, columns, rows, alpha=False, float_buffer=True, is_data=True)
    pixels = np.ones((rows, columns, 4), np.float32)
    for index, channel in enumerate(channels):
        pixels[..., index] = channel
    image.use_half_precision = float(np.abs(pixels).max()) < _HALF
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return owned.mark(image)


def orthophoto_images(shot: Shot) -> list[tuple[orthophoto.OrthophotoImage, bpy.types.Image]]:
    """Create images of the user's orthophotos, packed into the .blend file; finer ones after coarser ones."""
    return [
        (picture, byte_image(f"Firetwin Photo {number}", picture.pixels / np.float32(255.0)))
        for number, picture in enumerate(orthophoto.pictures(shot), 1)
    ]


def land_use_images(shot: Shot) -> dict[str, list[tuple[orthophoto.OrthophotoImage, bpy.types.Image]]]:
    """Create images of the user's land use, by `land_kinds.LAYERS`; finer ones after coarser ones."""
    return {
        layer: [
            (
                picture,
                byte_image(f"Firetwin Land Use {layer.title()} {number}", picture.pixels / np.float32(255.0)),
            )
            for number, picture in enumerate(drawn, 1)
        ]
        for layer, drawn in land_use.pictures(shot).items()
    }


def byte_image(name: str, pixels: NDArray[np.float32], *, is_data: bool = False) -> bpy.types.Image:
    """Create an image in bytes from values (rows, columns, 4) of 0..1, packed into the .blend file."""
    rows, columns = pixels.shape[:2]
    image = bpy.data.images.new(name, columns, rows, alpha=True, is_data=is_data)
    image.alpha_mode = "CHANNEL_PACKED"
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return owned.mark(image)


def _stand_cover(shot: Shot, grown: Stand | None, size: int) -> NDArray[np.float64]:
    """Return the fraction of forest cover that is instanced trees, which the ground's material omits."""
    fields = shot.ground.fields
    latitude, longitude = (downsample(axis[None], size)[0] for axis in (fields.latitude, fields.longitude))
    elevation = downsample(fields.elevation, size)
    if grown is None or not shot.perspective_paths:
        return np.zeros(elevation.shape)
    place = shot.ground.frame.forward_grid(latitude, longitude, elevation)
    distance = shot.visibility.distance(place.reshape(-1, 3)).reshape(elevation.shape)
    cover = np.zeros(elevation.shape)
    close = distance < grown.radius
    cover[close] = grown.coverage(distance[close])
    return cover
