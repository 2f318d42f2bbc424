"""Hostile and odd inputs: each has one defined outcome, and none ends the process.

Rejections of single readers are in test_text, test_npy and test_run_errors.
"""

import os
from pathlib import Path

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin_core.flux import at_time, emitters
from small_run import NT, NX, NY, RUN_TOML, small_fields

START = "start = 2014-09-16T21:45:00-07:00"
JUNK = {
    "zeros": bytes(512),
    "random": np.random.default_rng(3).bytes(512),
    "png": b"\x89PNG\r\n\x1a\n" + bytes(64),
    "zip": b"PK\x03\x04" + bytes(64),
    "hdf5": b"\x89HDF\r\n\x1a\n" + bytes(64),
    "gzip": b"\x1f\x8b\x08" + bytes(64),
    "utf-16": "1 2\n3 4\n".encode("utf-16"),
    "html": b"<!DOCTYPE html>\n<p>404</p>\n",
}


def refusal(folder: Path) -> core.InputError:
    with pytest.raises(core.InputError) as caught:
        runs.open(folder)
    error = caught.value
    assert error.path
    assert error.reason in str(error)
    assert len(str(error)) < 2000
    assert str(error).isprintable()
    return error


def flux_run(make_run, flux: np.ndarray) -> runs.Run:
    none = dict.fromkeys(("temperature", "wind_east", "wind_north"))
    return runs.open(make_run(heat_flux=flux, **none))


@pytest.mark.parametrize("name", JUNK)
@pytest.mark.parametrize(
    "file", ["run.toml", "latitude.txt", "elevation.txt", "heat_flux/000000.txt", "heat_flux.npy"]
)
def test_junk_in_place_of_a_file(make_run, file, name):
    folder = make_run("npy" if file.endswith(".npy") else "text")
    (folder / file).write_bytes(JUNK[name])
    if "/" not in file:
        assert refusal(folder).path.endswith(file)
        return
    run = runs.open(folder)  # frames stay on disk until they are needed
    with pytest.raises(core.InputError, match=r"000000\.txt"):
        run.heat_flux(0)


@pytest.mark.parametrize(
    ("toml", "line", "reason"),
    [
        ("a" + ".a" * 100_000 + " = 1\n", 1, "more than eight parts"),
        ("[" + "a." * 100_000 + "a]\n", 1, "more than eight parts"),
        ('"=".' * 100_000 + "a = 1\n", 1, "more than eight parts"),
        ('name = """\n""" # \'\'\'\na.a.a.a.a.a.a.a.a = 1\n', 3, "more than eight parts"),
        ("a = " + "[" * 100_000, 1, "not valid TOML"),
        ("a = " + "{a=" * 100_000, 1, "not valid TOML"),
        ("start = 2014-09-16TW\n", 1, "not valid TOML"),
        ("start = 2014-09-1\u026b\n", 1, "not valid TOML"),
        ('name = """a\\\n \u00b2"""\n', 0, "start must be a date"),
        ("start = 2014-02-30T00:00:00Z\n", 1, "not valid TOML"),
        ("start = 2014-09-16T24:00:00Z\n", 1, "not valid TOML"),
        ('"two\\nlines" = 1\n', 1, r"unknown key 'two\\nlines'"),
        ('"\\u001b[31m" = 1\n', 1, r"unknown key '\\x1b\[31m'"),
        ('"' + "k" * 100_000 + '" = 1\n', 1, r"unknown key 'kkk.*\.\.\.'; remove"),
        (f"{START}\ninterval_s = 1e308\n", 0, "interval_s is so long"),
        (f"{START}\ninterval_s = -60\n", 2, "above 0"),
        (f"{START}\ntimes_s = []\n", 2, "strictly ascending"),
        (f"{START}\ntimes_s = [0, nan, 1]\n", 2, "strictly ascending"),
        (f"{START}\ntimes_s = [{', '.join(map(str, range(100_000)))}]\n", 0, "lists 100000 times"),
        (f"{START}\ninterval_s = 60\nno_data = inf\n", 3, "no_data must be a number"),
        (f"{START}\ninterval_s = 60\n[units.heat_flux]\nx = 1\n", 3, "a unit must be a text"),
        (f"{START}\ninterval_s = 60\nunits = []\n", 3, "units must be a table"),
    ],
)
def test_hostile_run_toml(make_run, toml, line, reason):
    error = refusal(make_run(toml=toml))
    assert error.line == line
    with pytest.raises(core.InputError, match=reason):
        raise error


