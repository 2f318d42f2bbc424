"""The sample run: the store, and the files of its expansion."""

import filecmp
import tomllib

import firetwin_core
import numpy as np
import pytest
from firetwin.data import air, grid, history, release, sample, stored, weather
from firetwin.run import opening, times

JOULES_PER_KG = 17.433e6


@pytest.fixture(scope="module")
def store():
    return stored.load()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("sample") / "run"
    sample.write(out, frames=5)
    return out


# The store


def test_as_many_trees_and_grass_clumps_as_published(store):
    canopy, surface = (store.canopy > 0.01).sum(), (store.surface > 0).sum()
    assert abs(canopy / 363_632 - 1) < 0.01
    assert abs(surface / 419_048 - 1) < 0.01


def test_water_carries_no_fuel(store):
    assert store.water.sum() > 1000
    assert store.surface[store.water].max() == 0
    assert store.canopy[store.water].max() == 0


def test_terrain_goes_through_the_spot_heights(store):
    event = history.load()
    assert set(store.misfit) == {place.name for place in event.places}
    assert np.sqrt(np.mean(np.square(list(store.misfit.values())))) < 5.0
    errors = []
    for place in event.places:
        row, column = grid.cell_of(place.latitude, place.longitude)
        if 0 <= row < 720 and 0 <= column < 720:
            errors.append(store.elevation[row, column] - place.height)
    assert len(errors) > 40
    assert np.sqrt(np.mean(np.square(errors))) < 5.0


def test_rivers_run_downhill(store):
    assert {"Rubicon River", "Middle Fork American River", "South Fork American River"} <= set(store.rivers)
    for name, (row, column) in store.rivers.items():
        profile = store.elevation[row, column]
        assert np.diff(profile).min() > -0.11, name  # heights are stored in tenths of a metre


def test_burned_area_follows_the_reports(store):
    tolerance = {0.0: 0.005, 615.0: 0.03, 1275.0: 0.03, 1815.0: 0.03}  # minutes after the start
    checked = 0
    for time, acres, *_ in history.load().acreages:
        minute = (time - stored.START).total_seconds() / 60
        if minute in tolerance:
            burned = (store.arrival <= minute * 60).sum() * stored.ACRES_PER_CELL
            assert abs(burned / acres - 1) < tolerance[minute], (time, burned)
            checked += 1
    assert checked == len(tolerance)


def test_the_fire_before_the_run_follows_the_reports(store):
    first = history.load().acreages[0]
    seconds = (first.time - stored.START).total_seconds()
    burned = (store.arrival <= seconds).sum() * stored.ACRES_PER_CELL
    assert abs(burned / first.acres - 1) < 0.01
    ignition = (history.load().ignitions[0].time - stored.START).total_seconds()
    assert ignition <= np.nanmin(store.arrival) < ignition + 3600


# Heat


def test_share_released_against_numerical_integration():
    parts = release.Burns(
        np.zeros(3, int),
        np.ones(3),
        np.array([0.0, 50, -400]),
        np.array([20.0, 3600, 700]),
        np.array([45.0, 500, 90]),
    )
    for time in (-10.0, 5.0, 60.0, 700.0, 5000.0):
        for i, share in enumerate(parts.released(time)):
            lit = parts.arrival[i] + parts.crossing[i] * (np.arange(20000) + 0.5) / 20000
            exact = np.mean(1 - np.exp(-np.maximum(time - lit, 0) / parts.burn_out[i]))
            assert share == pytest.approx(exact, abs=1e-6)


