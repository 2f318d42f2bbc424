"""The buoyant flow against plume theory; calm air is in `tests/benchmarks/flow_conservation.py`."""

import pytest
from firetwin.bench.flow import bent, unbalanced


def test_a_bent_plume_rises_as_briggs_says():
    plume = bent(100.0)
    assert plume.rise == pytest.approx(1.0, abs=0.15)
    assert unbalanced(plume.mass) < 1e-6
