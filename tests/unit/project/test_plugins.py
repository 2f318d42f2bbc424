"""Plugins: one file adds a pass, a format, a reader or a source, in a copy of the package; ranks and text."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from firetwin import plugins

ROOT = Path(__file__).parents[3]

READER = """
NAME = "soot of one run"

def sniff(path):
    return path.suffix == ".soot"

def read(paths, options):
    return "one run"
"""

ENSEMBLE = """
NAME = "soot of members"

def sniff(paths):
    return paths[0].suffix == ".soot"

def read(paths, options, horizon):
    return "members"
"""

EXPORT = """
import firetwin.no_such_module_yet

FORMAT = {"title": "Soot", "help": "soot of a scene"}
"""

LABELS = """
FORMAT = {"help": "soot/: samples as soot"}

def write(set_folder, samples, out):
    (out / "labels.soot").write_text("soot")
"""

SOURCE = """
import numpy as np
from firetwin.smoke.sources import Source, VolumeLayer
from firetwin_core import volume

METHOD = "soot of a scene"

class Soot(Source):
    name = "soot"

    def voxels(self):
        return [50.0]

    def layers(self):
        return [VolumeLayer("smoke", 50.0, 50.0, 0.01)]

    def write(self, path, frame):
        return volume.write(path, {"density": np.full((2, 2, 2), 0.01 * frame)}, 50.0)

SOURCE = Soot
"""

PASS = """
from firetwin.shot.passes import DerivedPass

ORDER = 29
HELP = "Where soot is"
PASS = DerivedPass(files=("txt",), needs=("depth",))

def finish(files, needed, shot, camera, frame):
    files["txt"].write_text(f"soot of {needed['depth']}")
"""

ADDED = {
    "passes": PASS,
    "run/readers": READER,
    "forecasts/ensemble/readers": ENSEMBLE,
    "export": EXPORT,
    "dataset/formats": LABELS,
    "smoke/sources": SOURCE,
}

USE = """
import json, sys
from pathlib import Path
from firetwin.dataset import formats as labels
from firetwin.errors import InputError
from firetwin.export import formats as exports
from firetwin.run import readers
from firetwin.forecasts.ensemble import readers as ensembles
from firetwin.shot import passes
from firetwin.shot.sections import SmokeSettings, Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from firetwin.smoke import bake

folder = Path(sys.argv[1])
file, other = folder / "a.soot", folder / "a.txt"
for each in (file, other):
    each.write_text("soot")
try:
    readers.reader([other])
except InputError as error:
    unknown = str(error)
labels.write(folder, [], ["soot"])
settings = Settings(cache=folder / "cache", time=Time(frames=1), smoke=SmokeSettings(method="soot"))
for name in ("soot", "ash"):
    passes.finish(name, {"txt": folder / f"{name}.txt"}, {"depth": "depth"}, None, "drone", 1)
place = bake.bake(Shot(settings, readers.open(folder / "run")))
print(json.dumps({
    "foreign": [readers.foreign(each) for each in (file, other)],
    "listed": "soot of one run" in unknown,
    "run": readers.reader([file]).read([file], None),
    "ensemble": ensembles.read([file], None, 0.0),
    "export": exports.known()["soot"].title,
    "labels": ["soot" in labels.names("all"), (folder / "labels.soot").exists()],
    "passes": [name for name in passes.known() if name in ("masks", "soot", "ash", "thermal")],
    "help": list(passes.known()) == list(passes.helps()),
    "code": passes.code_files("ash"),
    "finished": (folder / "ash.txt").read_text() == (folder / "soot.txt").read_text() == "soot of depth",
    "smoke": [each.name for each in place.glob("*.vdb")],
}))
"""


def test_one_file_adds_a_pass_a_format_a_reader_or_a_source(tmp_path, make_run):
    copy = tmp_path / "copy" / "firetwin"
    shutil.copytree(ROOT / "addon", copy)
    (copy / "data").symlink_to(ROOT / "data")
    for place, text in ADDED.items():
        (copy / place / "soot.py").write_text(text)
    room = copy / "edit" / "passes"
    room.mkdir()
    (room / "__init__.py").touch()
    (room / "_helper.py").touch()
    (room / "ash.py").write_text(PASS)
    make_run()
    environment = os.environ | {"PYTHONPATH": str(copy.parent)}
    line = [sys.executable, "-c", USE, str(tmp_path)]
    done = subprocess.run(line, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) == {
        "foreign": [True, False],
        "listed": True,
        "run": "one run",
        "ensemble": "members",
        "export": "Soot",
        "labels": [True, True],
        "passes": ["masks", "soot", "ash", "thermal"],
        "help": True,
        "code": ["edit/passes/ash.py", "edit/passes/_helper.py", "imaging"],
        "finished": True,
        "smoke": ["smoke_000001.vdb"],
    }


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Make a package: `c` has the rank -1, `a` and `b` have none, and a helper that cannot be imported."""
    folder = tmp_path / "shelf"
    folder.mkdir()
    texts = {"__init__": "", "_helper": "raise ImportError", "a": "\nNAME = 'A'\n", "b": "\nNAME = 'B'\n"}
    texts["c"] = "ORDER = -1\nNAME = 'C'\n\ndef read(): ...\n"
    for name, text in texts.items():
        (folder / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    yield plugins.importlib.import_module("shelf")
    for name in [name for name in sys.modules if name.partition(".")[0] == "shelf"]:
        del sys.modules[name]


def test_a_rank_goes_before_the_name(package):
    folder = Path(package.__file__).parent
    assert list(plugins.declared(folder, "NAME").items()) == [("c", "C"), ("a", "A"), ("b", "B")]
    assert "shelf.c" not in sys.modules
    assert plugins.values("shelf", "NAME") == plugins.declared(folder, "NAME")
    assert list(plugins.modules("shelf")) == ["c", "a", "b"]
    assert list(plugins.modules("shelf", "read")) == ["c"]
    with pytest.raises(AttributeError):
        plugins.values("shelf", "SOURCE")
