"""The NumPy forest that the benchmark compares with grows the same trees, so it is a fair comparison."""

import numpy as np
import numpy_forest as rival
import pytest
from firetwin_core import forest
from firetwin_core.geo import LocalFrame

ORIGIN = (38.93, -120.55, 0.0)


def grid(rows=60, columns=50):
    rng = np.random.default_rng(10)
    fuel = np.where(rng.random((rows, columns)) < 0.7, rng.gamma(2, 0.6, (rows, columns)), 0).astype("f4")
    elevation = rng.uniform(300, 2900, (rows, columns)).astype("f4")
    return fuel, 38.69 + 0.000667 * np.arange(rows), -120.85 + 0.000855 * np.arange(columns), elevation


@pytest.mark.parametrize("kind", ["trees", "grass"])
def test_the_same_plants(kind):
    field = grid()
    ours = getattr(forest, kind)(*field, LocalFrame(*ORIGIN), seed=5)
    theirs = getattr(rival, kind)(*field, ORIGIN, seed=5)
    np.testing.assert_array_equal(ours.cell, theirs.cell)
    np.testing.assert_allclose(ours.position, theirs.position, rtol=0, atol=1e-6)
    for name in ("scale", "rotation") + (("size_class", "model") if kind == "trees" else ()):
        np.testing.assert_allclose(getattr(ours, name), getattr(theirs, name), rtol=1e-6, err_msg=name)
