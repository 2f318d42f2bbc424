"""The command line as a person uses it: output, streams, and exit status."""

import contextlib
import ctypes
import io
import json
import os
import re
import subprocess
import sys
import traceback
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from types import SimpleNamespace

import doors
import numpy as np
import pytest
from few_cameras import *  # noqa: F403
from firetwin import cli
from firetwin.farm import command as farm
from firetwin.shot import passes
from firetwin.shot.settings import scene_file
from small_run import RUN_TOML, small_fields

COMMANDS = ["sample", "info", "new", "maps", "score", "imager", "build", "bake", "render", "schema", "bench"]


def firetwin(*arguments, cwd="."):
    """Run the command in this process; its result has .returncode, .stdout and .stderr."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), contextlib.chdir(cwd):
        try:
            status = cli.main([*map(str, arguments)])
        except SystemExit as end:
            status = end.code or 0
        except Exception:  # with --debug
            traceback.print_exc()
            status = 1
    return SimpleNamespace(returncode=status, stdout=out.getvalue(), stderr=err.getvalue())


def test_the_help_of_render_divides_names_of_passes_from_their_texts():
    lines = firetwin("render", "--help").stdout.splitlines()
    assert not [name for name in passes.helps() if not any(each.startswith(f"  {name} ") for each in lines)]


def assert_one_line(result, status, *words):
    assert result.returncode == status
    assert result.stdout == ""
    lines = [line for line in result.stderr.splitlines() if not line.startswith("firetwin: reading ")]
    assert len(lines) == 1, result.stderr
    assert lines[0].startswith("firetwin: ")
    assert all(word in lines[0] for word in words), lines[0]


def test_help_names_every_command():
    """In a process, as a person runs it."""
    command = [sys.executable, "-m", "firetwin", "--help"]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 0
    assert all(f"    {name}  " in result.stdout for name in COMMANDS)
    assert result.stderr == ""


TIMES = [
    (name, action.option_strings[-1], action.nargs or 1)
    for name, parser in doors.verbs().items()
    for action in parser._actions
    if action.metavar in ("TIME", "DAY")
]


@pytest.mark.parametrize("text", ["0001-01-01T00:00+14:00", "9999-12-31T23:59-12:00"])
@pytest.mark.parametrize(("name", "option", "count"), TIMES)
def test_each_time_of_a_command_is_in_the_years_of_runs(name, option, count, text, tmp_path):
    (tmp_path / "model").mkdir()
    (tmp_path / "model" / "fire.nc").touch()
    text = text[:10] if name == "stations import" else text
    full = ["model", "--out", "out"] if name in ("convert", "watch") else []
    result = firetwin(*name.split(), *full, option, *[text] * count, cwd=tmp_path)
    *_, last = result.stderr.splitlines()
    assert result.returncode == 2
    assert last.startswith("firetwin")
    assert text in last
    assert "in the years 1000 to 9998" in last


def test_help_and_mistakes_load_nothing_heavy():
    code = """
import sys
from firetwin.cli import main
for line in (["--help"], ["render", "--help"], ["nonsense"], []):
    try:
        main(line)
    except SystemExit:
        pass
heavy = {"bpy", "numpy", "matplotlib", "firetwin_core", "tqdm"} & set(sys.modules)
sys.exit(f"loaded {heavy}" if heavy else 0)
"""
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


def test_maps_without_matplotlib_say_what_to_install(make_run, tmp_path):
    code = """
