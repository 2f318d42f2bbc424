"""Archives and arrays of others are unpacked within a limit, whatever sizes they state."""

import sys
import tracemalloc
import zipfile
import zlib

import numpy as np
import pytest
from firetwin import memory, unpacking
from firetwin.errors import InputError
from firetwin.forecasts.ensemble.readers import samples
from firetwin.run.models import zarr_store
from firetwin.run.observations import kml
from firetwin.run.readers import pyretechnics

MOST = 1 << 22
linux = pytest.mark.skipif(sys.platform != "linux", reason="limits the memory")


def bomb(path, *arrays, way=zipfile.ZIP_DEFLATED):
    """Write an archive whose members have four times the limit."""
    with zipfile.ZipFile(path, "w", way) as archive:
        for name in arrays:
            with archive.open(f"{name}.npy", "w") as file:
                np.lib.format.write_array(file, np.zeros(MOST // 2))
    return path


def header(path, shape):
    """Write an array whose header states a shape, without values."""
    with path.open("wb") as file:
        head = {"descr": "<f8", "fortran_order": False, "shape": shape}
        np.lib.format.write_array_header_1_0(file, head)
    return path


@pytest.fixture
def small(monkeypatch):
    """Set a small limit."""
    monkeypatch.setattr(unpacking.read_npz, "__defaults__", (None, None, MOST))
    monkeypatch.setattr(unpacking.read_npy, "__defaults__", (MOST,))


def read_within(read, path):
    """Read, and check that this takes little memory."""
    tracemalloc.start()
    try:
        return read(path)
    finally:
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < 3 * MOST


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize("read", [pyretechnics._arrays, lambda path: samples._archived(path, "x")])
def test_an_archive_that_grows_is_refused(read, tmp_path):
    with pytest.raises(InputError, match=r"a\.npz: x grows beyond .* MB when unpacked; take a part"):
        read_within(read, bomb(tmp_path / "a.npz", "x", "y"))


@pytest.mark.usefixtures("small")
def test_all_arrays_count_and_so_does_their_conversion(tmp_path):
    np.savez_compressed(tmp_path / "a.npz", x=np.zeros(MOST // 4, np.int8), y=np.zeros(MOST // 4, np.int8))
    assert unpacking.read_npz(tmp_path / "a.npz").keys() == {"x", "y"}
    with pytest.raises(InputError, match="x grows beyond"):
        unpacking.read_npz(tmp_path / "a.npz", dtype=np.float64)
    np.savez_compressed(tmp_path / "b.npz", x=np.zeros(MOST // 2, np.int8), y=np.zeros(MOST, np.int8))
    with pytest.raises(InputError, match="y grows beyond"):
        unpacking.read_npz(tmp_path / "b.npz")


@pytest.mark.usefixtures("small")
def test_an_array_by_itself_is_limited(tmp_path):
    with pytest.raises(InputError, match=r"a\.npy: grows beyond"):
        read_within(unpacking.read_npy, header(tmp_path / "a.npy", (1 << 40,)))
    with pytest.raises(InputError, match=r"b\.npy: "):
        unpacking.read_npy(header(tmp_path / "b.npy", (MOST // 16,)))


@pytest.mark.parametrize("way", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_ways_that_python_unpacks_without_a_limit_are_refused(way, tmp_path):
    path = bomb(tmp_path / "a.npz", "x", way=way)
    with pytest.raises(InputError, match="is compressed by method"):
        read_within(unpacking.read_npz, path)


def test_a_kmz_that_grows_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(kml.limits, "TEXT_BYTES", MOST)
    with zipfile.ZipFile(tmp_path / "a.kmz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("doc.kml", b" " * (MOST + 1))
    with pytest.raises(InputError, match=r"a\.kmz: doc\.kml grows beyond 4 MB"):
        read_within(kml.unpack_kmz, tmp_path / "a.kmz")


@linux
def test_a_chunk_that_grows_beyond_its_declared_size_is_refused(tmp_path, monkeypatch):
    zarr = pytest.importorskip("zarr")
    numcodecs = pytest.importorskip("numcodecs")
    monkeypatch.setattr(unpacking, "_ROOM", 1 << 26)
    monkeypatch.setattr(zarr_store, "_KEPT", 1 << 20)
    group = zarr.open_group(tmp_path / "a.zarr", mode="w", zarr_format=2)
    group.create_array("v", shape=(4,), chunks=(4,), dtype="f4", compressors=numcodecs.Zlib())[:] = 1.0
    file = zarr_store.ZarrFile(tmp_path / "a.zarr")
    assert file.read("v").sum() == 4.0
    (tmp_path / "a.zarr/v/0").write_bytes(zlib.compress(bytes(1 << 28), 1))
    with pytest.raises(InputError, match=r"a\.zarr: does not fit into the memory"):
        file.read("v")


@linux
def test_the_former_limit_returns(tmp_path):
    import resource

    before = resource.getrlimit(resource.RLIMIT_DATA)
    with pytest.raises(MemoryError), memory.limited(1 << 24):
        bytearray(1 << 28)
    assert resource.getrlimit(resource.RLIMIT_DATA) == before
    bytearray(1 << 28)