def test_heat_released_is_burned_fuel_times_heat_of_combustion(store):
    parts = release.burns(store)
    released = release.Released(parts)
    total, by_cell = 0.0, np.zeros((144, 144))
    for minute in range(-1, stored.MINUTES + 1):
        joules = released.until(minute * 60.0)
        total += joules.sum()
        by_cell += joules
    assert by_cell.sum() == pytest.approx(total)

    # Burned by the end and not yet at the start, from 200 spots of each cell lit one after the other.
    burned = 0.0
    for spot in (np.arange(200) + 0.5) / 200:
        lit = parts.arrival + spot * parts.crossing
        left = [
            np.exp(-np.maximum(time - lit, 0) / parts.burn_out) for time in (-60.0, stored.MINUTES * 60.0)
        ]
        burned += np.sum(parts.heat / JOULES_PER_KG * (left[0] - left[1])) / 200
    assert total == pytest.approx(burned * JOULES_PER_KG, rel=0.01)

    # If the fire is completely within the run, all fuel is consumed.
    inside = (store.arrival > 0) & (store.arrival < stored.MINUTES * 60 - 6 * 3600)
    whole = grid.block_mean((inside | ~np.isfinite(store.arrival)).astype(float)) == 1
    fuel = grid.block_mean(release.consumed_fuel(store)) * 370.0**2
    assert whole.sum() > 500
    assert by_cell[whole].sum() == pytest.approx(fuel[whole].sum() * JOULES_PER_KG, rel=0.01)


def test_canopy_burns_only_in_crown_fire(store):
    fuel = release.consumed_fuel(store)
    surface_fire = np.isfinite(store.arrival) & (store.crown == 0)
    np.testing.assert_allclose(fuel[surface_fire], store.surface[surface_fire])
    crown_fire = store.crown == 2
    assert np.all(fuel[crown_fire] > store.surface[crown_fire])
    assert np.median(store.intensity[crown_fire]) > 5 * np.median(store.intensity[surface_fire])


def test_air_over_a_crown_fire_is_hot_and_draws_air_in():
    flux = np.zeros((144, 144))
    flux[72, 72] = 60e3
    assert 10 < air.warming(flux, np.full(flux.shape, 5.0))[72, 72] < 100
    east, north = air.Inflow().wind(flux)
    assert east[72, 70] > 0 > east[72, 74]
    assert north[70, 72] > 0 > north[74, 72]
    assert np.hypot(east, north).max() < 10


def test_dead_fuel_is_driest_in_the_afternoon():
    hours = np.arange(0, 31, 0.25)
    moisture = weather.dead_fuel_moisture(hours * 3600)
    assert 16 < hours[moisture.argmin()] < 21  # 14:00 to 19:00 PDT
    assert 0.02 < moisture.min() < 0.05 < moisture.max() < 0.12


# The run folder