import sys
from firetwin.cli import main
sys.modules["matplotlib"] = None  # as inside Blender
sys.exit(main(["maps", *sys.argv[1:]]))
"""
    command = [sys.executable, "-c", code, str(make_run()), "--out", str(tmp_path / "maps")]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 1
    *_, last = result.stderr.splitlines()
    assert last.startswith("firetwin: maps and plots need matplotlib")
    assert last.endswith(f"{sys.executable} -m pip install matplotlib numpy=={np.__version__}")
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize("command", [*COMMANDS, *(f"farm {verb}" for verb in farm.VERBS)])
def test_every_command_explains_itself(command):
    result = firetwin(*command.split(), "--help")
    assert result.returncode == 0
    assert result.stdout.startswith(f"usage: firetwin {command} ")
    assert "--debug" in result.stdout


@pytest.mark.parametrize(
    "line",
    [
        [],
        ["nonsense"],
        ["info"],
        ["render", "x.toml"],
        ["new", "run"],
        ["sample", "x", "--frames", "0"],
        ["info", "x", "--jsn"],
    ],
)
def test_bad_usage_is_2(line):
    result = firetwin(*line)
    assert result.returncode == 2
    assert result.stdout == ""
    assert "usage: firetwin" in result.stderr


def test_the_exit_status_is_that_of_the_command():
    command = [sys.executable, "-m", "firetwin", "info", "no such run"]
    result = subprocess.run(command, capture_output=True, text=True)
    assert_one_line(result, 1, "no such run")


@pytest.mark.parametrize(
    "line",
    [
        ["render", "x.toml", "--out", "film", "--camera", ""],
        ["render", "x.toml", "--out", ""],
        ["build", "x.toml", "-o", "x.blend", "--run", " "],
        ["track", "x.toml", "--out", "x.gpx", "--camera", ""],
        ["info", ""],
        ["imager", "x", "--out", "y", "--longitude", "nan"],
        ["imager", "x", "--out", "y", "--longitude", "1e22"],
        ["render", "x.toml", "\x1b[31m\n", "--out", "film"],
    ],
)
def test_arguments_that_name_nothing_are_bad_usage(line, capfd):
    with pytest.raises(SystemExit) as caught:
        cli.main(line)
    assert caught.value.code == 2
    *_, last = capfd.readouterr().err.splitlines()
    assert last.startswith(
        f"firetwin {line[0]}: error: " if "\x1b[31m\n" not in line else "firetwin: error: "
    )
    assert last.isprintable()


def test_what_a_file_holds_moves_no_cursor(make_run, tmp_path, capfd):
    """Keys, values and names with ESC, C1, line breaks and what turns text round."""
    scene, hostile = tmp_path / "scene.toml", r"a\u001b[31m\nb\u009b\u202e"
    for text in (f'"{hostile}" = 1', f'[render]\nengine = "{hostile}"', f'run = "{hostile}"'):
        scene.write_text(text + "\n")
        assert cli.main(["track", str(scene), "--out", str(tmp_path / "x.gpx")]) == 1
        said = capfd.readouterr().err
        assert said.removesuffix("\n").isprintable(), said
        assert "a\\x1b[31m" in said
    folder = make_run(toml=RUN_TOML.replace('"Small"', f'"{hostile}"'))
    assert cli.main(["info", str(folder)]) == 0
    assert all(line.isprintable() for line in capfd.readouterr().out.split("\n"))


def test_pictures_do_not_go_into_a_run(make_run, tmp_path, capfd):
    """A camera called heat_flux would add a field of that name."""
    folder = make_run()
    before = sorted(folder.rglob("*"))
    scene = tmp_path / "scene.toml"
    scene.write_text('run = "run"\n[[cameras]]\nname = "heat_flux"\nkind = "satellite"\n')
    assert cli.main(["render", str(scene), "--out", str(folder)]) == 2
    assert "is a run folder" in capfd.readouterr().err
    assert sorted(folder.rglob("*")) == before


def test_an_imager_says_what_is_in_its_way(make_run, tmp_path, capfd):
    """A domain smaller than a pixel is not blamed on the satellite's longitude."""
    folder, out = make_run(), tmp_path / "seen"
    assert cli.main(["imager", str(folder), "--out", str(out)]) == 1
    assert f"{folder}: the domain of the run contains no complete pixel" in (said := capfd.readouterr().err)
    assert "--instrument viirs" in said
    assert "--longitude" not in said
    assert cli.main(["imager", str(folder), "--out", str(out), "--longitude", "30"]) == 2
    assert "--longitude: the run is behind the horizon" in capfd.readouterr().err
    axes = small_fields()
    wide = {
        f"{kind}{name}": 38.9 + 0.02 * np.arange(len(axes[f"{kind}{name}"]))
        for kind in ("", "fuel_")
        for name in ("latitude", "longitude")
    }
    for name, values in wide.items():
        np.save(folder / f"{name}.npy", values - (159.5 if name.endswith("longitude") else 0.0))
    out.write_text("a file")
    assert cli.main(["imager", str(folder), "--instrument", "viirs", "--out", str(out / "deeper")]) == 1
    assert f"firetwin: {out / 'deeper' / 'viirs_'}" in (said := capfd.readouterr().err.splitlines()[-1])
    reason = "Not a directory" if os.name == "posix" else ".*"
    assert re.search(rf"cannot be written \({reason}\); choose another folder$", said)


def test_versions():
    result = firetwin("--version")
    assert result.returncode == 0
    assert result.stdout.startswith("firetwin 0")


def test_info_as_a_page_and_as_json(make_run):
    folder = make_run()
    page = firetwin("info", folder)
    assert (page.returncode, page.stderr) == (0, "")
    assert page.stdout.startswith("Small  (SYNTHETIC")
    facts = json.loads(firetwin("info", folder, "--json").stdout)
    assert facts["times"]["count"] == 3


