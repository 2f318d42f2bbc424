"""Readers of a user's files refuse pipes, devices and links to them in one line, and do not wait for them.

``python tests/unit/project/test_odd_files.py`` prints a table of readers and files: seconds, memory, message.
"""

import itertools
import os
import shutil
import signal
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

sys.path.append(str(Path(__file__).parents[2] / "helpers"))
import bombs
from file_readers import READERS, write_files
from firetwin import memory
from firetwin.data import sample
from firetwin.dataset import finish, truth
from firetwin.errors import Error
from firetwin.escaped import escaped
from firetwin.farm import entries, submission
from firetwin.growing import known_run, model_log, watched
from firetwin.jobs import assets, convert
from firetwin.render import manifest
from firetwin.run.models import grib2, raster
from firetwin.shot.settings import Settings, toml_update
from firetwin.story import story_file

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="forks, and limits the memory")

SECONDS = 6  # after which a reader counts as one that waits
MEMORY = 1 << 30  # bytes that a reader may use in addition
FILES = {
    "GeoJSON": "a.geojson",
    "KML": "a.kml",
    "GeoPackage": "a.gpkg",
    "shapefile": "a.shp",
    "detections": "a.csv",
    "station file": "a_stations.gpkg",
    "import": "a_stations.gpkg",
    "labels": "l.csv",
    "track": "t.gpx",
    "scene file": "s.toml",
    "run folder": "run.toml",
    "model": "a.npz",
    "NumPy archive": "a.npz",
    "netCDF file": "a.nc",
    "raster": "a.asc",
    "landscape (LCP)": "a_stations.gpkg",
    "GeoTIFF": "a.tif",
    "orthophoto": "a.png",
    "world file": "a.pgw",
    "globe": "a.png",
    "hashed file": "a_stations.gpkg",
    "tileset": "tileset.json",
}
"""File of each reader of `test_errors`."""


def _known_run(path):
    run = SimpleNamespace(path=path.parent, times=np.zeros(1), has=lambda _: False)
    known_run.write(run, 1, 0.0, path.parent / "known", "")


MORE = {
    "manifest": ("manifest.json", lambda path: manifest.read(path.parent)),
    "metadata of a sample": ("meta/000001.json", lambda path: truth.read(path.parent.parent, 1)),
    "samples": ("meta/000002.json", lambda path: finish.read_samples(path.parent.parent)),
    "model's log": (model_log.NAME, lambda path: model_log.read(path.parent)),
    "times of a watch": (watched.TIMES, lambda path: watched.times(path.parent)),
    "state of a watch": (watched.STATUS, lambda path: watched.status(path.parent)),
    "projection of a shapefile": ("a.prj", READERS["shapefile"][0]),
    "projection of a raster": ("a.prj", lambda path: raster._prj(path)),
    "conversion before": ("run.toml", lambda path: convert._made_of(path.parent)),
    "known run": ("run.toml", _known_run),
    "sample before": ("run.toml", lambda path: sample._refuse_strangers(path.parent)),
    "storyboard": ("story.toml", story_file.read),
    "asset catalogue": (assets.CATALOGUE, lambda path: assets._refuse_strangers(path.parent)),
    "saved scene file": ("s.toml", lambda path: toml_update.save(Settings(path=path))),
    "attempt of a farm": ("farm/entries/00001-a.jsonl", lambda path: entries.attempts(path.parents[2])),
    "submission": ("farm/submitted.json", lambda path: submission.last_submission(path.parents[1])),
    "forecast": ("a.grib2", lambda path: grib2.read([path], {"MASSDEN"}, (), (0.0, 0.0, 1.0, 1.0))),
}
SILENT = {"model's log", "state of a watch", "conversion before"}
"""Readers that take an odd file for a missing one."""
WRITTEN = {"asset catalogue"}
"""Files that are written if they cannot be found."""
ODD = {
    "pipe": os.mkfifo,
    "device": lambda path: path.symlink_to("/dev/zero"),
    "loop": lambda path: path.symlink_to(path.name) if path.suffix != ".nc" else os.mkfifo(path),
}


