"""Overlay of the model's mean near-surface air temperature in colour, as in the FIRETWIN paper.

The run's `temperature` is averaged over ten minutes, or over the frame step if that is longer. The gradient
black, purple, red, orange, yellow, white shows its excess over unburned air of equal elevation
(`air_temperature.warmth`). The paper does not define the lower limit of its gradient. Over the complete
field, cold ridges and warm valleys would take most of it and redden all unburned ground. Black is the excess
that one percent of unburned cells exceed. White is the warmest of the shot, so colours mean the same in every
frame. The colour of the visible ground, from depth, is added to the picture's pixels (0..1) and clamped at 1.
It shows the air temperature of the model, not the measurement of an infrared camera.
"""

from __future__ import annotations

from . import DerivedPass

PASS = DerivedPass(
    name="thermal_map",
    order=35,
    help="Visible picture with the model's mean near-surface air temperature added in colour",
    files=("png",),
    film=True,
    aspects=frozenset({"time", "camera"}),
    needs=("rgb", "depth"),
)
