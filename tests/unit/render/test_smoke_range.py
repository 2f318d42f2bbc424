"""Distance of smoke at half of its opacity, against walls and fogs whose opacity has a closed form."""

import numpy as np
import pytest
from firetwin.render import smoke_range

FROM, TO, AWAY = 400.0, 500.0, 2000.0  # m


def measure(clear, march):
    height, width = clear.shape
    directions = np.broadcast_to([0.0, 1.0, 0.0], (height, width, 3))
    return smoke_range.measure(np.zeros(3), directions, np.full(clear.shape, AWAY, np.float32), clear, march)


@pytest.mark.parametrize("depth", [0.02, 0.5, 5.0])
def test_fog_between_two_distances_is_where_half_of_its_opacity_is(depth):
    def march(origins, directions, at):
        return np.exp(-depth * np.clip((at - FROM) / (TO - FROM), 0.0, 1.0))

    clear = np.full((5, 7), np.exp(-depth), np.float32)  # odd sides, as of one eye of a stereo picture
    half = 0.5 * (1.0 + np.exp(-depth))
    true = FROM - np.log(half) / depth * (TO - FROM)
    assert measure(clear, march) == pytest.approx(true, rel=0.03)


def test_pixels_without_smoke_have_no_distance_and_are_not_marched():
    clear = np.ones((4, 6), np.float32)
    clear[:, 4:] = 0.5
    clear[0, 0] = 0.995

    def march(origins, directions, at):
        assert len(directions) == 2
        return np.where(at < FROM, 1.0, 0.5)

    found = measure(clear, march)
    assert np.isinf(found[:, :4]).all()
    assert found[:, 4:] == pytest.approx(FROM, rel=0.1)
