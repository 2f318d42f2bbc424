"""Commands and Python of the pages run as they are written there, on a small run and made-up files.

`tests/helpers/shown_code.py` explains the marks of blocks and lines that do not run.
"""

import json
import os
import re
import shlex
import sys
from pathlib import Path

import pytest
import whole_run
from firetwin import cli
from firetwin.data import sample
from firetwin.render import store
from firetwin.render.picture import Picture, film
from firetwin.render.store import Store
from firetwin.run import content, readers
from shown_code import PROGRAM, ROOT, RUN, blocks

pytest.importorskip("scipy")

FILES = {
    "Fire_Stations.csv": "X,Y,Station_Name,Type\n-13413597.6,4707000.1,Exercise Station Alpha,Lookout\n",
    "county.csv": "X,Y,Station_Name\n-120.5,38.9,Exercise Station Bravo\n",
    "layer.geojson": '{"type": "Feature", "properties": {"Name": "Exercise Station Charlie"}, '
    '"geometry": {"type": "Point", "coordinates": [-120.6, 38.8]}}',
    "footprints.geojson": '{"type": "Feature", "properties": {"height": 6.0}, '
    '"geometry": {"type": "Polygon", "coordinates": [[[-120.6, 38.9], [-120.5998, 38.9], '
    "[-120.5998, 38.9002], [-120.6, 38.9]]]}}",
    "SCENE.toml": """\
run = "small"
time = { start = 2014-09-17T23:12:00Z, frames = 2 }
smoke = { enabled = false }
render = { resolution = [64, 36], samples = 1 }
[[cameras]]
name = "drone"
keys = [{ latitude = 38.9, longitude = -120.6, height = 150.0, target = "head" }]
""",
}
SCHEDULER = """\
#!{python}
import json, sys
with open({log!r}, "a") as log:
    log.write(json.dumps(sys.argv[1:]) + "\\n")
if "-o" in sys.argv:
    open(sys.argv[sys.argv.index("-o") + 1], "w").write('{{"id": "12"}}')
print({says!r})
"""
SAYS = {
    "sbatch": "7", "squeue": "", "scancel": "", "scontrol": "MaxArraySize = 1001", "qsub": "7[].server",
    "qrls": "", "condor_submit_dag": "1 job(s) submitted to cluster 7.", "deadline": "", "curl": "",
}  # fmt: skip
"""Programs of schedulers, and the words that each prints."""


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """The sample run with two output times, and a small run for the scene file."""
    folder = tmp_path_factory.mktemp("documented")
    sample.write(folder / "RUN", 2)
    whole_run.write(folder / "small", cell=60.0, cells=60, start="2014-09-17T23:00:00Z")
    return folder


@pytest.fixture
def folder(runs, tmp_path, monkeypatch):
    """Return a folder with the files that pages name, without films."""
    monkeypatch.chdir(tmp_path)
    for name in ("RUN", "small"):
        Path(name).symlink_to(runs / name)
    for name, text in FILES.items():
        Path(name).write_text(text)
    return tmp_path