@pytest.mark.usefixtures("few_cameras")
def test_new_writes_a_scene_file_says_what_it_chose_and_overwrites_nothing(make_run, tmp_path):
    folder, out = make_run(), tmp_path / "scene.toml"
    result = firetwin("new", folder, "-o", out)
    assert (result.returncode, result.stdout) == (0, f"{out}\n"), result.stderr
    assert all(f"firetwin: {name}: " in result.stderr for name in ("overview", "chase", "flank", "satellite"))
    assert "most active" in result.stderr
    assert scene_file.read(out).run.resolve() == folder.resolve()
    out.write_text("mine")
    again = firetwin("new", folder, "-o", out)
    assert_one_line(again, 1, "scene.toml: has changed since Firetwin wrote it", "--overwrite")
    assert out.read_text() == "mine"


@pytest.mark.usefixtures("few_cameras")
def test_new_films_the_moments_that_are_asked_for(make_run, tmp_path):
    folder, out = make_run(), tmp_path / "scene.toml"
    moments = "2014-09-16T21:45:30-07:00", "2014-09-16T21:46:30-07:00"
    out.write_text("mine")
    result = firetwin("new", folder, "-o", out, "--start", moments[0], "--end", moments[1], "--overwrite")
    assert result.returncode == 0, result.stderr
    found = scene_file.read(out).time
    assert (found.start, found.end) == tuple(map(datetime.fromisoformat, moments))
    late = firetwin("new", folder, "-o", tmp_path / "x.toml", "--end", "2015-01-01T00:00Z")
    assert_one_line(late, 2, "--end", "2014-09-17T04:47:00Z")
    bad = firetwin("new", folder, "-o", tmp_path / "x.toml", "--start", "2014-09-16T21:45")
    assert bad.returncode == 2
    assert "with its zone" in bad.stderr


