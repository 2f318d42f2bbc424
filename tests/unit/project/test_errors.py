"""Readers of a user's files turn every exception into one line: file, fault and remedy."""

import errno
import importlib
import sqlite3
import zipfile

import pytest
from file_readers import READERS, write_files
from firetwin import errors, limits
from firetwin.errors import FullDiskError, InputError
from firetwin.run import observations

PLANTED = {
    sqlite3.OperationalError("disk I/O error"): "cannot be read as a GeoPackage: disk I/O error; export it",
    sqlite3.DatabaseError("malformed"): "cannot be read as a GeoPackage: malformed; export it",
    ValueError("odd"): "is damaged or incomplete: odd; export it",
    OverflowError("date value out of range"): "is damaged or incomplete: date value out of range; export it",
    KeyError("k"): "is damaged or incomplete: 'k'; export it",
    AssertionError(): "is damaged or incomplete: AssertionError; export it",
    RecursionError("maximum recursion depth exceeded"): "nested too deeply; export it without nesting",
    MemoryError(): "does not fit into the memory; use a part",
    UnicodeDecodeError("utf-8", b"\xff", 0, 1, "invalid"): "is not UTF-8 text (byte 1); save it as UTF-8",
    PermissionError(errno.EACCES, "Permission denied"): "permission denied); change its permissions",
    OSError(errno.EROFS, "Read-only file system"): "cannot be read (read-only file system); copy it",
    OSError(errno.EIO, "Input/output error"): "cannot be read (input/output error); copy it",
    OSError(errno.ENOSPC, "No space left on device"): "the disk is full; free some space",
}


NAMED = ("NumPy archive", "netCDF file", "raster", "landscape (LCP)", "GeoTIFF")
"""Readers whose messages name the format."""


@pytest.fixture(scope="module")
def station_file(tmp_path_factory):
    """A station file, and one file for each of the other readers."""
    return write_files(tmp_path_factory.mktemp("files"))


@pytest.mark.parametrize("reader", READERS)
def test_what_a_reader_raises_becomes_one_line(reader, station_file, monkeypatch):
    read, target = READERS[reader]
    module, _, name = target.partition(":")
    owner, _, last = name.rpartition(".")
    holder = importlib.import_module(module)
    holder = getattr(holder, owner) if owner else holder
    for planted, text in PLANTED.items():
        if reader in NAMED:
            text = text.replace("is damaged or incomplete", f"cannot be read as a {reader}")

        def fail(*_args, error=planted, **_more):
            raise error

        with monkeypatch.context() as patch:
            patch.setattr(holder, last, fail)
            with pytest.raises(InputError) as caught:
                read(station_file)
        assert text in caught.value.reason
        assert caught.value.path.startswith(str(station_file.parent))
        assert "\n" not in str(caught.value)
        assert isinstance(caught.value, FullDiskError) == (getattr(planted, "errno", 0) == errno.ENOSPC)


@pytest.mark.parametrize("fault", [NameError, UnboundLocalError, ImportError, ModuleNotFoundError])
def test_faults_of_the_code_pass_a_reader(fault):
    with pytest.raises(fault), errors.reading("a.gpkg"):
        raise fault


def test_a_fault_that_names_its_file_is_a_sentence():
    with (
        pytest.raises(InputError, match="as a GeoTIFF: it is not recognized; export it again"),
        errors.reading("a.tif", "GeoTIFF"),
    ):
        raise ValueError("'a.tif' not recognized.")


def test_an_interruption_passes_a_reader():
    with pytest.raises(KeyboardInterrupt), errors.reading("a.gpkg"):
        raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("planted", "text"),
    [
        ("disk I/O error", "a.gpkg: the disk is full; free some space"),
        ("database or disk is full", "a.gpkg: the disk is full; free some space"),
        ("attempt to write a readonly database", "a.gpkg: cannot be written (attempt to write a readonly"),
        ("unable to open database file", "a.gpkg: cannot be written (unable to open database file); choose"),
    ],
)
def test_what_sqlite_raises_on_a_full_or_read_only_disk_becomes_one_line(planted, text, monkeypatch):
    monkeypatch.setattr(errors, "is_nearly_full", lambda _: True)
    with pytest.raises(InputError) as caught, errors.writing("a.gpkg"):
        raise sqlite3.OperationalError(planted)
    assert text in str(caught.value)


def test_a_short_text_of_many_values_is_refused_unread(tmp_path, monkeypatch):
    """Also within a KMZ."""
    monkeypatch.setattr(limits, "TEXT_VALUES", 100)
    texts = {"a.geojson": '{"type": "x"' + ",[1]" * 50 + "}", "a.kml": "<kml>" + "<a/>" * 100 + "</kml>"}
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    with zipfile.ZipFile(tmp_path / "a.kmz", "w") as archive:
        archive.writestr("a.kml", texts["a.kml"])
    for name, values in {"a.geojson": 101, "a.kml": 102, "a.kmz": r"10\d"}.items():
        with pytest.raises(InputError, match=rf"{name}: has about {values} numbers, .*; at most 100 are"):
            observations.features(tmp_path / name)


@pytest.mark.parametrize("reader", ["GeoJSON", "KML", "detections", "labels", "track"])
def test_a_text_that_is_too_large_is_refused_unread(reader, station_file, monkeypatch):
    monkeypatch.setattr(limits, "TEXT_BYTES", -1)
    with pytest.raises(InputError, match="MB; at most -0 MB are read: take a part of it"):
        READERS[reader][0](station_file)
