"""Runs that are wrong: one clear error each, naming the file, the place and what to do."""

from pathlib import Path

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening as runs
from small_run import RUN_TOML, small_fields


def refuse(folder, file, reason, line=0, column=0):
    with pytest.raises(core.InputError, match=reason) as caught:
        runs.open(folder)
    error = caught.value
    assert Path(error.path).as_posix().endswith(file)
    assert (error.line, error.column) == (line, column)
    assert error.reason in str(error)
    assert "\n" not in str(error)


@pytest.mark.parametrize(
    ("old", "new", "line", "column", "reason"),
    [
        ("interval_s", "intervall_s", 3, 1, "unknown key 'intervall_s'; did you mean .interval_s."),
        ("event", "zzzzzzzzz", 7, 1, "unknown key 'zzzzzzzzz'; remove it"),
        ("interval_s = 60.0", "", 0, 0, "exactly one of interval_s"),
        ("interval_s = 60.0", "interval_s = 60\ntimes_s = [0]", 3, 1, "exactly one of interval_s"),
        ("= 60.0", "= 0", 3, 1, "above 0"),
        ("= 60.0", "= nan", 3, 1, "above 0"),
        ("= 60.0", '= "60"', 3, 1, "above 0"),
        ("interval_s = 60.0", "times_s = [0, 60, 60]", 3, 19, "strictly ascending"),
        ("interval_s = 60.0", "times_s = [0, 120, 60]", 3, 20, "sort the times"),
        ("interval_s = 60.0", "times_s = [0, 'x', 60]", 3, 15, "seconds since start"),
        ("interval_s = 60.0", "times_s = 60", 3, 1, "list"),
        ("interval_s = 60.0", "times_s = [0, 60]", 0, 0, "lists 2 times but heat_flux has 3"),
        ("60.0", "60.0\nmean_s = -1", 4, 1, "mean_s must be a number of seconds"),
        ("-07:00", "", 2, 1, "offset from UTC"),
        ("start = 2014-09-16T21:45:00-07:00", "start = 'noon'", 2, 1, "start must be a date"),
        ("start = 2014-09-16T21:45:00-07:00", "", 0, 0, "start must be a date .* add it"),
        ('"orthometric"', '"sea level"', 4, 1, "orthometric"),
        ("= true", "= 1", 6, 1, "true or false"),
        ('"Small"', "3", 1, 1, "name must be a text"),
        ("-9999.0", "'none'", 5, 1, "no_data must be a number"),
        ('"m"', '"ft"', 10, 1, "elevation is in 'ft' but must be in 'm'"),
        ("elevation", "elevatoin", 10, 1, "unknown field 'elevatoin'; did you mean .elevation."),
        ('"m"', "1", 10, 1, "text in quotes"),
        ('"Small"', '"Small', 1, 14, "not valid TOML"),
    ],
)
def test_run_toml(make_run, old, new, line, column, reason):
    assert old in RUN_TOML
    refuse(make_run(toml=RUN_TOML.replace(old, new)), "run.toml", reason, line, column)


def test_no_run_toml(make_run):
    folder = make_run()
    (folder / "run.toml").unlink()
    refuse(folder, "run.toml", "the file is missing")


def test_no_folder(tmp_path):
    refuse(tmp_path / "none", "none", "no such run folder")
    (tmp_path / "file").write_text("")
    refuse(tmp_path / "file", "file", "not a folder")


@pytest.mark.parametrize(
    ("fields", "file", "reason"),
    [
        ({"latitude": None}, "latitude.txt", "must hold latitude.txt or latitude.npy"),
        ({"canopy_fuel": None}, "canopy_fuel.txt", "must hold canopy_fuel.txt or canopy_fuel.npy"),
        ({"heat_flux": None}, "heat_flux", "must hold heat_flux.npy or heat_flux/000000.txt"),
        ({"wind_north": None}, "wind_north", "wind_east and wind_north"),
        ({"air_latitude": np.array([38.8, 39.0])}, "air_longitude.txt", "the field is missing"),
        ({"temperature": np.ones((2, 4, 5), "f4")}, "temperature", "has 2 times where heat_flux has 3"),
        ({"burned_fraction": np.ones((3, 4, 5), "f4")}, "burned_fraction.npy", r"shape \(times, 8, 10\)"),
    ],
)
def test_fields_that_are_missing_or_do_not_fit_each_other(make_run, fields, file, reason):
    refuse(make_run(**fields), file, reason)


