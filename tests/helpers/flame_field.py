"""Flames as a volume, from squares of flame lengths."""

import numpy as np
from firetwin.scene.fire import flame_volume
from firetwin_core.flames import FlameLight, FlameShape, FlameVolume


def flames(squares, time=3.0, wind=(0.0, 0.0), pixel=0.0, spindles=None, origin=(0.0, 0.0, 0.0), **changes):
    """Create flames of `squares` with the light of the product; `changes` are of `FlameLight`."""
    light = dict(
        visible=flame_volume.visible(1.0),
        extinction=flame_volume.EXTINCTION,
        soot=0.0,
        soot_light=(0.0, 0.0, 0.0),
        coolest=flame_volume.KELVIN[0],
        hottest=flame_volume.KELVIN[1],
        scales=flame_volume.SCALES,
        infrared=flame_volume.INFRARED,
        dim=0.0,
    )
    return FlameVolume(
        squares=squares,
        spindles=np.empty((0, 6)) if spindles is None else spindles,
        shape=FlameShape(wind=wind),
        light=FlameLight(**(light | changes)),
        pixel=pixel,
        fade=(1e6, 2e6),
        origin=origin,
        time=time,
    )
