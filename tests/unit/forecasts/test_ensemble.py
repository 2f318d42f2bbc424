"""Ensembles: statistics by hand and by NumPy, depths of nested areas, and gathered runs."""

import os
from pathlib import Path

import ensembles
import numpy as np
import pytest
from firetwin.errors import Error, InputError
from firetwin.forecasts import convert as members_convert
from firetwin.forecasts.ensemble import choice, ensemble, gather, manifest, statistics, summary, write
from firetwin.forecasts.ensemble.manifest import LeftOut, Manifest, Member
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from small_ensemble import ISSUED, make
from small_run import RUN_TOML, small_fields

NEVER, NONE = np.inf, np.nan


def test_shares_and_quantiles_by_hand(tmp_path):
    # three cells: three outcomes, one member without a simulation there, and 30 % that burn at all
    cells = np.array([[1, 2, 3, 4, 5, 6, 7, 8, 9, 10], [NONE, *[2] * 9], [1, 2, 3, *[NEVER] * 7]])
    forecast = make(tmp_path, cells.T.reshape(10, 1, 3))
    shares = statistics.shares(forecast, [3.0, 24.0])
    assert shares.share[0].tolist() == [[pytest.approx(0.3), 1.0, pytest.approx(0.3)]]
    assert shares.share[1].tolist() == [[1.0, 1.0, pytest.approx(0.3)]]
    assert shares.counted.tolist() == [10, 10]
    # the mean of burned members would be 2 in the last cell, where 70 % never burn
    assert statistics.quantiles(forecast, [0.1, 0.3, 0.5])[:, 0].tolist() == [
        [1, 2, 1],
        [3, 2, 3],
        [5, 2, NEVER],
    ]


def test_a_member_that_ends_early_leaves_the_count(tmp_path):
    forecast = make(tmp_path, [[[1.0]], [[NEVER]], [[9.0]]], ends=[5.0, 24.0, 24.0])
    shares = statistics.shares(forecast, [4.0, 10.0])
    assert shares.share[:, 0, 0].tolist() == [pytest.approx(1 / 3), 0.5]
    assert shares.counted.tolist() == [3, 2]
    assert statistics.quantiles(forecast, [0.5, 1.0])[:, 0, 0].tolist() == [9.0, NEVER]
    assert np.isnan(statistics.burned_areas(forecast, [10.0])[0, 0])
    short = make(tmp_path / "short", [[[1.0]]], ends=[5.0])
    for ask in (lambda: statistics.quantiles(short, [0.5]), lambda: choice.choose(short)):
        with pytest.raises(Error, match="no member reaches the horizon"):
            ask()


times = st.one_of(st.floats(0, 24, width=16), st.just(NEVER), st.just(NONE))


@given(
    arrays.arrays(np.float32, arrays.array_shapes(min_dims=3, max_dims=3, max_side=5), elements=times),
    st.data(),
)
def test_quantile_is_the_earliest_time_with_its_share(tmp_path_factory, arrival, data):
    weights = data.draw(st.lists(st.integers(1, 4), min_size=len(arrival), max_size=len(arrival)))
    forecast = make(tmp_path_factory.mktemp("e"), arrival, weights)
    levels = [0.1, 0.5, 1.0]
    quantiles = statistics.quantiles(forecast, levels)
    weight = np.array(weights, float)[:, None, None] * ~np.isnan(arrival)
    total = weight.sum(0)
    assert (np.isnan(quantiles) == (total == 0)).all()
    for level, quantile in zip(levels, quantiles, strict=True):
        upto = (weight * (arrival <= quantile)).sum(0)
        before = (weight * (arrival < quantile)).sum(0)
        assert ((upto >= level * total - 1e-9) | (total == 0)).all()
        assert ((before < level * total + 1e-9) | (total == 0)).all()


def test_statistics_do_not_depend_on_blocks(tmp_path, monkeypatch):
    rng = np.random.default_rng(3)
    arrival = rng.uniform(0, 30, (7, 11, 13)).astype(np.float32)
    forecast = make(tmp_path, np.where(arrival > 24, NEVER, arrival))

    def all_of() -> list:
        found = statistics.shares(forecast, [6.0, 12.0]).share, statistics.quantiles(forecast, [0.3])
        return [*found, statistics.burned_areas(forecast, [12.0]), statistics.depths(forecast, 24.0)]

    whole = all_of()
    monkeypatch.setattr(ensemble, "_BLOCK", 100)
    for before, after in zip(whole, all_of(), strict=True):
        np.testing.assert_allclose(after, before, rtol=1e-6)


