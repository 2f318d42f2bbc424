"""Opening of runs, and their content."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import description, info, readers
from firetwin.run import opening as runs
from small_run import RUN_TOML, small_fields


@pytest.fixture(params=["npy", "text"])
def form(request):
    return request.param


def test_every_field_comes_back(make_run, form):
    run = runs.open(make_run(form))
    fields = small_fields()
    axes = "latitude", "longitude", "fuel_latitude", "fuel_longitude"
    for name in (*axes, "elevation", "surface_fuel", "canopy_fuel"):
        np.testing.assert_array_equal(getattr(run, name), fields[name], err_msg=name)
    for i in range(3):
        np.testing.assert_array_equal(run.heat_flux(i), fields["heat_flux"][i])
        np.testing.assert_array_equal(run.temperature(i), fields["temperature"][i])
        np.testing.assert_array_equal(run.wind(i)[0], fields["wind_east"][i])
        np.testing.assert_array_equal(run.wind(i)[1], fields["wind_north"][i])
    assert run.fields == sorted(fields)
    assert run.warnings == []


def test_what_run_toml_says(make_run):
    run = runs.open(make_run())
    assert (run.name, run.event, run.synthetic, run.vertical) == ("Small", "king_fire", True, "orthometric")
    assert run.start == "2014-09-17T04:45:00Z"
    np.testing.assert_array_equal(run.times, [0.0, 60.0, 120.0])
    assert run.path.endswith("run")


def test_defaults(make_run):
    run = runs.open(make_run(toml="start = 2014-01-01T00:00:00.5+05:30\ntimes_s = [0, 1.5, 9]\n"))
    assert (run.name, run.event, run.synthetic, run.vertical) == ("run", "", False, "orthometric")
    assert run.start == "2013-12-31T18:30:00.500000Z"
    np.testing.assert_array_equal(run.times, [0.0, 1.5, 9.0])
    assert len(run.warnings) == 1
    assert "vertical" in run.warnings[0]


def test_frames_may_be_npy_files_per_time(make_run):
    folder = make_run(heat_flux=None)
    (folder / "heat_flux").mkdir()
    for i, frame in enumerate(small_fields()["heat_flux"]):
        np.save(folder / "heat_flux" / f"{i:06d}.npy", frame)
    np.testing.assert_array_equal(runs.open(folder).heat_flux(2), small_fields()["heat_flux"][2])


def test_columns_of_text_are_axes_too(make_run):
    folder = make_run("text")
    np.savetxt(folder / "latitude.txt", small_fields()["latitude"], fmt="%.17g")
    np.testing.assert_array_equal(runs.open(folder).latitude, small_fields()["latitude"])


def test_no_data_becomes_nan(make_run, form):
    flux = small_fields()["heat_flux"]
    flux[0, 0, 0] = -9999
    canopy = small_fields()["canopy_fuel"]
    canopy[3, 4] = -9999
    run = runs.open(make_run(form, heat_flux=flux, canopy_fuel=canopy))
    assert np.isnan(run.heat_flux(0)[0, 0])
    assert np.isnan(run.canopy_fuel[3, 4])
    assert run.flux_range() == (0.0, 2000.25)
    assert any("canopy_fuel has no value in 1 cells" in w for w in run.warnings)
    assert any("heat_flux has no value 1 times" in w for w in run.warnings)


def test_a_field_that_could_not_be_read_is_read_again(make_run):
    folder = make_run()
    run = runs.open(folder)
    path = folder / "surface_fuel.npy"
    whole = path.read_bytes()
    with path.open("r+b") as file:
        file.truncate(len(whole) - 1)
    for _ in range(2):
        with pytest.raises(core.InputError, match=r"surface_fuel\.npy"):
            run.surface_fuel  # noqa: B018
    path.write_bytes(whole)
    np.testing.assert_array_equal(run.surface_fuel, small_fields()["surface_fuel"])


def test_descending_axes(make_run):
    fields = small_fields()
    run = runs.open(
        make_run(
            latitude=fields["latitude"][::-1],
            elevation=fields["elevation"][::-1].copy(),
            fuel_latitude=fields["fuel_latitude"][::-1],
        )
    )
    other = np.flipud(run.fuel_elevation)
    ascending = np.array(run.elevation[::-1])
    assert other[0, 0] == pytest.approx(ascending[0, 0], abs=1e-3)


def test_one_cell(make_run):
    one = np.ones((1, 1), np.float32)
    run = runs.open(
        make_run(
            **dict.fromkeys(("latitude", "fuel_latitude"), np.array([38.9])),
            **dict.fromkeys(("longitude", "fuel_longitude"), np.array([-120.6])),
            **dict.fromkeys(("elevation", "surface_fuel", "canopy_fuel"), one),
            **dict.fromkeys(("temperature", "wind_east", "wind_north")),
            heat_flux=one[None],
        )
    )
    assert run.heat_flux(0).shape == (1, 1)
    np.testing.assert_array_equal(run.arrival_time(), [[0.0]])
    np.testing.assert_array_equal(run.fuel_arrival_time(), [[0.0]])


def test_flux_range_is_of_the_whole_run_and_skips_what_is_not_finite(make_run, form):
    flux = small_fields()["heat_flux"]
    flux[0, 0, :3] = [np.nan, np.inf, -3.5]
    run = runs.open(make_run(form, heat_flux=flux))
    assert run.flux_range() == (-3.5, 2000.25)
    assert any("negative 1 times" in w for w in run.warnings)


def test_flux_range_of_nothing(make_run):
    run = runs.open(make_run(heat_flux=np.full((3, 4, 5), np.nan, np.float32)))
    assert run.flux_range() == (0.0, 0.0)
    assert np.isnan(run.arrival_time()).all()
    assert "heat_flux has no finite value at any time, so nothing burns by it" in run.warnings


def test_fuel_elevation(make_run):
    elevation = small_fields()["elevation"]
    run = runs.open(make_run())
    assert run.fuel_elevation[0, 0] == elevation[0, 0]
    quarter = np.array([[0.75, 0.25]])
    expected = (quarter @ elevation[1:3, 2:4] @ np.array([[0.75], [0.25]])).item()
    assert run.fuel_elevation[3, 5] == pytest.approx(expected, rel=1e-6)


def test_fuel_elevation_is_the_runs_own(make_run):
    own = np.arange(80, dtype=np.float32).reshape(8, 10)
    np.testing.assert_array_equal(runs.open(make_run(fuel_elevation=own)).fuel_elevation, own)


def test_views_are_read_only_and_outlive_the_run(make_run):
    elevation = runs.open(make_run()).elevation
    with pytest.raises(ValueError, match="read-only"):
        elevation[0, 0] = 0
    np.testing.assert_array_equal(elevation, small_fields()["elevation"])


def test_odd_but_usable(make_run):
    fields = small_fields()
    folder = make_run(
        fuel_latitude=fields["fuel_latitude"] + 0.002,
        surface_fuel=-fields["surface_fuel"],
        elevation=np.full((4, 5), np.nan, np.float32),
    )
    np.save(folder / "temprature.npy", np.zeros(3))
    (folder / "README.md").write_text("about this run")
    warnings = "\n".join(runs.open(folder).warnings)
    for part in ("temprature.npy", "beyond the model grid", "surface_fuel is negative", "elevation has no"):
        assert part in warnings
    assert "README" not in warnings


def test_a_run_without_temperature_and_wind(make_run):
    run = runs.open(make_run(temperature=None, wind_east=None, wind_north=None))
    with pytest.raises(core.Error, match="no temperature"):
        run.temperature(0)
    with pytest.raises(core.Error, match="no wind"):
        run.wind(0)


@pytest.mark.parametrize("index", [-1, 3])
def test_index_out_of_range(make_run, index):
    with pytest.raises(IndexError):
        runs.open(make_run()).heat_flux(index)


def test_a_file_that_shrinks_after_opening(make_run):
    folder = make_run()
    run = runs.open(folder)
    path = folder / "heat_flux.npy"
    path.write_bytes(path.read_bytes()[:-4])
    with pytest.raises(core.InputError, match="too early"):
        run.heat_flux(2)


def test_units_in_their_usual_spellings(make_run):
    toml = RUN_TOML + 'temperature = "kelvin"\ncanopy_fuel = "kg m-2"\nwind_east = "m s-1"\n'
    assert runs.open(make_run(toml=toml)).warnings == []


def test_the_air_may_have_a_grid_of_its_own(make_run, form):
    """A bilinear field is exact on the model grid; beyond its outermost points it is constant."""
    latitude, longitude = np.array([38.902, 38.907]), np.array([-120.598, -120.592, -120.586])
    y, x = np.meshgrid(latitude, longitude, indexing="ij")
    values = np.stack([k + 1e3 * (y - 38.9) + 2e3 * (x + 120.6) for k in range(3)]).astype(np.float32)
    folder = make_run(
        form,
        air_latitude=latitude,
        air_longitude=longitude,
        temperature=300 + values,
        wind_east=values,
        wind_north=-values,
    )
    run = runs.open(folder)
    np.testing.assert_array_equal(run.air_longitude, longitude)
    y = np.clip(run.latitude, *latitude)[:, None]
    x = np.clip(run.longitude, *longitude[[0, -1]])
    frames = list(run.frames("temperature"))
    for k in range(3):
        expected = k + 1e3 * (y - 38.9) + 2e3 * (x + 120.6)
        np.testing.assert_allclose(run.wind(k)[0], expected, atol=1e-4)
        np.testing.assert_allclose(run.wind(k)[1], -expected, atol=1e-4)
        np.testing.assert_allclose(run.temperature(k), 300 + expected, atol=1e-3)
        np.testing.assert_array_equal(frames[k], run.temperature(k))


def test_without_a_grid_of_its_own_the_air_has_that_of_the_model(make_run):
    run = runs.open(make_run())
    np.testing.assert_array_equal(run.air_latitude, run.latitude)
    np.testing.assert_array_equal(run.air_longitude, run.longitude)


def test_burned_fraction_is_of_fuel_cells(make_run, form):
    share = np.random.default_rng(5).random((3, 8, 10)).astype(np.float32)
    run = runs.open(make_run(form, burned_fraction=share))
    np.testing.assert_array_equal(run.burned_fraction(1), share[1])
    np.testing.assert_array_equal(np.stack(list(run.frames("burned_fraction"))), share)


def test_a_run_without_a_burned_fraction(make_run):
    with pytest.raises(core.Error, match="no burned_fraction"):
        runs.open(make_run()).burned_fraction(0)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[source]\nassumptions = 5", "source.assumptions is not a list of texts"),
        ("[source]\nassumptions = [5]", "source.assumptions is not a list of texts"),
        ("[source]\nmodel = [1]", "source.model is not a text"),
    ],
)
def test_a_source_of_another_type_is_an_error(make_run, text, reason):
    folder = make_run()
    (folder / "run.toml").write_text(f"{RUN_TOML}{text}\n")
    with pytest.raises(core.InputError, match=f"run.toml: {reason}"):
        info.gather(runs.open(folder), "UTC")


@pytest.mark.parametrize(
    "text",
    [
        RUN_TOML.replace("2014-09-16T", "0014-09-16T"),
        RUN_TOML.replace("2014-09-16T", "9999-09-16T"),
        RUN_TOML.replace("interval_s = 60.0", "times_s = [-1e308, 60, 120]"),
        RUN_TOML.replace("interval_s = 60.0", "interval_s = 1e12"),
    ],
)
def test_times_that_are_no_dates_are_refused(make_run, text):
    folder = make_run()
    (folder / "run.toml").write_text(text)
    with pytest.raises(core.InputError, match="has times outside of the years 1000 to 9998; correct"):
        readers.open(folder)


def test_every_field_has_a_unit():
    assert set(description.UNITS) == set(core.run.FIELDS)
