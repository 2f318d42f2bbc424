"""Night sky of the world's shader: airglow, twilight, Milky Way, stars and moon.

Stars turn with sidereal time. Their brightness relative to the dark sky is physical; the exposure decides
which are visible. Only camera rays see stars and moon: the sun's lamp is their light at night.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...ellipsoid import MEAN_RADIUS
from ...run import sun, times
from ...shot.light import stars
from ...shot.light.sky import NIGHT_SKY, State
from ...shot.shot import Shot
from .keyframes import add_keyframes

_CHART = "Firetwin Stars"
_POINT = 0.4  # pixels, standard deviation of a star's image
_SHARPEST, _WIDEST = 1.0e-4, 1.5e-3  # rad, bounds of that; a wider image would leave the star's texel
_FLUX = (
    10.0 ** (0.4 * stars.DARK_SKY) * np.radians(1.0 / 3600.0) ** 2
)  # sr of dark sky in a star of magnitude 0
_EXTINCTION = (0.10, 0.15, 0.23)  # optical depths of the zenith in red, green and blue (assumed)
# stars of B - V -0.4, 0.5 and 2.0, for a camera balanced for a colour temperature of about 4500 K (by eye)
_BLUE, _WHITE, _RED = (0.55, 0.74, 1.0), (0.82, 0.92, 1.0), (1.0, 0.84, 0.66)
_EXPOSED = 0.12  # factor on stars and Milky Way: the exposure is for flames, which shows few stars (by eye)
_BAND = np.radians(9.0)  # scale height of the Milky Way
_BAND_LIGHT, _BULGE = 0.9, 1.2  # radiance over the dark sky's, of the Milky Way and of its centre (by eye)
_RADIUS = np.radians(0.259)  # of the moon
_MOON_LIGHT = 4.0  # radiance of the moon's disc: white in every exposure, real is 1,000 times as bright
_EARTHSHINE = 0.0006  # of that, on the dark side (by eye)
_AUREOLE = 1.2, np.radians(5.0)  # radiance next to a full moon over the moonlit sky's, and its scale (by eye)
_TWILIGHT = ((1.25, 0.62, 0.22), (0.95, 0.62, 0.40), (0.50, 0.58, 0.75), (0.28, 0.45, 0.80))
_ARCH = 0.13  # sine of elevation over which twilight falls to 1/e (by eye)


def radiance(
    tree: nodes.Tree, shot: Shot, frames: NDArray[np.float64], states: list[State]
) -> tuple[nodes.Value, nodes.Value]:
    """Return the radiance of the night sky along a ray of the world's shader, with keyframes.

    Returns
    -------
    The night sky from the ground, and stars and moon from space.
    """
    ray = tree.output("ShaderNodeTexCoord", name="Generated")
    up = tree.separate(ray)[2]
    above = tree.math("MAXIMUM", up, 0.03)
    colour = _animated_vector(tree, "Night Sky", frames, np.array([s.night for s in states]))
    light = tree.vector("SCALE", colour, _airglow(tree, up))
    if any(state.twilight > 0.0 for state in states):
        light = tree.vector("ADD", light, _twilight(tree, ray, above, frames, states))
    through = tree.combine(*((-depth / above).exp() for depth in _EXTINCTION))
    seen = tree.output("ShaderNodeLightPath", name="Is Camera Ray") * (up > 0.0)
    far = _stars(tree, shot, ray, frames, states)
    times_ = [shot.frames.time(frame) for frame in frames]
    toward = np.array([sun.toward_moon(shot.run, time) for time in times_])
    if (toward[:, 2] > -0.01).any():
        far = tree.vector("ADD", far, _moon(tree, ray, toward, frames, states))
    dimmed = tree.vector("MULTIPLY", far, through)
    return tree.vector("ADD", light, tree.vector("SCALE", dimmed, seen)), far


def _airglow(tree: nodes.Tree, up: nodes.Value) -> nodes.Value:
    """Return airglow relative to its mean, for rays of slope sine `up`: a layer 100 km high.

    Van Rhijn (1921, "On the brightness of the sky at night", Publ. Astr. Lab. Groningen 31).
    """
    across = (1.0 - up * up) * (MEAN_RADIUS / (MEAN_RADIUS + 100_000.0)) ** 2
    return tree.math("POWER", 1.0 - across, -0.5) * 0.3


def _twilight(
    tree: nodes.Tree,
    ray: nodes.Value,
    above: nodes.Value,
    frames: NDArray[np.float64],
    states: list[State],
) -> nodes.Value:
    """Return the arch of twilight over the sun: orange at the horizon, blue above."""
    bearing = np.array([state.sky[1] for state in states])
    flat = np.stack([np.sin(bearing), np.cos(bearing), 0.0 * bearing], axis=-1)
    strength = _animated_vector(tree, "Twilight", frames, flat * [[s.twilight] for s in states])
    amount = tree.vector("LENGTH", strength, name="Value")
    side = tree.vector("DOT_PRODUCT", strength, ray, name="Value") * 0.5 + amount * 0.5
    fall = (above * (-1.0 / _ARCH)).exp()
    return tree.vector("SCALE", tree.colours(above * (1.0 / 0.45), _TWILIGHT), side * fall)


def _stars(
    tree: nodes.Tree, shot: Shot, ray: nodes.Value, frames: NDArray[np.float64], states: list[State]
) -> nodes.Value:
    """Return the radiance of the stars and of the Milky Way."""
    latitude, longitude = sun.middle(shot.run)
    angle = [stars.sidereal_angle(times.utc(shot.run, shot.frames.time(f)), longitude) for f in frames]
    turn = _animated_number(
        tree, "Sidereal Angle", frames, np.array(angle) - 2.0 * np.pi * (angle[0] // (2.0 * np.pi))
    )
    turned = tree.output(
        "ShaderNodeVectorRotate",
        {"Vector": ray, "Axis": tuple(stars.pole(latitude)), "Angle": turn},
        rotation_type="AXIS_ANGLE",
    )
    x, y, z = (
        tree.vector("DOT_PRODUCT", turned, tuple(axis), name="Value")
        for axis in stars.galactic_axes(latitude)
    )
    across = tree.math("ARCTAN2", y, x) * (0.5 / np.pi)
    across = tree.math("FRACT", across + 1.0)
    height = tree.math("ARCSINE", z)
    shown = _animated_number(tree, "Stars", frames, np.array([s.stars for s in states]))
    points = _points(tree, shot, across, height, tree.math("SQRT", tree.math("MAXIMUM", 1.0 - z * z, 0.0)))
    band = _milky_way(tree, tree.combine(x, y, z), across, height)
    sky = tree.vector("ADD", points, band)
    return tree.vector("SCALE", sky, shown * (_EXPOSED * float(NIGHT_SKY.mean())))


def _points(
    tree: nodes.Tree, shot: Shot, across: nodes.Value, height: nodes.Value, flat: nodes.Value
) -> nodes.Value:
    """Return the stars' radiance over the dark sky's, at a place of the chart."""
    up = height * (1.0 / np.pi) + 0.5
    chart = tree.node(
        "ShaderNodeTexImage",
        {"Vector": tree.combine(across, up, 0.0)},
        image=_chart_image(shot.settings.seed),
        interpolation="Closest",
        extension="EXTEND",
    )
    right, over, flux = tree.separate(tree.pick(chart, "Color"))
    east = (tree.math("FRACT", across * float(stars.COLUMNS)) - right) * flat * (2.0 * np.pi / stars.COLUMNS)
    north = (tree.math("FRACT", up * float(stars.ROWS)) - over) * (np.pi / stars.ROWS)
    pixel = shot.pixel[0]
    wide = float(np.clip(_POINT * pixel if np.isfinite(pixel) else _WIDEST, _SHARPEST, _WIDEST))
    spread = ((east * east + north * north) * (-0.5 / wide**2)).exp()
    colour = tree.colours(tree.pick(chart, "Alpha"), (_BLUE, _WHITE, _RED))
    return tree.vector("SCALE", colour, spread * flux * (_FLUX / (2.0 * np.pi * wide**2)))


def _milky_way(tree: nodes.Tree, place: nodes.Value, across: nodes.Value, height: nodes.Value) -> nodes.Value:
    """Return the Milky Way's radiance over the dark sky's: a band with clouds, dark lanes and a bulge."""
    away = tree.math("ABSOLUTE", across - 0.5)  # 0.5 at the centre, 0 opposite
    central = away.smoothstep(0.25, 0.5)
    clouds = tree.noise(place, 0.35, 5.0, 0.6).smoothstep(0.25, 0.75)
    lanes = tree.noise(place, 0.16, 4.0, 0.65).smoothstep(0.50, 0.66) * away.smoothstep(0.15, 0.35)
    depth = tree.math("ABSOLUTE", height) * (1.0 / _BAND)
    dark = 1.0 - lanes * (-(depth * depth) * 6.0).exp() * 0.85
    band = (-depth).exp() * (central * _BULGE + _BAND_LIGHT) * (clouds * 0.8 + 0.2) * dark
    return tree.vector("SCALE", (1.0, 0.95, 0.92), band)


def _moon(
    tree: nodes.Tree,
    ray: nodes.Value,
    toward: NDArray[np.float64],
    frames: NDArray[np.float64],
    states: list[State],
) -> nodes.Value:
    """Return the radiance of the moon's disc, lit from where the sun is, and of the aureole around it."""
    moon = _animated_vector(tree, "Toward Moon", frames, toward)
    suns = np.array([sun.direction(*np.degrees(state.sky[::-1])) for state in states])
    lamp = _animated_vector(tree, "Toward Hidden Sun", frames, suns)
    along = tree.vector("DOT_PRODUCT", ray, moon, name="Value")
    off = tree.vector("SCALE", tree.vector("SUBTRACT", ray, tree.vector("SCALE", moon, along)), 1.0 / _RADIUS)
    radius = tree.vector("LENGTH", off, name="Value")
    depth = tree.math("SQRT", tree.math("MAXIMUM", 1.0 - radius * radius, 0.0))
    normal = tree.vector("SUBTRACT", off, tree.vector("SCALE", moon, depth))
    lit = tree.vector("DOT_PRODUCT", normal, lamp, name="Value").smoothstep(0.0, 0.25)
    ahead = along > 0.0
    disc = radius.smoothstep(1.02, 0.98) * ahead * (lit * (1.0 - _EARTHSHINE) + _EARTHSHINE) * _MOON_LIGHT
    rise, scale = _AUREOLE
    around = (radius * (-_RADIUS / scale)).exp() * ahead
    moonlit = np.array([np.maximum(s.night - NIGHT_SKY, 0.0) * rise for s in states])
    aureole = tree.vector("SCALE", _animated_vector(tree, "Aureole", frames, moonlit), around)
    return tree.vector("ADD", tree.vector("SCALE", (1.0, 0.97, 0.92), disc), aureole)


