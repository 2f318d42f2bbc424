"""An HDF5 file that refers to another file is refused; its reader would read any file of the user."""

import ctypes

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run.models import hdf5_links, netcdf

library = pytest.importorskip("netCDF4")
HID = ctypes.c_int64
SIZES = ctypes.c_uint64 * 1


@pytest.fixture
def hdf5():
    """Return the HDF5 library with functions that write, and a way to create property lists and types."""
    loaded = hdf5_links._library(library)
    if loaded is None:
        pytest.skip("this system does not show the HDF5 library of netCDF4")
    for name in ("H5Screate_simple", "H5Pcreate", "H5Dcreate2"):
        getattr(loaded, name).restype = HID
    return loaded


def write(path):
    with library.Dataset(path, "w") as file:
        file.createDimension("x", 4)
        file.createGroup("inner").createVariable("v", "f4", ("x",))[:] = 1.0
        file.createVariable("v", "f4", ("x",))[:] = 1.0


def change(hdf5, path, put):
    """Let `put` write into an HDF5 file."""
    file = hdf5.H5Fopen(str(path).encode(), 1, 0)
    put(HID(file))
    hdf5.H5Fclose(file)


def test_a_file_by_itself_is_read(tmp_path, hdf5):
    write(tmp_path / "a.nc")
    link = lambda file: hdf5.H5Lcreate_soft(b"/v", file, b"w", HID(0), HID(0))  # noqa: E731
    change(hdf5, tmp_path / "a.nc", link)
    assert netcdf.File(tmp_path / "a.nc").read("v").tolist() == [1.0] * 4


@pytest.mark.parametrize("name", [b"w", b"inner/w"])
def test_a_link_to_another_file_is_refused(tmp_path, hdf5, name):
    write(tmp_path / "a.nc")
    write(tmp_path / "b.nc")
    link = lambda file: hdf5.H5Lcreate_external(b"b.nc", b"/v", file, name, HID(0), HID(0))  # noqa: E731
    change(hdf5, tmp_path / "a.nc", link)
    with pytest.raises(
        InputError, match=rf"a\.nc: {name.decode()} is a link to another file, which is not read"
    ):
        netcdf.File(tmp_path / "a.nc")


def test_values_in_another_file_are_refused(tmp_path, hdf5):
    write(tmp_path / "a.nc")
    np.arange(4, dtype=np.float32).tofile(tmp_path / "secret")

    def put(file):
        kind = HID.in_dll(hdf5, "H5P_CLS_DATASET_CREATE_ID_g")
        creation = HID(hdf5.H5Pcreate(kind))
        hdf5.H5Pset_external(
            creation, str(tmp_path / "secret").encode(), ctypes.c_int64(0), ctypes.c_uint64(16)
        )
        space = HID(hdf5.H5Screate_simple(1, SIZES(4), None))
        single = HID.in_dll(hdf5, "H5T_IEEE_F32LE_g")
        hdf5.H5Dclose(HID(hdf5.H5Dcreate2(file, b"raw", single, space, HID(0), creation, HID(0))))

    change(hdf5, tmp_path / "a.nc", put)
    with pytest.raises(InputError, match=r"a\.nc: raw has its values in another file, which is not read"):
        netcdf.File(tmp_path / "a.nc")


def test_a_file_that_is_not_hdf5_is_left_to_its_reader(tmp_path, capfd):
    (tmp_path / "a.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    hdf5_links.refuse(tmp_path / "a.nc", library)
    assert capfd.readouterr().err == ""
