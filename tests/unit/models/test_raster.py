"""Rasters of models are read in pieces, from their own file only."""

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run.models import raster

HEAD = "ncols {}\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 30\nNODATA_value -9999\n"
VRT = """\
<VRTDataset rasterXSize="2" rasterYSize="2"><GeoTransform>0, 1, 0, 0, 0, 1</GeoTransform>
<VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename>b.tif</SourceFilename></SimpleSource>
</VRTRasterBand></VRTDataset>"""


def test_pieces_of_an_ascii_grid(tmp_path, monkeypatch):
    path = tmp_path / "a.asc"
    values = np.arange(60.0).reshape(3, 20)
    rows = "".join(" ".join(map(str, row)) + "\n" for row in values)
    path.write_text(HEAD.format(20) + rows)
    monkeypatch.setattr(raster, "_PIECE", 150)
    np.testing.assert_array_equal(raster.read(path).values, values)
    path.write_text(HEAD.format(20) + rows.replace("45.0", "4x5"))
    with pytest.raises(InputError, match=r"a\.asc:9:26: '4x5' is not a number"):
        raster.read(path)
    path.write_text(HEAD.format(20) + rows + "1 " * 50)
    with pytest.raises(InputError, match="values where its head says 3 x 20"):
        raster.read(path)
    monkeypatch.setattr(raster, "_PIECE", 30)
    with pytest.raises(InputError, match="has a line of more than"):
        raster.read(path)


def test_an_ascii_grid_of_any_size_is_read_up_to_its_stated_values(tmp_path):
    path = tmp_path / "a.asc"
    path.write_text(HEAD.format(2))
    with path.open("r+b") as file:
        file.truncate(10 << 30)
    with pytest.raises(InputError, match="has a line of more than"):
        raster.read(path)


def test_a_raster_that_names_other_files_is_refused(tmp_path):
    pytest.importorskip("rasterio")
    (tmp_path / "a.bil").write_text(VRT)
    (tmp_path / "a.hdr").write_text("")
    assert raster.is_raster(tmp_path / "a.bil")
    with pytest.raises(InputError, match="cannot be read as a raster"):
        raster.read(tmp_path / "a.bil")


def test_the_size_of_a_raster_is_limited(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    size = {"width": 60_000, "height": 60_000, "count": 1, "dtype": "uint8", "sparse_ok": True}
    rasterio.open(tmp_path / "a.tif", "w", driver="GTiff", tiled=True, **size).close()
    for read in (raster.read, raster.read_bands):
        with pytest.raises(InputError, match="1 x 60000 x 60000 values, more than 2,147 MB"):
            read(tmp_path / "a.tif")
