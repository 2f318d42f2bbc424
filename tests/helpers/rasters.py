"""GeoTIFFs for tests: a function of latitude and longitude in any projection."""

import numpy as np
import pytest
from small_run import FX, FY

rasterio = pytest.importorskip("rasterio")
warp = pytest.importorskip("rasterio.warp")

LATITUDE = 38.9 + 0.003 * (np.arange(FY) * 0.5 - 0.25)  # of the small run's fuel grid
LONGITUDE = -120.6 + 0.004 * (np.arange(FX) * 0.5 - 0.25)


def write_tiff(path, values, *, projection="EPSG:32610", step=10.0, box=None, unit=None, **more):
    """`values` (latitude, longitude) -> height, or several bands, over a box of west, south, east, north."""
    west, south, east, north = box or (-120.62, 38.88, -120.56, 38.93)
    left, low, right, high = warp.transform_bounds("EPSG:4326", projection, west, south, east, north)
    size = int((right - left) / step), int((high - low) / step)
    transform = rasterio.transform.from_origin(left, high, step, step)
    x, y = np.meshgrid(left + (np.arange(size[0]) + 0.5) * step, high - (np.arange(size[1]) + 0.5) * step)
    longitude, latitude = warp.transform(projection, "EPSG:4326", x.ravel(), y.ravel())
    bands = np.asarray(values(np.array(latitude).reshape(x.shape), np.array(longitude).reshape(x.shape)))
    bands = bands.reshape(-1, *x.shape)
    kind = more.pop("dtype", "float32")
    with rasterio.open(
        path, "w", driver="GTiff", width=size[0], height=size[1], count=len(bands), dtype=kind,
        crs=more.pop("crs", projection), transform=more.pop("transform", transform), **more,
    ) as file:  # fmt: skip
        file.write(bands.astype(kind))
        if unit:
            file.units = [unit] * len(bands)
    return path
