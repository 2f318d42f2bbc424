"""Flames as a volume, from patches of straight fronts."""

import numpy as np
from firetwin.scene.fire import flame_volume
from firetwin.shot.fire import flame_library, flame_nodes
from firetwin.shot.fire.flame_nodes import SIDE
from firetwin_core.flames import FlameLight, FlameShape, FlameVolume


def front(length, half=(2.0, 4.0), spacing=None, **fields):
    """Patches of a straight front along x at y = 0 on level ground, which moves north.

    Parameters
    ----------
    length
        Of the flames, m; with `LENGTH` among the fields, a typical one.
    half
        Half of the extent along x and y, flame lengths.
    spacing
        Of the nodes, m; a quarter of the length or less if None.
    fields
        Other values by channel of `flame_nodes`: numbers or functions of x and y.
    """
    spacing = 2.0 ** np.floor(np.log2(length / 4.0)) if spacing is None else spacing
    span = SIDE * spacing
    axes = [np.arange(np.floor(-size * length / span), np.ceil(size * length / span)) * span for size in half]
    corners = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    steps = np.arange(SIDE + 1) * spacing
    x = np.broadcast_to(corners[:, 0, None, None] + steps, (len(corners), SIDE + 1, SIDE + 1))
    y = np.broadcast_to(corners[:, 1, None, None] + steps[:, None], x.shape)
    nodes = np.zeros((*x.shape, 8), np.float32)
    given = {"LENGTH": length, "DISTANCE": lambda x, y: -y, "SHARE": 1.0, "NORTH": 1.0} | fields
    for name, value in given.items():
        nodes[..., getattr(flame_nodes, name)] = value(x, y) if callable(value) else value
    return nodes, corners, np.full(len(corners), spacing)


def flames(patches, time=3.0, wind=(0.0, 0.0), pixel=0.0, spindles=None, origin=(0.0, 0.0, 0.0), **changes):
    """Create flames on patches with the library and light of the product; `changes` are of `FlameLight`."""
    light = dict(
        visible=flame_volume.visible(1.0),
        extinction=flame_volume.extinctions(),
        soot=0.0,
        soot_light=(0.0, 0.0, 0.0),
        coolest=flame_volume.KELVIN[0],
        hottest=flame_volume.KELVIN[1],
        dim=0.0,
    )
    fade = changes.pop("fade", (1e6, 2e6))
    return FlameVolume(
        patches=patches,
        spindles=np.empty((0, 6)) if spindles is None else spindles,
        library=flame_library.library(),
        shape=FlameShape(wind=wind),
        light=FlameLight(**(light | changes)),
        pixel=pixel,
        fade=fade,
        origin=origin,
        time=time,
    )