def test_text_of_other_languages_stays(make_run):
    toml = RUN_TOML.replace('"Small"', '"""Feuer \u00b2 \u026b \U0001f525"""').replace("W/m2", "W/m\u00b2")
    assert runs.open(make_run(toml=toml)).name == "Feuer \u00b2 \u026b \U0001f525"


def test_a_dotted_name_is_no_key(make_run):
    toml = RUN_TOML.replace('"Small"', '"' + "a." * 100 + '" # ' + "b." * 100)
    assert runs.open(make_run(toml=toml)).name == "a." * 100


@pytest.mark.parametrize("kind", ["pipe", "folder", "zero", "loop"])
@pytest.mark.parametrize("name", ["run.toml", "elevation.npy", "heat_flux.npy"])
def test_what_is_no_file(make_run, name, kind):
    folder = make_run()
    path = folder / name
    path.unlink()
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    else:
        path.symlink_to("/dev/zero" if kind == "zero" else name)
    assert refusal(folder).path


@pytest.mark.parametrize("name", ["run.toml", "elevation.txt"])
def test_a_file_too_large_is_refused_before_it_is_read(make_run, name):
    folder = make_run("text")
    with open(folder / name, "wb") as file:
        file.truncate(1 << 40)  # a hole: takes no space
    assert "more than the limit" in refusal(folder).reason


@pytest.mark.parametrize(
    ("values", "first", "last", "emitter_count", "invalid"),
    [
        (0.0, 0, 0, 0, 0),
        (-5.0, -5, -5, 0, 0),
        (7.0, 7, 7, NY * NX, 0),
        (2.0**66, 2.0**66, 2.0**66, NY * NX, 0),
        (np.float32(3.4028235e38), np.float32(3.4028235e38), np.float32(3.4028235e38), NY * NX, 0),
        (np.float32(1e-45), np.float32(1e-45), np.float32(1e-45), NY * NX, 0),
    ],
)
def test_runs_of_one_flux(make_run, values, first, last, emitter_count, invalid):
    run = flux_run(make_run, np.full((NT, NY, NX), values, np.float32))
    assert run.flux_range() == (first, last)
    made = emitters(run.heat_flux(0), np.zeros((NY, NX, 3)), *run.flux_range())
    assert (len(made), made.invalid) == (emitter_count, invalid)
    assert (made.intensity == 1).all()
    assert np.isfinite(at_time(run, 30.0)).all()


@pytest.mark.parametrize("longitude", [541.0, -541.0])
def test_longitudes_of_no_place(make_run, longitude):
    axis = longitude + 0.004 * np.arange(NX)
    assert "beyond 540 degrees" in refusal(make_run(longitude=axis)).reason


def test_no_cells():
    assert len(emitters(np.zeros((0, 4)), np.zeros((0, 4, 3)), 0, 1)) == 0


@pytest.mark.parametrize("name", ["elevation", "surface_fuel", "canopy_fuel", "fuel_arrival_time"])
def test_a_field_of_one_dimension_is_no_grid(make_run, name):
    """A grid of one row has as many values as an array without rows, which does not say which axis it is."""
    fields = small_fields() | {"fuel_arrival_time": np.zeros((8, 10), np.float32)}
    one = {k: v[..., :1, :] if v.ndim > 1 else v[:1] if "latitude" in k else v for k, v in fields.items()}
    flat = make_run(**(one | {name: one[name][0]}))
    error = refusal_of(flat)
    size = len(one[name][0])
    assert f"{name}.npy" in error
    assert f"has shape ({size},) where two dimensions are needed" in error


def refusal_of(folder):
    with pytest.raises(core.InputError) as caught:
        runs.open(folder).fuel_arrival_time()
    return str(caught.value)