def test_middle_of_nested_fires_is_deepest(tmp_path):
    radius = np.hypot(*np.mgrid[-10:11, -10:11])
    sizes = [9.5, 3.5, 5.5, 7.5, 4.5]
    arrival = [np.where(radius <= size, radius, NEVER) for size in sizes]
    far = np.full_like(radius, NEVER)
    far[:3, :3] = 1.0
    forecast = make(tmp_path, [*arrival, far])
    chosen = choice.choose(forecast)
    assert (sizes[chosen.typical], sizes[chosen.largest], chosen.smallest, chosen.outlier) == (5.5, 9.5, 5, 5)
    assert choice.representatives(forecast, 1) == [2]
    assert choice.representatives(forecast, 3) == [2, 5, 0]  # typical, outlier, largest
    assert sorted(choice.representatives(forecast, 9)) == list(range(6))


def test_representatives_stand_for_the_most_others(tmp_path):
    """Four members burn one cell, three another, two a third, and one the last: the outlier."""
    cells = [0] * 4 + [1] * 3 + [2] * 2 + [3]
    forecast = make(tmp_path, np.where(np.eye(4)[cells][:, None] > 0, 1.0, NEVER))
    assert choice.representatives(forecast, 3) == [0, 9, 4]
    assert choice.representatives(forecast, 5)[:4] == [0, 9, 4, 7]


def test_summary_names_members_and_areas(tmp_path):
    forecast = make(tmp_path, [[[1, NEVER, NEVER]], [[1, 1, NEVER]], [[1, 1, 1]]])
    facts = summary.gather(forecast)
    assert facts["choice"] == {"typical": "01", "smallest": "00", "largest": "02", "outlier": "00"}
    area = forecast.areas[0]
    assert [each["area"] for each in facts["members"]] == pytest.approx(list(area.cumsum()))
    text = summary.page(facts)
    assert "members     3 of 3" in text
    assert f"burned      {area[0] / 1e4:,.0f} ha to {area.sum() / 1e4:,.0f} ha" in text


def test_depth_by_hand(tmp_path):
    # areas {a}, {a, b}, {b, c}: inclusion of i in j is the common part of i
    forecast = make(tmp_path, [[[1, NEVER, NEVER]], [[1, 1, NEVER]], [[NEVER, 1, 1]]])
    inside = np.array([[0, 1, 0], [0.5, 0, 0.5], [0, 0.5, 0]])
    expected = np.minimum(inside.sum(1), inside.sum(0)) / 2
    np.testing.assert_allclose(statistics.depths(forecast, 24.0), expected, atol=1e-3)


def test_depths_are_means_over_pairs(tmp_path):
    """Sums over cells equal the definition by pairs, with an empty, a short and a partly simulated member."""
    rng = np.random.default_rng(5)
    centre = rng.uniform(-3, 3, (9, 2, 1, 1))
    arrival = np.hypot(*(np.mgrid[-8:9, -8:9] - centre).swapaxes(0, 1)) * rng.uniform(2, 6, (9, 1, 1))
    arrival[arrival > 24] = NEVER
    arrival[3], arrival[5, :4], arrival[6, 8:] = NEVER, np.nan, NEVER
    forecast = make(tmp_path, arrival)
    for time in (-1.0, 8.0, 24.0):
        common = statistics.overlaps(forecast, time)
        own = np.diag(common)[:, None]
        inside = np.divide(common, own, out=np.ones_like(common), where=own > 0)
        np.fill_diagonal(inside, 0.0)
        expected = np.minimum(inside.sum(0), inside.sum(1)) / 8
        np.testing.assert_allclose(statistics.depths(forecast, time), expected, atol=1e-6)


def test_depths_agree_with_those_of_the_benchmark(tmp_path):
    forecast = ensembles.make(tmp_path / "ensemble", 12, 30)
    arrival = np.load(forecast.path / "arrival.npy")
    depths = ensembles.compute(forecast)[2]
    np.testing.assert_allclose(ensembles.numpy_depths(arrival, forecast.areas), depths, atol=5e-6)


