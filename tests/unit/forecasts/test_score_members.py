"""Scores of ensembles: round fires whose scores have closed forms, refusals, and the page."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from fires import axes, circle, round_fire
from firetwin.errors import Error
from firetwin.forecasts import member_scores as members
from firetwin.forecasts import probability
from firetwin.forecasts.ensemble import ensemble, write
from firetwin.forecasts.ensemble.manifest import Manifest, Member
from firetwin.run import observations
from firetwin.run.observations import Perimeter

pytest.importorskip("shapely")
pytest.importorskip("pyproj")
ISSUED = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)
SPEEDS = (0.3, 0.4, 0.5)  # m/s: after an hour 1,080, 1,440 and 1,800 m


@pytest.fixture(scope="module")
def forecast(tmp_path_factory):
    """Three round fires about one point, and one that failed."""
    latitude, longitude = axes()
    out = tmp_path_factory.mktemp("forecast") / "ensemble"

    def each():
        for speed in SPEEDS:
            time = round_fire(latitude, longitude, speed)
            yield Member(f"{speed}"), np.where(time <= 7200.0, time, np.inf)
        yield Member("failed"), "crashed"

    head = Manifest("Round", "made up", ISSUED, 7200.0, (), synthetic=True)
    write.write(out, head, latitude, longitude, each())
    return ensemble.open(out)


def seen(hours: float, radius: float) -> observations.Observations:
    perimeter = Perimeter(ISSUED + timedelta(hours=hours), ((circle(radius),),), "seen.geojson")
    return observations.Observations((perimeter,))


def test_round_fires_by_their_closed_forms(forecast):
    scores = members.score(forecast, seen(1.0, 1440.0))
    (row,) = scores["dates"]
    inner, middle, outer = (np.pi * (3600.0 * speed) ** 2 for speed in SPEEDS)
    assert scores["ensemble"]["members"] == 3
    assert scores["ensemble"]["of"] == 4
    assert row["observed_area"] == pytest.approx(middle, rel=2e-2)
    assert row["area"]["mean"] == pytest.approx((inner + middle + outer) / 3, rel=2e-2)
    assert row["area"]["spread"] == pytest.approx(np.std([inner, middle, outer], ddof=1), rel=5e-2)
    assert row["jaccard"]["best"] == ["0.4", pytest.approx(1.0, abs=0.01)]
    assert row["jaccard"]["worst"] == ["0.3", pytest.approx(inner / middle, abs=0.02)]
    # wrong by a third in two rings: 2 of 3 burned within, 1 of 3 without
    total = scores["domain"]["area"]
    wrong = ((middle - inner) + (outer - middle)) / 9 / total
    assert row["brier"]["score"] == pytest.approx(wrong, rel=5e-2)
    assert [bin["probability"] for bin in row["reliability"]] == pytest.approx([0, 1 / 3, 2 / 3, 1])
    assert [bin["frequency"] for bin in row["reliability"]] == pytest.approx([0, 0, 1, 1], abs=0.02)
    assert row["fss"][0]["fss"] < row["fss"][-1]["fss"]


def test_the_domain_is_a_disc_and_its_rules_are_written(tmp_path):
    """Cells within 2 km of a round fire of 720 m: a square around them has 1.25 times the area, or more."""
    latitude, longitude = axes(160)
    time = round_fire(latitude, longitude, 0.1)
    slow = 2.0 * time
    each = [(Member(name), np.where(t <= 7200.0, t, np.inf)) for name, t in (("0", time), ("1", slow))]
    write.write(tmp_path / "e", Manifest("Disc", "", ISSUED, 7200.0, ()), latitude, longitude, each)
    scores = members.score(ensemble.open(tmp_path / "e"), seen(1.0, 360.0))
    assert scores["domain"]["area"] == pytest.approx(np.pi * 2720.0**2, rel=0.02)
    ring = np.pi * (360.0**2 - 180.0**2)  # burned in 1 of 2
    assert scores["dates"][0]["brier"]["score"] == pytest.approx(ring / 4 / (np.pi * 2720.0**2), rel=0.03)
    assert scores["domain"]["rule"].startswith("cells with their centre within the margin of the centre of a")
    assert scores["fss"]["rule"] == "windows lie inside the grid of the ensemble"
    assert "FSS (window in cells; windows lie inside the grid of the ensemble)" in members.page(scores)


def test_arrival_is_censored_at_the_last_perimeter(forecast):
    """A fire that was seen nowhere near: what members burned by then is early by the rest of the time."""
    scores = members.score(forecast, seen(1.0, 60.0))
    assert scores["arrival"]["censored_at"] == 3600.0
    latitude, longitude = axes()
    times = np.stack([np.minimum(round_fire(latitude, longitude, speed), 3600.0) for speed in SPEEDS])
    everywhere = probability.crps(times.reshape(3, -1), np.full(latitude.size * longitude.size, 3600.0))
    mean = everywhere.sum() * 50.0**2 / scores["domain"]["area"]
    assert scores["arrival"]["crps"] == pytest.approx(mean, rel=0.05)


def test_only_a_forecast_with_a_perimeter_is_scored(forecast, tmp_path):
    with pytest.raises(Error, match="no perimeter is within its grid and its 2 h from 2014-09-17T04:45:00Z"):
        members.score(forecast, seen(3.0, 500.0))
    head = Manifest("Other", "", ISSUED, 7200.0, (), kind="ignitions")
    write.write(tmp_path / "e", head, *axes(), [(Member("1"), forecast.arrival(0))])
    with pytest.raises(Error, match="holds simulations of fires with different ignitions; scores of prob"):
        members.score(ensemble.open(tmp_path / "e"), seen(1.0, 500.0))


def test_the_page_has_counts(forecast):
    text = members.page(members.score(forecast, seen(1.0, 1440.0), "America/Los_Angeles"))
    assert "Round (synthetic)" in text
    assert "3 of 4 members, issued 16 Sep 2014 21:45 PDT, to 2 h" in text
    assert "burned in 2 of 3: observed " in text
    assert "1 to 2 members are smaller" in text or "1 members are smaller" in text or "2 members" in text