@pytest.mark.usefixtures("few_cameras")
def test_a_run_folder_stands_for_a_scene_file_that_fits_it(make_run, tmp_path):
    """The scene file of `new` is written into the cache, and used."""
    folder = make_run()
    result = firetwin("track", folder, "--camera", "chase", "--out", "way.gpx", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "<trkpt" in (tmp_path / "way.gpx").read_text()
    assert "firetwin new " in result.stderr
    (kept,) = (tmp_path / "cache").glob("run-*.toml")
    assert firetwin("new", folder, "-o", "scene.toml", cwd=tmp_path).returncode == 0
    found, written = scene_file.read(kept), scene_file.read(tmp_path / "scene.toml")
    assert found.cache.resolve() == written.cache.resolve() == tmp_path / "cache"
    assert found.run.resolve() == written.run.resolve() == folder
    assert replace(found, path=written.path, run=written.run, cache=written.cache) == written
    assert_one_line(firetwin("new", tmp_path, "-o", tmp_path / "x.toml"), 1, "run.toml")


def test_maps_say_where_they_are(make_run, tmp_path):
    result = firetwin("maps", make_run(), "--out", tmp_path / "maps")
    assert result.returncode == 0
    assert result.stdout.splitlines() == [
        str(tmp_path / "maps" / name) for name in ("fuel.png", "intensity.png")
    ]


# The four mistakes that everyone makes once.


def test_a_missing_run_and_a_missing_file(tmp_path, make_run):
    assert_one_line(firetwin("info", tmp_path / "none"), 1, str(tmp_path / "none"))
    folder = make_run()
    (folder / "elevation.npy").unlink()
    assert_one_line(firetwin("info", folder), 1, "elevation")


def test_a_malformed_number(make_run):
    folder = make_run("text")
    path = folder / "elevation.txt"
    lines = path.read_text().splitlines()
    lines[1] = " ".join(["1.5", "12x4", *lines[1].split()[2:]])
    path.write_text("\n".join(lines) + "\n")
    assert_one_line(firetwin("info", folder), 1, f"{path}:2:5")


def test_an_unknown_key_of_a_scene_file(tmp_path):
    (tmp_path / "scene.toml").write_text("[render]\nsample = 3\n")
    line = ("render", tmp_path / "scene.toml", "--out", tmp_path / "out")
    assert_one_line(firetwin(*line), 1, "scene.toml:2:1", 'did you mean "samples"?')
    assert not (tmp_path / "out").exists()
    with_debug = firetwin(*line, "--debug")
    assert with_debug.returncode == 1
    assert "Traceback" in with_debug.stderr


@pytest.fixture
def scene(make_run, tmp_path):
    """Write a scene file about the small run, with lines added."""
    run = make_run()

    def write(text=""):
        path = tmp_path / "scene.toml"
        camera = (
            '[[cameras]]\nname = "drone"\nkeys = [{latitude = 38.9, longitude = -120.6, target = "fire"}]\n'
        )
        path.write_text(f'run = "{run.as_posix()}"\n{text}\n{camera}')
        return path

    return write


@pytest.mark.parametrize(
    ("option", "words"),
    [
        (["--camera", "drown"], ["--camera", "drone"]),
        (["--frames", "0-3"], ["--frames", "1-48"]),
        (["--passes", "rbg"], ["--passes", "rgb"]),
    ],
)
def test_options_that_do_not_fit_the_scene_are_bad_usage(scene, tmp_path, option, words):
    assert_one_line(firetwin("render", scene(), "--out", tmp_path / "out", *option), 2, *words)


def test_frames_of_a_bake_select_volumes(scene):
    assert_one_line(firetwin("bake", scene(), "--frames", "1"), 2, "--frames", "add --volumes")
    assert_one_line(firetwin("bake", scene(), "--volumes", "--frames", "0-3"), 2, "--frames", "1-48")


def test_a_scene_must_fit_its_run(scene, tmp_path):
    late = scene("[time]\nend = 2015-01-01T00:00:00Z")
    assert_one_line(firetwin("bake", late), 1, "scene.toml:3:1", "outside of the run", "2014-09-17T04:47:00Z")
    path = scene()
    path.write_text(path.read_text().replace("38.9", "48.9"))
    assert_one_line(
        firetwin("build", path, "-o", tmp_path / "x.blend"), 1, "scene.toml:5:10", '"drone"', "110 km"
    )
    path.write_text(path.read_text().replace("48.9", "38.9").replace(', target = "fire"', ""))
    assert_one_line(firetwin("render", path, "--out", tmp_path / "out"), 1, '"drone" looks at')


def test_a_blend_file_must_be_named_so_and_its_folder_be_there(scene, tmp_path):
    assert_one_line(firetwin("build", scene(), "-o", tmp_path / "x.blnd"), 2, "x.blnd", ".blend")
    (tmp_path / "file").write_text("")
    assert_one_line(
        firetwin("build", scene(), "-o", tmp_path / "file" / "x.blend"), 1, str(tmp_path / "file")
    )


def test_a_reader_that_has_gone_is_no_traceback():
    """Close the pipe early, as `firetwin schema | head -1` does."""
    command = [sys.executable, "-m", "firetwin", "schema"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 1


@pytest.mark.parametrize(
    ("platform", "error", "has_gone"),
    [
        ("linux", BrokenPipeError(32, "Broken pipe"), True),
        ("win32", OSError(22, "Invalid argument"), True),
        ("win32", OSError(22, "Invalid argument", "a.png"), False),
        ("linux", OSError(22, "Invalid argument"), False),
    ],
)
def test_a_reader_that_has_gone_is_not_reported(monkeypatch, platform, error, has_gone):
    monkeypatch.setattr(sys, "platform", platform)
    assert cli._reader_has_gone(error) is has_gone


@pytest.mark.parametrize("names", [(), ("a.png",), ("a.png", None, "b.png")])
def test_a_full_disk_is_named_with_its_remedy(names, capsys):
    """A full disk under the output, such as a log file, has no name."""
    assert cli._report(OSError(28, "No space left on device", *names)) == 1
    found = capsys.readouterr().err
    assert "the disk is full; free some space" in found
    assert (names[-1] if names else "output or temporary files") in found


def test_names_of_files_reach_a_pipe_of_windows_whole(make_run, tmp_path, monkeypatch):
    """Its pipes have a code page, which lacks most letters."""
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="cp1252") for _ in range(2))
    run = make_run(toml=RUN_TOML.replace("Small", "火事 ü"))
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    assert cli.main(["info", str(run)]) == 0
    assert cli.main(["info", str(tmp_path / "火事 ü")]) == 1
    for stream in (out, err):
        stream.flush()
        assert "火事 ü" in stream.buffer.getvalue().decode()


@pytest.mark.parametrize("has_avx2", [True, False])
def test_windows_without_avx2_is_named_with_its_remedy(monkeypatch, has_avx2):
    kernel32 = SimpleNamespace(IsProcessorFeaturePresent=lambda number: has_avx2 and number == 40)
    monkeypatch.setattr(ctypes, "windll", SimpleNamespace(kernel32=kernel32), raising=False)
    monkeypatch.setattr(sys, "platform", "win32")
    code = Path(cli.__file__).with_name("__init__.py").read_text()
    with (
        contextlib.nullcontext()
        if has_avx2
        else pytest.raises(ImportError, match="needs a processor with AVX2")
    ):
        exec(compile(code, "firetwin", "exec"), {})