def test_a_file_that_becomes_shorter_is_an_error(tmp_path):
    forecast = make(tmp_path, np.ones((3, 4, 5)))
    with (forecast.path / ensemble.ARRIVAL).open("r+b") as file:
        file.truncate(file.seek(0, 2) - 4)
    with pytest.raises(InputError, match="arrival"):
        list(forecast.blocks())


def test_members_that_fail_are_named_and_not_counted(tmp_path):
    head = Manifest("test", "", ISSUED, 24.0, (), (LeftOut("00", "failed"),))
    members = [(Member("01"), np.ones((1, 2), np.float32)), (Member("02"), "is empty")]
    axes = np.array([38.8]), np.array([-120.6, -120.5])
    write.write(tmp_path / "out", head, *axes, members)
    forecast = ensemble.open(tmp_path / "out")
    assert [member.name for member in forecast.members] == ["01"]
    assert forecast.left_out == (LeftOut("00", "failed"), LeftOut("02", "is empty"))
    assert statistics.shares(forecast, [2.0]).counted.tolist() == [1]
    with pytest.raises(InputError, match="no member has arrival times; 02: is empty"):
        write.write(tmp_path / "none", head, *axes, members[1:])
    assert not (tmp_path / "none").exists()
    assert [each.name for each in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        (np.ones((2, 2)), r"member 01 has \(2, 2\) cells, and the ensemble \(1, 2\)"),
        (np.full((1, 2), -np.inf), "member 01 has an arrival time of -inf"),
    ],
)
def test_bad_members_leave_nothing(tmp_path, values, reason):
    head = Manifest("test", "", ISSUED, 24.0, ())
    with pytest.raises(InputError, match=reason):
        write.write(tmp_path / "out", head, np.zeros(1), np.arange(2.0), [(Member("01"), values)])
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("name = ", r"toml: is not TOML: Invalid value"),
        ("title = 'x'\n[[member]]\nname = 'a'", 'unknown key "title"'),
        ("name = 'a'\nx y", r"toml:2:3: is not TOML: Expected '='"),
        ("kind = 'best'\n[[member]]\nname = 'a'", 'kind is "best"; write one of forecast, scenarios'),
        ("", "has 0 members; list 1 to 10,000"),
        ("[[member]]\nname = 'a'\n[[member]]\nname = 'a'", 'two members have the name "a"'),
        ("[[member]]\nname = 'a'\nweight = -1", "member 1: weight is not a number from 1e-09"),
        ("member = 3", r"member is not a list of tables; write \[\[member\]\]"),
        ("issued = 2014-09-17T12:00:00\n[[member]]\nname = 'a'", "issued is not a time with an offset"),
        ("[[member]]\nweight = 1", "member 1: has neither a name nor a run"),
    ],
)
def test_bad_manifests_have_one_reason(tmp_path, text, reason):
    path = tmp_path / "ensemble.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=reason):
        manifest.read(path)


def test_manifest_survives_hostile_names(tmp_path):
    hostile = 'a "quoted"\\ name, \N{FIRE}'
    forecast = Manifest(
        *(hostile, "model", ISSUED, 3600.0, (Member(hostile, 2.5, 60.0, Path("runs/a")),)),
        *((LeftOut("b", hostile),), "wind", "fuel", True, "UTC", "files"),
    )
    path = tmp_path / "ensemble.toml"
    path.write_text(manifest.text(forecast), encoding="utf-8")
    assert manifest.read(path) == forecast


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("times_burned_0012", "counts of ELMFIRE's cases that burned a cell"),
        ("burn_probability_t120", "GridFire's share of simulations"),
        ("fire_probability_3600", "PROPAGATOR's share of realisations"),
        ("FSPro_7day", "FSPro's share of simulations of drawn weather"),
        ("ros_max_60", "PROPAGATOR's share of realisations"),
        ("FSim_BP_CONUS", "FSim's yearly probability"),
        ("IFTDSS_bp", "a probability given an ignition somewhere"),
        ("hours-since-burned_90_012", "one simulation that stands for a rank of fire size"),
        ("burn_probability", "burn probabilities without the meaning"),
    ],
)
def test_a_probability_is_no_fire(tmp_path, name, reason):
    """Each of the six meanings: the map is refused in a sentence that says what it is."""
    (tmp_path / f"{name}.tif").write_bytes(b"II*\0")
    with pytest.raises(InputError, match=f"{reason}.*: no fire can burn from it; give "):
        members_convert.in_process([tmp_path], tmp_path / "out", ["2024-01-01T00:00Z", "", "", 0, "", ""])


