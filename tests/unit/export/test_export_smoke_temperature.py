"""Temperature of a flow on cubic voxels: cells that follow the terrain, resampled at heights."""

import numpy as np
from firetwin.export.smoke_temperature import resample

MIDDLES = np.array([20.0, 70.0, 150.0, 300.0])
TOP = 3000.0


def test_a_field_that_is_linear_in_height_keeps_its_values_over_hills():
    ground = np.array([[0.0, 300.0], [-100.0, 600.0]])
    mean = float(ground.mean())
    thickness = 1.0 - (ground - mean) / TOP
    centres = ground + MIDDLES[:, None, None] * thickness  # as Domain.heights, below its top
    height = np.arange(-150.0, 1000.0, 25.0)
    resampled = resample(0.1 * centres + 50.0, MIDDLES, ground, thickness, height)
    inside = (height[:, None, None] >= centres[0]) & (height[:, None, None] <= centres[-1])
    expected = np.broadcast_to(0.1 * height[:, None, None] + 50.0, resampled.shape)
    assert inside.sum() > 20
    np.testing.assert_allclose(resampled[inside], expected[inside], rtol=1e-5)
    below, above = height[:, None, None] < ground, height[:, None, None] > centres[-1] + 1.0e-6
    assert not resampled[below].any()
    assert not resampled[above].any()
