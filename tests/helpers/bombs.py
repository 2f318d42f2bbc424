"""Small files that grow without end when they are unpacked, parsed or queried, by suffix."""

import io
import shutil
import sqlite3
import struct
import zipfile
import zlib

import numpy as np
import pytest

SIZE = 3 << 30
"""Unpacked bytes of archives and pictures."""
_BLOCK = 1 << 26
_LAUGHS = '<!DOCTYPE a [<!ENTITY a0 "ha">{}]><a>&a40;</a>'.format(
    "".join(f'<!ENTITY a{number + 1} "&a{number};&a{number};">' for number in range(40))
)
_VIEW = """
ALTER TABLE {0} RENAME TO kept;
CREATE VIEW {0} AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT kept.* FROM n, kept;
"""


def write(path):
    """Write a bomb in place of a file; a GeoPackage needs the one next to it."""
    _WRITERS.get(path.suffix, _text)(path)


def _zeros():
    """Deflated zero bytes: a block that ends in a full flush may be repeated."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    block = packer.compress(bytes(_BLOCK)) + packer.flush(zlib.Z_FULL_FLUSH)
    return block * (SIZE // _BLOCK) + packer.flush()


def _npz(path):
    buffer, head = io.BytesIO(), io.BytesIO()
    about = {"descr": "<f8", "fortran_order": False, "shape": (SIZE // 8 - 16,)}
    np.lib.format.write_array_header_1_0(head, about)
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    first = packer.compress(head.getvalue()) + packer.flush(zlib.Z_FULL_FLUSH)
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("time_of_arrival.npy", first + _zeros())
    data = bytearray(buffer.getvalue())
    listed = data.rindex(b"PK\1\2")
    for method, size in ((8, 22), (listed + 10, listed + 24)):
        data[method : method + 2] = struct.pack("<H", zipfile.ZIP_DEFLATED)
        data[size : size + 4] = struct.pack("<I", SIZE)
    path.write_bytes(data)


def _png(path):
    head = struct.pack(">2I5B", 30_000, 30_000, 8, 2, 0, 0, 0)
    parts = (b"IHDR", head), (b"IDAT", b"\x78\xda" + _zeros()), (b"IEND", b"")
    chunks = (
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in parts
    )
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(chunks))


def _tif(path):
    rasterio = pytest.importorskip("rasterio")
    shape = {"width": 100_000, "height": 100_000, "count": 1, "dtype": "float32", "SPARSE_OK": True}
    path.unlink()
    with rasterio.open(path, "w", driver="GTiff", tiled=True, **shape):
        pass


def _netcdf(path):
    library = pytest.importorskip("netCDF4")
    with library.Dataset(path, "w") as file:
        file.createDimension("x", SIZE)
        file.createVariable("v", "f4", ("x",), zlib=True)


def _geopackage(path):
    if not path.stat().st_size:
        shutil.copyfile(path.with_name("a_stations.gpkg"), path)
    base = sqlite3.connect(path)
    (name,) = base.execute("SELECT table_name FROM gpkg_contents").fetchone()
    base.executescript(_VIEW.format(name))
    base.close()


def _grid(path):
    names = "ncols", "nrows", "xllcorner", "yllcorner", "cellsize", "NODATA_value"
    path.write_text("".join(f"{name} 1000000\n" for name in names))


def _shapes(path):
    head = struct.pack(">7i", 9994, 0, 0, 0, 0, 0, 2**30) + struct.pack("<2i8d", 1000, 5, *[0.0] * 8)
    record = struct.pack(">2i", 1, 2**29) + struct.pack("<i4d2i", 5, *[0.0] * 4, 2**31 - 1, 2**31 - 1)
    path.write_bytes(head + record)
    path.with_suffix(".prj").write_text("GEOGCS")


def _text(path):
    path.write_text("0," * 9_000_000)


def _values(path):
    path.write_text('{"type": [' + "0," * 21_000_000)


_WRITERS = {
    ".npz": _npz,
    ".png": _png,
    ".tif": _tif,
    ".nc": _netcdf,
    ".gpkg": _geopackage,
    ".asc": _grid,
    ".shp": _shapes,
    ".kml": lambda path: path.write_text(_LAUGHS),
    ".gpx": lambda path: path.write_text(_LAUGHS),
    ".json": _values,
    ".geojson": _values,
    ".toml": lambda path: path.write_text("a = [" + "0," * 9_000_000),
}
