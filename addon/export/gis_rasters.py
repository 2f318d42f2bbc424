"""Cloud-optimized GeoTIFFs of a run on even steps of degrees, through rasterio (GDAL)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import extras, files
from ..errors import Error
from ..run import areas, fronts, thumbnails, times
from .overlays import nearest

FOLDER = "maps"
_UNEVEN = 1.0e-3  # share of a step by which coordinates may differ from even steps

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Raster:
    """A map.

    Attributes
    ----------
    bands
        Name and values (ny, nx) of each band, on the axes of the run.
    latitude, longitude
        Axes, degrees.
    unit
        Unit of the values.
    no_data
        Value without data; None if all cells have data.
    """

    name: str
    title: str
    bands: dict[str, NDArray]
    latitude: Array
    longitude: Array
    unit: str
    no_data: float | None = None


def make(run: Run, zone: str, time: float) -> list[Raster]:
    """Make the maps of a run.

    Parameters
    ----------
    zone
        Time zone of the round times of burned areas.
    time
        Model time of the smoke column, s.
    """
    fine, coarse = (run.fuel_latitude, run.fuel_longitude), (run.latitude, run.longitude)
    arrival = np.asarray(run.fuel_arrival_time(), np.float32)
    fuel = {"surface fuel": run.surface_fuel, "canopy fuel": run.canopy_fuel}
    moments = fronts.choose_times(run, zone)
    with np.errstate(invalid="ignore"):
        burned = {times.iso(times.utc(run, each)): (arrival <= each).astype(np.uint8) for each in moments}
    start = f"seconds since {times.iso(times.utc(run, 0.0))}"
    flux = thumbnails.strongest(run)
    rasters = [
        Raster("arrival", "Fire arrival", {start: arrival}, *fine, "s", float("nan")),
        Raster("intensity", "Maximum heat flux", {"maximum heat flux": flux}, *coarse, "W/m2"),
        Raster("fuel", "Fuel load", fuel, *fine, "kg/m2"),
        Raster("burned", "Burned area by time", burned, *fine, "1: burned"),
    ]
    column = _smoke_column(run, time)
    if column is not None:
        band = {times.iso(times.utc(run, time)): column}
        rasters.append(
            Raster("smoke_column", "Smoke column", band, run.air_latitude, run.air_longitude, "kg/m2")
        )
    return rasters


def write(rasters: list[Raster], folder: Path, run: Run) -> list[Path]:
    """Write a file for each map.

    Raises
    ------
    Error
        rasterio is not installed.
    InputError
        The disk is full.
    """
    rasterio = _rasterio()
    (folder / FOLDER).mkdir()
    return [_write(rasterio, each, folder / FOLDER / f"{each.name}.tif", run) for each in rasters]


def _smoke_column(run: Run, time: float) -> NDArray[np.float32] | None:
    """Integrate the model's own smoke over height (ny, nx), kg/m2; None without it."""
    if not (run.has("smoke_3d") and run.has("height_3d")):
        return None
    known = float(np.clip(time, run.times[0], run.times[-1]))
    smoke, height = run.smoke_3d_at(known), run.height_3d_at(known)
    layers = 0.5 * (smoke[1:] + smoke[:-1]) * np.diff(height, axis=0)
    return layers.sum(axis=0).astype(np.float32)


def _write(rasterio: ModuleType, raster: Raster, path: Path, run: Run) -> Path:
    rows, south, north = _axis(raster.latitude)
    columns, west, east = _axis(raster.longitude)
    picked = np.ix_(rows[::-1], columns)  # north first
    bands = [np.ascontiguousarray(each[picked]) for each in raster.bands.values()]
    height, width = bands[0].shape
    profile = {
        "driver": "GTiff",
        "height": height,
        "width": width,
        "count": len(bands),
        "dtype": bands[0].dtype,
        "crs": rasterio.crs.CRS.from_epsg(4326),
        "transform": rasterio.transform.from_bounds(west, south, east, north, width, height),
        "nodata": raster.no_data,
    }
    note = {
        "TIFFTAG_IMAGEDESCRIPTION": f"{raster.title}, {raster.unit}",
        "run": run.name,
        "unit": raster.unit,
    }
    note |= {"synthetic": "yes"} if run.synthetic else {}
    options = {"compress": "deflate", "predictor": "yes", "resampling": "nearest", "num_threads": "1"}
    with rasterio.MemoryFile() as memory, rasterio.MemoryFile(ext=".tif") as finished:
        with memory.open(**profile) as raw:
            for number, (name, band) in enumerate(zip(raster.bands, bands, strict=True), 1):
                raw.write(band, number)
                raw.set_band_description(number, name)
            raw.update_tags(**note)
        with memory.open() as raw:
            rasterio.shutil.copy(raw, finished.name, driver="COG", **options)
        data = finished.read()
    files.write(path, lambda part: part.write_bytes(data))
    return path


def _axis(axis: Array) -> tuple[NDArray[np.int64], float, float]:
    """Return the index of a cell for each even step from low to high, and the lowest and highest edges.

    An axis with even steps keeps its cells; another is sampled at the nearest of its cells.
    """
    low, high = (float(pick(areas.edges(axis))) for pick in (np.min, np.max))
    step = (high - low) / max(len(axis), 1)
    wanted = low + (np.arange(len(axis)) + 0.5) * step
    order = np.argsort(axis)
    if np.abs(axis[order] - wanted).max() <= _UNEVEN * step:
        return order, low, high
    return nearest(axis, wanted), low, high


def _rasterio() -> ModuleType:
    try:
        import rasterio
        import rasterio.shutil
        import rasterio.transform
    except ModuleNotFoundError:
        reason = f"the GIS export needs rasterio; install it with: {extras.install('raster')}"
        raise Error(reason) from None
    return rasterio