@pytest.fixture
def calls(folder, monkeypatch):
    """Calls of schedulers and their clients, which record their arguments and do nothing."""
    log, programs = folder / "calls.txt", folder / "bin"
    programs.mkdir()
    for name, says in SAYS.items():
        (programs / name).write_text(SCHEDULER.format(python=sys.executable, log=str(log), says=says))
        (programs / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
    return lambda: [json.loads(line) for line in log.read_text().splitlines()]


def run_page(name, **more):
    """Run the commands of Firetwin on a page, some with more options; returns the words of each."""
    ran = []
    for block in blocks((ROOT / name).read_text("utf-8")):
        for line in block.lines() if block.is_shell else ():
            words = shlex.split(line, comments=True)
            assert PROGRAM.match(line), f"{name}: {line}: run it here, or mark it <!-- not run: REASON -->"
            words += more.get(words[1], [])
            assert cli.main(words[1:]) == 0, f"{name}: {line}"
            ran.append(words[1:])
    return ran


def finish(out, made_with=None):
    """Make up the finished pictures and the film of a render, with these inputs."""
    with Store(out, create=True) as opened:
        entries = {path: {"frame": k} for k in (1, 2) for path in Picture("drone", k, "rgb").files()}
        entries |= {film("drone", "rgb", "clean"): {"film": "clean"}}
        for path in entries:
            (opened.out / path).parent.mkdir(parents=True, exist_ok=True)
            (opened.out / path).write_bytes(path.encode())
            entries[path] |= {"camera": "drone", "pass": "rgb"} | store.describe(opened.out / path)
        about = {"film": "rgb", "kind": "clean", "fps": "24", "frames": [[1, ""], [2, ""]]}
        opened.add({"run": {}, "camera": "drone"} | about | (made_with or {}), entries)
        opened.export()


def test_the_commands_on_stations_run(folder, capsys):
    ran = run_page("docs/stations.md")
    assert {words[0] for words in ran} == {"allocate", "brief", "resources", "stations"}
    said = capsys.readouterr().out
    assert "Exercise: not operational advice" in said
    assert "stations   3" in said
    assert re.search(r"division [A-D], .*: contained at hour", said)
    assert "nearest feasible plan: " in said


def test_the_commands_on_the_briefing_page_run(folder):
    assert run_page("docs/brief.md")
    assert 'lang="en"' in Path("brief.html").read_text("utf-8")


def test_the_commands_on_forecasts_run(folder, capsys):
    ring = [[-120.7, 38.75], [-120.5, 38.75], [-120.5, 38.9], [-120.7, 38.9], [-120.7, 38.75]]
    seen = {"type": "Feature", "properties": {"time": "2014-09-17T16:00:00Z"}}
    seen["geometry"] = {"type": "Polygon", "coordinates": [ring]}
    Path("perimeters.geojson").write_text(json.dumps(seen))
    assert {words[0] for words in run_page("docs/forecasts.md")} >= {"sample", "info", "brief", "score"}
    assert "20 of 20 members, issued 16 Sep 2014 21:45 PDT" in capsys.readouterr().out
    assert "How sure the forecast is" in Path("page.html").read_text("utf-8")


def test_the_commands_on_data_sets_run(folder, capsys):
    text = (ROOT / "docs/datasets.md").read_text("utf-8")
    Path("PLAN.toml").write_text(next(each.code for each in blocks(text) if each.kind == "toml"))
    assert [words[0] for words in run_page("docs/datasets.md")] == ["dataset"]
    assert re.match(r"200 samples in \d+ scenes: about .*\nsplits by camera: ", capsys.readouterr().out)
    assert not Path("DIR").exists()


def test_the_commands_on_citing_run(folder, capsys):
    finish(folder / "FILM", {"run": content.inputs(readers.open(Path("small")), folder)})
    assert [words[0] for words in run_page("docs/citing.md")] == ["cite"] * 3
    assert Path("FILM/ro-crate-metadata.json").is_file()
    assert "synthetic" in capsys.readouterr().out


def test_the_commands_on_tiles_run(folder):
    assert run_page("docs/tiles.md")
    tileset = json.loads(Path("terrain_tiles/tileset.json").read_text())
    assert tileset["asset"]["version"] == "1.1"
    assert cli.main(["tiles", "info", "terrain_tiles"]) == 0


def test_the_commands_on_edits_and_deliveries_run(folder):
    finish(folder / "DIR")
    finish(folder / "FILM")
    assert [words[0] for words in run_page("docs/delivery.md")] == ["edit", "deliver"]
    assert all((folder / "DIR" / f"film.{ending}").is_file() for ending in ("otio", "xml", "edl"))
    assert (folder / "DIR/v001/drone/rgb/drone_rgb.1001.png").is_file()


def test_the_commands_on_exports_run(folder):
    ran = run_page("docs/export.md")
    assert {words[0] for words in ran} == {"export"}
    assert list(Path("DIR").glob("*.kmz"))


def test_the_commands_on_farms_run(folder, calls):
    ran = run_page("docs/farm.md")
    engines = {words[words.index("--engine") + 1] for words in ran if "--engine" in words}
    assert engines == {"slurm", "pbs", "htcondor", "deadline", "flamenco"}
    said = [" ".join(each) for each in calls()]
    for option in ("--partition=gpu", "-A PROJECT", "-maxjobs 50", "--farm-id FARM", "http://MANAGER:8080"):
        assert any(option in each for each in said), option
    assert ["7", "7"] in [each[:2] for each in calls()]  # cancelled


def test_the_commands_on_pipelines_run(folder):
    ran = run_page("docs/pipelines.md", sample=["--frames", "8"])
    assert [words[0] for words in ran] == ["sample", "info", "new", "gpu"]
    assert cli.main(["farm", "my_scene.toml", "--out", "film", "--engine", "openjd"]) == 0  # is valid


def test_the_command_on_installation_runs(capsys):
    with pytest.raises(SystemExit, match="0"):
        run_page("docs/install.md")
    assert re.fullmatch(r"firetwin \d+\.\d+\.\d+.*", capsys.readouterr().out.splitlines()[0])


def test_the_command_on_a_walk_runs(folder, capsys):
    assert [words[:3] for words in run_page("docs/walk.md")] == [["build", "SCENE.toml", "--live"]]
    assert Path("walk.blend").is_file()
    assert re.search(r"live scene: \d\.\d\d million triangles, 0 instances", capsys.readouterr().err)


def test_each_listed_page_is_run():
    named = set(re.findall(r'"docs/([a-z]+\.md)"', Path(__file__).read_text("utf-8")))
    assert named == set(RUN)


def test_the_python_on_the_core_runs(folder):
    Path("my_run").symlink_to("RUN")
    (block,) = (each for each in blocks((ROOT / "docs/api.md").read_text("utf-8")) if each.kind == "python")
    found = {}
    exec(compile("\n".join(block.lines()), "docs/api.md", "exec"), found)
    assert found["heat_flux"].shape == (144, 144)
