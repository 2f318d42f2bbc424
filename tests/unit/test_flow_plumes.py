"""The buoyant flow against plume theory; more winds, calm air and other cells are in `firetwin bench`."""

import pytest
from firetwin.bench.flow_plumes import bent, unbalanced


def test_a_bent_plume_rises_as_briggs_says():
    plume = bent(100.0)
    assert plume.rise == pytest.approx(1.0, abs=0.15)
    assert unbalanced(plume.mass) < 1e-6