def extend(path):
    """Make a file a sparse one of 10 GB."""
    with path.open("ab") as file:
        file.truncate(10 << 30)


LARGE = {
    "10 GB": extend,
    "nested JSON": lambda path: path.write_text("[" * 100_000),
    "nested TOML": lambda path: path.write_text("a = " + "[" * 100_000),
    "damaged": lambda path: path.write_bytes(b"\0\xff" * 1000),
    "bomb": bombs.write,
}
REGULAR = "regular"
HASHED = {("hashed file", "10 GB")}
"""A file that is only hashed is read completely, in pieces."""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return write_files(tmp_path_factory.mktemp("files")).parent


def in_child(work):
    """Run a reader with little memory and time; return 0: it refused, 1: it read, 2: it failed."""
    child = os.fork()
    if child == 0:
        import resource  # not on Windows

        status = 2
        try:
            signal.alarm(SECONDS)
            size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (size + MEMORY, size + MEMORY))
            work()
            status = 1
        except Error as error:
            status = 0 if "\n" not in str(error) else 3
        finally:
            os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def test_every_reader_has_its_file():
    assert READERS.keys() - FILES.keys() == {"model's folder", "model's field"}


@pytest.mark.parametrize("kind", ODD)
@pytest.mark.parametrize("reader", [*FILES, *MORE])
def test_odd_files_are_refused_in_one_line(reader, kind, files, tmp_path):
    work = prepare(reader, kind, files, tmp_path)
    is_missing = reader in SILENT or (kind == "loop" and reader in WRITTEN)
    assert in_child(work) == is_missing


@pytest.mark.parametrize("kind", LARGE)
@pytest.mark.parametrize("reader", [*FILES, *MORE])
def test_large_and_damaged_files_are_read_or_refused_in_one_line(reader, kind, files, tmp_path):
    if (reader, kind) not in HASHED:
        assert in_child(prepare(reader, kind, files, tmp_path)) in (0, 1)


def prepare(reader, kind, files, tmp_path):
    """Return the call of a reader on a file of a kind."""
    folder = tmp_path / "files"
    shutil.copytree(files, folder)
    name, read = MORE[reader] if reader in MORE else (FILES[reader], READERS[reader][0])
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    if kind in ODD:
        path.unlink(missing_ok=True)
    if kind != REGULAR:
        (ODD | LARGE)[kind](path)
    elif not path.exists():
        path.write_text("{}")
    given = path if reader in MORE else folder / "a_stations.gpkg"
    return lambda: read(given)


def measure(work):
    """Run a reader in a child; return seconds, peak memory in MB, and the message."""
    reading, writing = os.pipe()
    start = time.perf_counter()
    child = os.fork()
    if child == 0:
        signal.alarm(10 * SECONDS)
        message = "is read"
        try:
            work()
        except Exception as error:
            message = str(error) if isinstance(error, Error) else f"RAW {error!r}"
        os.write(writing, f"{memory.peak() // 10**6}\n{message[:300]}".encode())
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8") as pipe:
        peak, _, message = pipe.read().partition("\n")
    os.waitpid(child, 0)
    return time.perf_counter() - start, peak or "?", message or "RAW ended without an answer"


def print_table():
    """Print a line for each reader and kind of file."""
    with tempfile.TemporaryDirectory() as name:
        files = write_files(Path(name)).parent
        for reader, kind in itertools.product([*FILES, *MORE], (REGULAR, *ODD, *LARGE)):
            with tempfile.TemporaryDirectory() as other:
                seconds, peak, message = measure(prepare(reader, kind, files, Path(other)))
                shown = escaped(message.replace(f"{other}/files/", "").replace("\n", " | "))
            print(f"{reader:22} {kind:12} {seconds:6.1f} s {peak:>5} MB  {shown}", flush=True)


if __name__ == "__main__":
    print_table()