def test_axes(folder):
    for prefix, cells, size in (("", 144, 370.0), ("fuel_", 720, 74.0)):
        latitude = np.load(folder / f"{prefix}latitude.npy")
        longitude = np.load(folder / f"{prefix}longitude.npy")
        assert latitude.shape == longitude.shape == (cells,)
        for axis in (latitude, longitude):
            np.testing.assert_allclose(np.diff(axis), np.diff(axis)[0], rtol=1e-9)
        frame = firetwin_core.geo.LocalFrame(latitude.mean(), longitude.mean(), 0.0)
        middle = slice(cells // 2 - 1, cells // 2 + 1)
        enu = frame.forward_grid(latitude[middle], longitude[middle], np.zeros((2, 2)))
        np.testing.assert_allclose(
            [enu[0, 1, 0] - enu[0, 0, 0], enu[1, 0, 1] - enu[0, 0, 1]], size, rtol=1e-4
        )
        # Both grids cover the same square.
        assert latitude[0] - np.diff(latitude)[0] / 2 == pytest.approx(_edge(folder), abs=1e-9)


def _edge(folder):
    latitude = np.load(folder / "latitude.npy")
    return latitude[0] - np.diff(latitude)[0] / 2


def test_the_core_opens_it(folder, store):
    run = opening.open(folder)
    assert run.name == "King Fire 2014 (synthetic sample)"
    assert run.synthetic
    assert run.event == "king_fire"
    assert run.start.startswith("2014-09-17T04:45:00")
    np.testing.assert_array_equal(run.times, np.rint(np.linspace(0, 1857, 5)) * 60)
    np.testing.assert_allclose(run.fuel_arrival_time(), store.arrival, rtol=1e-6)
    np.testing.assert_allclose(run.elevation, grid.block_mean(store.elevation), atol=1e-3)
    assert not run.warnings


def test_values_are_physical(folder):
    flux, kelvin = np.load(folder / "heat_flux.npy"), np.load(folder / "temperature.npy")
    speed = np.hypot(np.load(folder / "wind_east.npy"), np.load(folder / "wind_north.npy"))
    assert flux.dtype == np.float32
    assert flux.shape == (5, 144, 144)
    assert flux.min() == 0
    assert 1e3 < flux.max() < 3e5
    assert 270 < kelvin.min() < kelvin.max() < 450
    assert 0 < speed.max() < 35
    assert np.load(folder / "fuel_elevation.npy").shape == (720, 720)


def test_more_frames_than_minutes_are_refused():
    with pytest.raises(firetwin_core.InputError, match="1 to 1858"):
        sample.write("unused", frames=1859)


def test_the_same_every_time(folder, tmp_path):
    again = tmp_path / "again"
    sample.write(again, frames=5)
    names = sorted(path.name for path in folder.iterdir())
    assert names == sorted(path.name for path in again.iterdir())
    assert filecmp.cmpfiles(folder, again, names, shallow=False)[1:] == ([], [])


def test_text_and_npy_agree(folder, tmp_path):
    out = tmp_path / "text"
    sample.write(out, frames=5, format="text")
    text, npy = opening.open(out), opening.open(folder)
    np.testing.assert_array_equal(text.times, npy.times)
    np.testing.assert_allclose(text.heat_flux(3), npy.heat_flux(3), atol=0.501)
    np.testing.assert_allclose(text.temperature(3), npy.temperature(3), atol=0.0501)
    np.testing.assert_allclose(text.wind(3), npy.wind(3), atol=0.0501)
    np.testing.assert_allclose(text.canopy_fuel, npy.canopy_fuel, rtol=1e-6)
    np.testing.assert_allclose(text.fuel_arrival_time(), npy.fuel_arrival_time(), rtol=1e-6)
    np.testing.assert_array_equal(text.latitude, npy.latitude)


def test_an_earlier_sample_is_replaced_and_anything_else_left_alone(tmp_path):
    out = tmp_path / "run"
    out.mkdir()
    sample.write(out, frames=1)
    sample.write(out, frames=2)
    assert len(tomllib.loads((out / "run.toml").read_text())["units"]) == 9
    assert np.load(out / "heat_flux.npy").shape[0] == 2

    (out / "run.toml").write_text('name = "Somebody\'s own run"\n')
    with pytest.raises(firetwin_core.InputError, match="not a sample run"):
        sample.write(out, frames=1)
    assert np.load(out / "heat_flux.npy").shape[0] == 2
    assert [path.name for path in tmp_path.iterdir()] == ["run"]

    file = tmp_path / "file"
    file.write_text("x")
    with pytest.raises(firetwin_core.InputError) as caught:
        sample.write(file, frames=1)
    assert caught.value.path == str(file)


def test_the_early_run_begins_at_its_ignition(tmp_path, store):
    sample.write(tmp_path / "run", frames=4, early=True)
    run = opening.open(tmp_path / "run")
    arrival = np.asarray(run.fuel_arrival_time())
    assert f"{times.utc(run, 0.0):%d %H:%M}" == "13 23:32"
    assert run.times.tolist() == [0.0, 7200.0, 14400.0, 21600.0]
    assert 0.0 <= np.nanmin(arrival) < 60.0
    assert 21000.0 < np.nanmax(arrival) <= 21600.0
    end = np.nanmin(store.arrival) - np.nanmin(arrival) + 21600.0
    assert np.array_equal(np.isfinite(arrival), store.arrival <= end)
    assert run.heat_flux(0).max() == 0.0
    assert run.heat_flux(1).max() > 1e3
    afternoon = run.temperature(0).mean() - 273.15  # 16:32 PDT, as of 17 September
    assert 20.0 < afternoon < 35.0
    with pytest.raises(firetwin_core.InputError, match="no other pace"):
        sample.write(tmp_path / "run", frames=4, pace=2.0, early=True)


def test_progress_is_told(tmp_path):
    told = []
    sample.write(tmp_path / "run", frames=3, progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 3), (2, 3), (3, 3)]
