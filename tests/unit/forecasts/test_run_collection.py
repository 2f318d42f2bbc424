"""A member of an ensemble becomes a run."""

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.forecasts import run_collection
from firetwin.jobs import convert
from firetwin.run import readers
from small_ensemble import make

NEVER = np.inf


def test_a_member_becomes_a_run(tmp_path):
    y, x = np.mgrid[:12, :14]
    times = np.where(x < 10, 120.0 * x + 40.0 * y, NEVER)
    ensemble = make(tmp_path, [times, times * 2], horizon=3600.0)
    options = ["", "", "", 300.0, "", ""]
    convert.in_process([ensemble.path], tmp_path / "run", options, member="01")
    run = readers.open(tmp_path / "run")
    arrival = np.asarray(run.fuel_arrival_time())
    np.testing.assert_allclose(np.where(np.isnan(arrival), NEVER, arrival), ensemble.arrival(1))
    assert run.name == "test, member 01"
    assert run.heat_flux(2).max() > 0.0
    with pytest.raises(InputError, match='has no member "7"; choose one of 00, 01'):
        convert.in_process([ensemble.path], tmp_path / "other", options, member="7")
    with pytest.raises(InputError, match="is not an ensemble; make one"):
        convert.in_process([tmp_path], tmp_path / "other", options, member="01")
    assert run_collection.names(ensemble.path) == ["00", "01"]
