"""Air in the built scene of a sample: fog and dust, and the sunlight that reaches the ground through them."""

from __future__ import annotations

import numpy as np

from ..blender.owned import Stage
from ..scene import haze
from . import air
from .draw import Draw

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def apply(stage: Stage, drawn: Draw) -> None:
    """Change the light of a scene, as `scene.light.build` made it, to the look of a sample's air."""
    look = air.look(drawn)
    for obj in stage.objects_of("Light"):
        if obj.type == "LIGHT":
            obj.data.energy *= look.sun
            obj.data.angle = max(obj.data.angle, float(np.radians(look.soft)))
    for node in haze.colours(stage):
        colour = np.array(node.default_value[:3])
        grey = look.grey * float(colour @ _LUMINANCE)
        node.default_value = (*(np.array(look.tint) * (colour * (1.0 - look.grey) + grey)), 1.0)
