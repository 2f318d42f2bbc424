"""Pictures of exports: a flame without colour in its transparent parts, and sRGB."""

import numpy as np
from firetwin.export import flame_picture
from firetwin.scene.terrain.ground_picture import encode


def test_a_flame_is_hot_inside_clear_outside_and_the_same_each_time():
    picture = flame_picture.draw()
    assert picture.dtype == np.uint8
    assert picture.shape[2] == 4
    colour, alpha = picture[..., :3], picture[..., 3]
    assert not alpha[0].any()
    assert not alpha[:, [0, -1]].any()
    assert colour[alpha == 0].max() < 16  # less than 0.5 % of the light
    shown = colour[alpha > 200]
    assert (shown[:, 0] > shown[:, 1]).all()
    assert (shown[:, 1] > shown[:, 2]).all()
    assert np.array_equal(picture, flame_picture.draw())


def test_linear_values_become_srgb():
    linear = np.array([0.0, 0.0031308, 0.18, 0.5, 1.0, 2.0])
    assert encode(linear).tolist() == [0, 10, 118, 188, 255, 255]