def test_a_damaged_folder_is_one_error(tmp_path):
    forecast = make(tmp_path, [[[1.0]]])
    np.save(forecast.path / "arrival.npy", np.zeros((2, 1, 1), np.float32))
    with pytest.raises(InputError, match=r"arrival.npy: holds float32 \(2, 1, 1\), not float32 \(1, 1, 1\)"):
        ensemble.open(forecast.path)
    (forecast.path / "arrival.npy").write_bytes(b"x")
    with pytest.raises(InputError, match=r"arrival.npy: "):
        ensemble.open(forecast.path)


@pytest.fixture
def make_members(make_run, tmp_path):
    """Write small runs in a folder: each of the changes is one member's fields, or its run.toml."""

    def make(*changes: dict) -> Path:
        folder = tmp_path / "members"
        folder.mkdir()
        for index, change in enumerate(changes):
            make_run(**change).rename(folder / f"{index:02}")
        return folder

    return make


def test_runs_become_members(make_members, tmp_path):
    """Two runs whose grids overlap, one that never burns, and one that is damaged."""
    fields = small_fields()
    time = np.where(np.arange(80) < 60, np.arange(80.0), np.nan).reshape(8, 10).astype(np.float32)
    shifted = {"fuel_longitude": fields["fuel_longitude"] + np.diff(fields["fuel_longitude"]).mean()}
    folder = make_members(
        {"fuel_arrival_time": time},
        {"fuel_arrival_time": time} | shifted,
        {"fuel_arrival_time": np.full_like(time, np.nan)},
        {},
    )
    (folder / "03" / "run.toml").write_text("start = 3", encoding="utf-8")
    gather.convert(folder, tmp_path / "out")
    forecast = ensemble.open(tmp_path / "out")
    assert [member.name for member in forecast.members] == ["00", "01"]
    assert [each.name for each in forecast.left_out] == ["02", "03"]
    assert forecast.left_out[0].reason == "nothing burns"
    first, second = forecast.arrival(0), forecast.arrival(1)
    assert np.isnan(first[:, -1]).all()  # outside of its grid: not simulated
    assert np.isnan(second[:, 0]).all()
    np.testing.assert_array_equal(first[:, :-1], second[:, 1:])
    assert np.isinf(first[:, :-1]).any()  # "never" in the run


def test_more_members_than_open_files(make_members, tmp_path):
    resource = pytest.importorskip("resource")
    folder, before = make_members(*[{}] * 12), resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (len(os.listdir("/dev/fd")) + 24, before[1]))
    try:
        gather.convert(folder, tmp_path / "out")
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)
    assert len(ensemble.open(tmp_path / "out").members) == 12


def test_members_on_other_cells_or_with_other_starts_are_refused(make_members, tmp_path):
    fields = small_fields()
    half = {"fuel_latitude": fields["fuel_latitude"] + 0.3 * np.diff(fields["fuel_latitude"]).mean()}
    folder = make_members({}, half)
    with pytest.raises(InputError, match="01 has other cells than 00; members need cells of one grid"):
        gather.convert(folder, tmp_path / "out")
    later = RUN_TOML.replace("T21:45", "T23:45")
    np.save(folder / "01" / "fuel_latitude.npy", fields["fuel_latitude"])
    (folder / "01" / "run.toml").write_text(later, encoding="utf-8")
    with pytest.raises(InputError, match=r"begins \+2.00 h from 00; members have one start"):
        gather.convert(folder, tmp_path / "out")
    assert not (tmp_path / "out").exists()
    head = 'issued = 2014-09-17T04:45:00Z\n[[member]]\nrun = "00"\n[[member]]\nrun = "01"\n'
    (folder / "ensemble.toml").write_text(head, encoding="utf-8")
    gather.convert(folder, tmp_path / "out")
    forecast = ensemble.open(tmp_path / "out")
    burned = np.isfinite(forecast.arrival(0))
    assert (forecast.arrival(1)[burned] - forecast.arrival(0)[burned] == 7200.0).all()
