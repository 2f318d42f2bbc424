"""A film of two frames with random layers, as the pass comp writes them."""

import numpy as np
from firetwin_core import sensor

HEIGHT, WIDTH = 6, 8
COLOURS = ("", "solid.", "fire.", "smoke.", "light_sun.", "light_sky.", "light_fire.")


def write(folder):
    """Write the film; the path of its first frame, and its layers (h, w, channels) in half precision.

    Smoke goes from clear air to opaque.
    """
    random = np.random.default_rng(3)
    for frame in (2, 1):
        layers = {name: random.uniform(0.0, 2.0, (HEIGHT, WIDTH, 3)) for name in COLOURS}
        layers["solid."] = layers["light_sun."] + layers["light_sky."] + layers["light_fire."]
        layers[""] = layers["solid."] + layers["fire."] + layers["smoke."]
        opacity = np.append([0.0, 2.0e-7, 5.0e-4, 1.0], np.linspace(0.0, 1.0, HEIGHT * WIDTH - 4))
        layers["A"] = random.uniform(0.0, 1.0, (HEIGHT, WIDTH, 1))
        layers["smoke.A"] = opacity.reshape(HEIGHT, WIDTH, 1)
        names = [f"{name}{channel}" for name in COLOURS for channel in "RGB"] + ["A", "smoke.A"]
        pixels = np.concatenate([*layers.values()], axis=-1).astype(np.float32)
        path = folder / f"drone_comp_{frame:06d}.exr"
        sensor.write_image(path, pixels, {}, names, half=True, one_line=True)
    return path, {name: value.astype(np.float16).astype(float) for name, value in layers.items()}
