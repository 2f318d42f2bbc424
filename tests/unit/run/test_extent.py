"""How large one of several fires is."""

import numpy as np
import pytest
from firetwin.run import extent


def test_the_largest_of_several_fires_counts():
    burned = np.zeros((400, 300), bool)
    assert extent.largest(burned, (10.0, 20.0)) == 0.0
    burned[10:13, 10:14] = True
    assert extent.largest(burned, (10.0, 20.0)) == pytest.approx(np.hypot(30.0, 80.0))
    burned[200:260, 100:180] = True
    assert extent.largest(burned, (10.0, 20.0)) == pytest.approx(np.hypot(600.0, 1600.0))
    burned[300:340, 250:300] = True
    assert extent.largest(burned, (10.0, 20.0)) == pytest.approx(np.hypot(600.0, 1600.0))


def test_a_spot_fire_beside_it_is_part_of_it():
    burned = np.zeros((1000, 1000), bool)
    burned[100:800, 100:800] = True
    burned[804:806, 400] = True  # four cells off, of blocks of eight
    assert extent.largest(burned, (1.0, 1.0)) == pytest.approx(np.hypot(706.0, 700.0))
