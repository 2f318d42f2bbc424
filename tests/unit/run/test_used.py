"""Observations that a score uses, and messages if it uses none."""

import re
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from fires import axes, circle, degrees, geojson, round_fire, write_run
from firetwin import cli
from firetwin.run import observations, readers
from firetwin.run import score as scores
from firetwin.run.score import page, plots, report, used
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("shapely")
START = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)


@pytest.fixture
def fire(make_run):
    """A run of 6 km that begins at 04:45 UTC, with so many times, and grows as a circle for an hour."""

    def make(count=5, interval=900.0, arrival=True):
        time = round_fire(*axes(60, 100.0)) if arrival else None
        return write_run(make_run, time, 60, 100.0, count=count, interval=interval)

    return make


def detections(path, *seen):
    """A FIRMS table of (minutes after the start, metres east)."""
    rows = ["latitude,longitude,acq_date,acq_time,scan,track,confidence,instrument"]
    for minutes, east in seen:
        (longitude, latitude), when = degrees([east], [0.0])[0], START + timedelta(minutes=minutes)
        rows.append(f"{latitude},{longitude},{when:%Y-%m-%d},{when:%H%M},0.375,0.375,n,VIIRS")
    path.write_text("\n".join(rows))
    return path


class _Times:
    times = np.array([0.0, 100.0])


@given(st.lists(st.tuples(st.floats(-1e3, 1e3), st.booleans()), max_size=30))
def test_every_observation_has_one_fate(seen):
    moments, here = [time for time, _ in seen], [inside for _, inside in seen]
    found = used.row("x", "detections", used.fates(_Times, moments, here))
    assert sum(found[fate] for fate in used.FATES) == len(seen)
    assert found["used"] == sum(inside and 0.0 <= time <= 100.0 for time, inside in seen)
    assert found["before"] == sum(inside and time < 0.0 for time, inside in seen)
    assert found["outside"] == len(seen) - sum(here)


def test_each_file_says_what_became_of_its_observations(fire, tmp_path):
    csv = detections(
        tmp_path / "viirs.csv", (-5, 0), (30, 0), (30, 500), (61, 0), (99, 0), (30, 9e4), (200, 9e4)
    )
    shape = geojson(
        tmp_path / "king.geojson",
        ([circle(900.0)], {"time": "2014-09-17T05:05:00Z"}),
        ([circle(900.0)], {"time": "2013-09-17T05:05:00Z"}),
        ([circle(900.0, 9e4)], {"time": "2014-09-17T05:06:00Z"}),
    )
    run, seen = readers.open(fire()), observations.read([csv, shape])
    scored = scores.score(run, seen)
    assert scored["uses"] == [
        {"source": "king.geojson", "kind": "perimeters", "used": 1, "before": 1, "after": 0, "outside": 1},
        {"source": "viirs.csv", "kind": "detections", "used": 2, "before": 1, "after": 2, "outside": 2},
    ]
    assert len(scored["dates"]) == 1
    assert sum(row["count"] for row in scored["detections"]) == 2
    told = [line.split() for line in page.page(scored).splitlines()]
    assert ["viirs.csv,", "detections", "2", "1", "2", "2"] in told
    cells = "".join(f"<td>{count}</td>" for count in (2, 1, 2, 2))
    assert f'<td>viirs.csv</td><td class="text">detections</td>{cells}' in report.html(run, scored, seen)


@pytest.mark.parametrize(
    ("seen", "reason"),
    [
        ([(61, 0), (99, 0)], "2 lie after the run's last time"),
        (
            [(-9, 0), (99, 0), (9, 9e4)],
            "1 lie before the run's first time, 1 lie after its last, 1 lie outside",
        ),
        ([], "all are left out"),
    ],
)
def test_nothing_usable_is_said_and_fails(fire, tmp_path, capsys, seen, reason):
    csv, out = detections(tmp_path / "viirs.csv", *seen), tmp_path / "score.html"
    assert cli.main(["score", str(fire()), "--against", str(csv), "--report", str(out)]) == 1
    told = capsys.readouterr()
    whole = f"o observation of viirs.csv can be compared with the run: {reason}"
    assert whole in told.err
    assert whole in told.out
    assert whole in out.read_text().replace("&#x27;", "'")


def test_one_that_is_usable_is_enough(fire, tmp_path, capsys):
    csv = detections(tmp_path / "viirs.csv", (61, 0), (60, 0))
    assert cli.main(["score", str(fire()), "--against", str(csv)]) == 0
    assert "no observation" not in capsys.readouterr().out


@pytest.mark.parametrize("count", [1, 2, 5, 300])
def test_growth_is_drawn_at_the_runs_own_times(fire, count):
    """No moment between the run's: a coarse run's estimated front has steps there that no model gave."""
    run = readers.open(fire(count, 3600.0 / max(count - 1, 1)))
    times = plots.own_times(run)
    assert np.isin(times, run.times).all()
    assert {times[0], times[-1]} == {run.times[0], run.times[-1]}
    assert len(times) == min(count, 200)
    svg = plots.growth(run, scores.score(run, observations.Observations()))
    curve = re.search(rf'<path d="([^"]*)"[^>]*stroke: {plots.RUN}; stroke-width: 2', svg)
    assert len(re.findall("[ML]", curve[1])) <= len(times)
    marks = len(re.findall(rf"<use [^>]*fill: {plots.RUN}", svg))
    assert marks == (count + 1 if count <= 5 else 0)  # one more in the legend