def test_missing_frame(make_run):
    folder = make_run("text")
    (folder / "heat_flux" / "000001.txt").unlink()
    refuse(folder, "heat_flux/000001.txt", "the file is missing")


def test_no_frames(make_run):
    folder = make_run("text", heat_flux=None)
    (folder / "heat_flux").mkdir()
    refuse(folder, "heat_flux/000000.txt", "the file is missing")


@pytest.mark.parametrize(
    ("name", "values", "reason"),
    [
        ("elevation", np.ones((4, 4), "f4"), "expected 4 rows of 5 values .* found 4 rows of 4 values"),
        ("elevation", np.ones((3, 5), "f4"), "found 3 rows of 5 values"),
        ("elevation", np.ones((5, 4), "f4"), "transpose it"),
        ("elevation", np.ones((4, 10), "f4"), "decimal commas"),
        ("surface_fuel", np.ones((4, 5), "f4"), "expected 8 rows of 10 values"),
        ("heat_flux", np.ones((3, 5, 4), "f4"), r"expected shape \(times, 4, 5\), found \(3, 5, 4\)"),
        ("heat_flux", np.ones((4, 5), "f4"), r"expected shape \(times, 4, 5\), found \(4, 5\)"),
        ("heat_flux", np.ones((0, 4, 5), "f4"), "expected shape"),
        ("latitude", np.ones((2, 2)), "one row or one column"),
        ("latitude", np.array([1.0, 2, 91, 92]), "value 3 is 91.0+, beyond 90 degrees.* swapped"),
        ("latitude", np.array([1.0, 2, np.nan, 4]), "value 3 is nan"),
        ("longitude", np.array([1.0, 2, np.inf, 4, 5]), "value 3 is inf"),
        ("longitude", np.array([5.0, 4, 4.5, 3, 2]), "value 3 is not beyond the one before"),
    ],
)
def test_wrong_sizes_and_axes(make_run, name, values, reason):
    refuse(make_run(**{name: values}), f"{name}.npy", reason)


def test_wrong_size_of_a_text_frame(make_run):
    folder = make_run("text")
    (folder / "heat_flux" / "000001.txt").write_text("1 2\n3 4\n")
    run = runs.open(folder)
    with pytest.raises(core.InputError, match="expected 4 rows of 5 values"):
        run.heat_flux(1)
    with pytest.raises(core.InputError, match=r"000001\.txt"):
        run.flux_range()


def test_malformed_number_in_a_field(make_run):
    folder = make_run("text")
    path = folder / "elevation.txt"
    lines = path.read_text().splitlines()
    lines[2] = "1 2 3 4,5.5.5 6"
    path.write_text("\n".join(lines))
    refuse(folder, "elevation.txt", "'5.5.5' is not a number", 3, 9)


def test_a_field_twice(make_run):
    folder = make_run("npy")
    (folder / "elevation.txt").write_text("1\n")
    refuse(folder, "elevation", "more than once")


def test_a_frame_twice(make_run):
    folder = make_run("text")
    np.save(folder / "heat_flux" / "000001.npy", np.zeros((4, 5), "f4"))
    refuse(folder, "heat_flux/000001", "exists as .txt and as .npy")


@pytest.mark.parametrize("name", ["run.toml", "elevation.npy"])
def test_links_that_leave_the_folder(make_run, tmp_path, name):
    folder = make_run()
    (folder / name).rename(tmp_path / name)
    (folder / name).symlink_to(tmp_path / name)
    refuse(folder, name, "outside the run folder")


def test_a_folder_of_frames_that_is_elsewhere(make_run, tmp_path):
    folder = make_run("text")
    (folder / "heat_flux").rename(tmp_path / "heat_flux")
    (folder / "heat_flux").symlink_to(tmp_path / "heat_flux")
    refuse(folder, "heat_flux", "outside the run folder")


def test_links_inside_the_folder_are_fine(make_run):
    folder = make_run()
    (folder / "elevation.npy").rename(folder / "ground.bin")
    (folder / "elevation.npy").symlink_to("ground.bin")
    np.testing.assert_array_equal(runs.open(folder).elevation, small_fields()["elevation"])


def test_a_broken_link(make_run):
    folder = make_run()
    (folder / "elevation.npy").unlink()
    (folder / "elevation.npy").symlink_to("nowhere")
    with pytest.raises(core.InputError, match="missing"):
        runs.open(folder)
