"""The buoyant flow against plume theory; more winds, calm air and finer grids are in benchmarks/plumes.py."""

import pytest
from plumes import bent


def test_a_bent_plume_rises_as_briggs_says():
    ratio, mass = bent(100.0)
    assert ratio == pytest.approx(1.0, abs=0.15)
    assert mass["airborne"] + mass["left"] == pytest.approx(mass["emitted"], rel=1e-6)
