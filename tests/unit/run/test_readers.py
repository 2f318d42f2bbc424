"""Tolerance of readers: NumPy files in any layout, other longitudes, quoted times, trailing commas."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin_core.run import read_grid
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from hypothesis_profiles import examples
from small_run import NX, NY, RUN_TOML, small_fields

NUMBERS = [order + kind for order in "<>" for kind in ("f4", "f8", "i2", "i4", "i8", "u2", "u4", "u8")]
NUMBERS += ["|i1", "|u1"]
LARGEST = float(np.finfo(np.float32).max)


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """Save an array as numpy.save does, and give the path."""
    path = tmp_path_factory.mktemp("npy") / "grid.npy"

    def save(array):
        np.save(path, array)
        return path

    return save


def as_float32(array):
    with np.errstate(over="ignore"):
        return array.astype(np.float32)


@settings(deadline=None, max_examples=examples(400))
@given(
    array=st.sampled_from(NUMBERS).flatmap(
        lambda kind: hnp.arrays(
            kind,
            hnp.array_shapes(min_dims=1, max_dims=2, max_side=9),
            elements=st.floats(-LARGEST, LARGEST, width=32) | st.just(np.nan) if "f" in kind else None,
        )
    ),
    fortran=st.booleans(),
)
def test_a_grid_is_what_numpy_loads(saved, array, fortran):
    path = saved(np.asfortranarray(array) if fortran else array)
    expected = as_float32(np.atleast_2d(np.load(path)))
    np.testing.assert_array_equal(read_grid(path), expected)


@pytest.mark.parametrize("value", [2**63 - 1, 2**53 + 1, 2**24 + 1, 33554435, -(2**63)])
def test_large_integers_become_the_nearest_float(saved, value):
    assert read_grid(saved(np.array([[value]], np.int64)))[0, 0] == np.float32(value)


@pytest.mark.parametrize("kind", ["<f2", "|b1", "<c8", "<M8[s]", "<U3", "|S4", "|V4"])
def test_other_types_are_refused(saved, kind):
    with pytest.raises(core.InputError, match=r"has type '.*' where integers, '<f4' or '<f8' are needed"):
        read_grid(saved(np.zeros((2, 3), kind)))


@pytest.mark.parametrize("descr", ["=f4", "f4", "|f4", "<f40", "<f", "<i3", "<u16", ">f0", "<\x004", ""])
def test_types_that_numpy_never_writes_are_refused(tmp_path, descr):
    header = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': (1, 1), }}".encode()
    path = tmp_path / "grid.npy"
    path.write_bytes(b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + bytes(4))
    with pytest.raises(core.InputError, match="has type"):
        read_grid(path)


@pytest.mark.parametrize("order", ["C", "F"])
def test_a_double_too_large_for_a_float_is_named_by_its_place_in_the_array(saved, order):
    array = np.zeros((3, 4), order=order)
    array[1, 2] = 1e39
    with pytest.raises(core.InputError, match=r"value 6 of the flattened array is too large"):
        read_grid(saved(array))


@pytest.mark.parametrize("kind", ["<f4", ">f4", ">f8", "<i2", ">i4", "|u1"])
@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("times", [1, 3, 700])
def test_a_frame_is_converted_when_it_is_asked_for(make_run, kind, order, times):
    """700 times lie further apart in Fortran order than values that are read together."""
    flux = np.random.default_rng(1).integers(0, 200, (times, NY, NX)).astype(kind)
    none = dict.fromkeys(("temperature", "wind_east", "wind_north"))
    run = runs.open(make_run(heat_flux=np.asarray(flux, order=order), **none))
    for index in {0, times // 2, times - 1}:
        np.testing.assert_array_equal(run.heat_flux(index), as_float32(flux[index]))
    np.testing.assert_array_equal(list(run.frames()), as_float32(flux))
    said = any("heat_flux.npy is in Fortran order" in text for text in run.warnings)
    assert said == (order == "F" and times > 1)


def test_a_bad_frame_far_away_is_never_looked_at(make_run):
    flux = small_fields()["heat_flux"].astype(np.float64)
    flux[2, 0, 0] = 1e39
    none = dict.fromkeys(("temperature", "wind_east", "wind_north"))
    run = runs.open(make_run(heat_flux=np.asfortranarray(flux), **none))
    np.testing.assert_array_equal(run.heat_flux(1), flux[1])
    with pytest.raises(core.InputError, match="value 40 of the flattened array is too large"):
        run.heat_flux(2)


def test_levels_in_any_layout(make_run):
    levels = np.random.default_rng(2).integers(0, 90, (3, 6, NY, NX)).astype(">i2")
    heights = np.asfortranarray(np.broadcast_to(np.arange(6.0)[:, None, None] * 100, (6, NY, NX)))
    run = runs.open(make_run(smoke_3d=np.asfortranarray(levels), height_3d=heights))
    for index in range(3):
        np.testing.assert_array_equal(run.smoke_3d(index), levels[index])
        np.testing.assert_array_equal(run.height_3d(index), heights)


def test_no_data_of_integers(make_run):
    canopy = np.ones((8, 10), np.int16)
    canopy[2, 3] = -9999
    assert np.argwhere(np.isnan(runs.open(make_run(canopy_fuel=canopy)).canopy_fuel)).tolist() == [[2, 3]]


@settings(deadline=None, max_examples=examples(200))
@given(hnp.arrays(np.float32, hnp.array_shapes(min_dims=2, max_dims=2, max_side=6)), st.data())
def test_a_comma_may_end_any_row(tmp_path_factory, array, data):
    path = tmp_path_factory.mktemp("text") / "grid.txt"
    between = data.draw(st.sampled_from([",", ", ", " ,", " , "]))
    rows = []
    for row in array:
        end = data.draw(st.sampled_from(["", ",", ", ", " ,\t", ", # end"]))
        rows.append(between.join(f"{value:.9g}" for value in row) + end)
    path.write_bytes(data.draw(st.sampled_from(["\n", "\r\n"])).join(rows).encode())
    np.testing.assert_array_equal(read_grid(path), array)


@pytest.mark.parametrize(
    ("text", "line", "column", "reason"),
    [
        ("1,2,,\n", 1, 5, "a value is missing"),
        (",\n", 1, 1, "a value is missing"),
        ("1,2\n,\n", 2, 1, "a value is missing"),
        ("1,2,3\n4,5,\n", 2, 1, "2 values where the first has 3"),
        ("1,2,\n3,4,5\n", 2, 1, "3 values where the first has 2"),
        ("1,2,;\n", 1, 5, "is not a number"),
    ],
)
def test_a_comma_hides_no_missing_value(tmp_path, text, line, column, reason):
    (tmp_path / "grid.txt").write_text(text)
    with pytest.raises(core.InputError, match=reason) as caught:
        read_grid(tmp_path / "grid.txt")
    assert (caught.value.line, caught.value.column) == (line, column)


def started(make_run, start):
    return runs.open(make_run(toml=RUN_TOML.replace("2014-09-16T21:45:00-07:00", start)))


@pytest.mark.parametrize(
    "text",
    [
        "2014-09-16T21:45:00-07:00",
        "2014-09-17T04:45:00Z",
        "2014-09-17t04:45:00z",
        "2014-09-17T04:45Z",
        "20140917T0445Z",
        "2014-09-17T04:45:00,0Z",
        "2014-09-17T10:15:00.000+05:30",
    ],
)
@pytest.mark.parametrize("quote", ['"', "'"])
def test_a_start_in_quotes(make_run, text, quote):
    assert started(make_run, quote + text + quote).start == "2014-09-17T04:45:00Z"


@pytest.mark.parametrize(
    "text",
    [
        "2014-09-17T04:45:00",
        "2014-09-17",
        "2014-09-17Z",
        "2014-02-30T00:00:00Z",
        "2014-09-17T24:00:00Z",
        "17/09/2014 04:45 UTC",
        "0001-01-01T00:00:00+01:00",
        "9999-12-31T23:59:59-01:00",
        "",
    ],
)
def test_other_starts_are_refused(make_run, text):
    with pytest.raises(core.InputError, match="start must be a date and time with its offset") as caught:
        started(make_run, f'"{text}"')
    assert (caught.value.line, caught.value.column) == (2, 1)


def east(make_run, longitude, fuel_longitude):
    return runs.open(make_run(longitude=np.asarray(longitude), fuel_longitude=np.asarray(fuel_longitude)))


MODEL, FUEL = (small_fields()[name] for name in ("longitude", "fuel_longitude"))


def folded(axis, low):
    """Degrees from `low` on, as programs write that know no others."""
    return (np.asarray(axis) - low) % 360 + low


@pytest.mark.parametrize("low", [-180, 0])
@pytest.mark.parametrize("fuel_low", [-180, 0])
@pytest.mark.parametrize("descending", [False, True])
@pytest.mark.parametrize("middle", [-120.6, 0.0, 179.9999, -179.9999, 120.0])
def test_longitudes_may_count_in_either_way(make_run, low, fuel_low, descending, middle):
    shift = middle - MODEL.mean()
    model, fuel = (axis[::-1] if descending else axis for axis in (MODEL + shift, FUEL + shift))
    run = east(make_run, folded(model, low), folded(fuel, fuel_low))
    np.testing.assert_allclose(run.longitude, model, atol=1e-9)
    np.testing.assert_allclose(run.fuel_longitude, fuel, atol=1e-9)
    assert not any("beyond the model grid" in text for text in run.warnings)


@pytest.mark.parametrize(
    ("axis", "reason"),
    [
        ([179.0, 180.0, -179.0, -180.0, -178.0], "value 4 is not beyond"),
        ([179.0, 180.0, -179.0, 180.5, 181.0], "value 3 is not beyond"),
        ([0.0, 100.0, 200.0, 300.0, 400.0], "more than once around"),
        ([179.0, 180.0, -180.0, -179.0, -178.0], "value 3 is not beyond"),
        ([10.0, 11.0, 9.0, 12.0, 13.0], "value 3 is not beyond"),
    ],
)
def test_longitudes_that_make_no_sense_are_refused(make_run, axis, reason):
    with pytest.raises(core.InputError, match=reason):
        east(make_run, axis, FUEL)


@pytest.mark.parametrize("axis", [[89.0, 90.0, -89.0, -88.0], [1.0, 2.0, 361.0, 4.0]])
def test_latitudes_never_turn(make_run, axis):
    with pytest.raises(core.InputError, match=r"not beyond|beyond 90"):
        runs.open(make_run(latitude=np.array(axis)))


@pytest.mark.parametrize("low", [-180, 0])
def test_a_place_is_found_across_the_antimeridian(make_run, low):
    """Cameras are given from -180 to 180, and the local frame gives no others back."""
    from firetwin.run import info
    from firetwin.shot.settings import Settings
    from firetwin.shot.terrain.terrain import Terrain

    shift = 180.0 - MODEL.mean()
    folder = make_run()
    run = runs.open(folder)
    plain = Terrain(Settings(), run, run.fuel_arrival_time())
    for name, axis in (("longitude", MODEL), ("fuel_longitude", FUEL)):
        np.save(folder / f"{name}.npy", folded(axis + shift, low))
    run = runs.open(folder)
    there = Terrain(Settings(), run, run.fuel_arrival_time())
    for longitude in FUEL[1:-1:3]:
        here = (longitude + shift + 180.0) % 360.0 - 180.0
        point, expected = there.point(38.904, here), plain.point(38.904, longitude)
        np.testing.assert_allclose(point, expected, atol=1e-5)
        np.testing.assert_allclose(there.up(*point[0, :2]), plain.up(*expected[0, :2]), atol=1e-4)
    assert "179.9920 E to 179.9920 W" in info.page(info.gather(run, "UTC"))
