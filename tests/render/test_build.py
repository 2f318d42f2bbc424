import numpy as np
from firetwin.scene import build


def test_the_ground_is_warm_the_edge_hot_and_the_sky_cold_in_the_thermal_layer(shot, stage, scene, shoot):
    build.build(shot, scene)
    scene.frame_set(2)
    kelvin = shoot(scene, "thermal")[..., 0]
    assert np.isclose(kelvin, 250.0, atol=0.1).any()
    ground = kelvin[kelvin > 280.0]  # below: pixels that the horizon crosses
    assert 285.0 < np.quantile(ground, 0.02) < 310.0
    assert ground.max() < 1600.0
    assert (ground > 500.0).any()