def _animated_vector(
    tree: nodes.Tree, name: str, frames: NDArray[np.float64], values: NDArray[np.float64]
) -> nodes.Value:
    """Add a node with keyframes of a vector (n, 3)."""
    node = tree.node("ShaderNodeCombineXYZ", name=name)
    for axis in range(3):
        path = f'nodes["{node.name}"].inputs[{axis}].default_value'
        add_keyframes(tree.node_tree, path, frames, values[:, axis])
    return tree.pick(node)


def _animated_number(
    tree: nodes.Tree, name: str, frames: NDArray[np.float64], values: NDArray[np.float64]
) -> nodes.Value:
    """Add a node with keyframes of a number (n,)."""
    node = tree.node("ShaderNodeValue", name=name)
    add_keyframes(tree.node_tree, f'nodes["{node.name}"].outputs[0].default_value', frames, values)
    return tree.pick(node)


def _chart_image(seed: int) -> bpy.types.Image:
    """Create the chart of stars as a float image, packed into the .blend file, or repaint it."""
    image = bpy.data.images.get(_CHART)
    if image is None or not owned.is_ours(image):
        image = owned.mark(
            bpy.data.images.new(
                _CHART, stars.COLUMNS, stars.ROWS, alpha=True, float_buffer=True, is_data=True
            )
        )
        image.alpha_mode = "CHANNEL_PACKED"
    image.pixels.foreach_set(stars.chart(seed).ravel())
    image.pack()
    return image
