"""Reader of WRF-SFIRE and WRF-Fire: ``wrfout_d0N_*``, one time or several in each file.

Names, units and layouts: WRF-SFIRE, Registry/registry.fire and Registry.EM_COMMON; thermodynamics:
share/module_model_constants.F. Fire variables lie on a subgrid of (west_east + 1) sr_x columns and
(south_north + 1) sr_y rows, of which the last sr are invalid. The run's grids are the fire's, except for
wind, temperature and 3D fields, which stay on the atmosphere's grid. If the files have no flux on the fire's
grid, the model grid is the atmosphere's too.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import lru_cache
from pathlib import Path

import numpy as np
from firetwin_core import terrain
from numpy.typing import NDArray

from ...errors import Error
from ..models import arrival, companion_rasters, fuels, netcdf
from ..models.grid import Grid
from ..models.model import Model, Options, read_until
from ..models.raster import local

NAME, ORDER = "WRF-SFIRE output", 10
MODELS = "WRF-SFIRE"

_FIRE = ("FGRNHFX", "LFN", "FIRE_AREA", "TIGN_G")
_T0, _P0, _RD, _CP, _RV, _G = 300.0, 1e5, 287.0, 1004.5, 461.6, 9.81  # WRF's own constants


def sniff(path: Path) -> bool:
    """Check whether a file has WRF's dimensions, the fire subgrid and a fire variable."""
    dimensions, variables = netcdf.names(path)
    return {"west_east_subgrid", "south_north_subgrid"} <= dimensions and bool(variables & set(_FIRE))


@dataclass
class _Frame:
    path: Path
    index: int
    moment: datetime


class _Wrf:
    """The files as one time series."""

    def __init__(self, paths: list[Path], options: Options) -> None:
        self.files = netcdf.Files()
        by_time: dict[datetime, _Frame] = {}
        for path in sorted(paths):
            for index, moment in enumerate(_moments(self.files(path))):
                by_time[moment] = _Frame(
                    path, index, moment
                )  # of a time that is there twice the later file's
        self.frames = [by_time[moment] for moment in sorted(by_time) if read_until(moment, options)]
        self.ny, self.nx, self.sy, self.sx = _sizes(self.first)
        for path in {frame.path for frame in self.frames}:
            if _sizes(self.files(path)) != (self.ny, self.nx, self.sy, self.sx):
                raise self.files(path).error("has another grid than the others; give the files of one domain")

    @property
    def first(self) -> netcdf.File:
        """File of the first time; opened on each access, as few files stay open."""
        return self.files(self.frames[0].path)

    def has(self, *names: str) -> bool:
        return all(name in self.first for name in names)

    def read(self, name: str, index: int, *, stag: int | None = None) -> NDArray:
        """Read a variable at a time; a staggered one is averaged to cell centres along the axis `stag`."""
        frame = self.frames[index]
        values = self.files(frame.path).read(name, frame.index)
        if stag is None:
            return values
        values = np.moveaxis(values, stag, 0)
        return np.moveaxis(np.float32(0.5) * (values[1:] + values[:-1]), 0, stag)

    def fire(self, name: str, index: int) -> NDArray:
        """Read a subgrid variable without its invalid edge."""
        frame = self.frames[index]
        rows, columns = slice(self.ny * self.sy), slice(self.nx * self.sx)
        return self.files(frame.path).read(name, frame.index, rows, columns)

    def mean(self, fine: NDArray) -> NDArray:
        """Average the fire's cells over each of the atmosphere's cells."""
        blocks = np.asarray(fine, np.float64).reshape(self.ny, self.sy, self.nx, self.sx)
        return blocks.mean(axis=(1, 3))

    def spread(self, coarse: NDArray) -> NDArray:
        """Interpolate atmosphere values bilinearly to fire cells; constant beyond the outer centres."""
        row, column = (
            np.clip((np.arange(count * step) + 0.5) / step - 0.5, 0, count - 1)
            for count, step in ((self.ny, self.sy), (self.nx, self.sx))
        )
        return terrain.bilinear(coarse, row[:, None], column)


def read(paths: list[Path], options: Options) -> Model:
    """Read the series as a model."""
    wrf = _Wrf([path for path in paths if sniff(path)], options)
    land = companion_rasters.find(paths)
    notes: list[str] = []
    moments = [frame.moment for frame in wrf.frames]
    start, said = _start(wrf.first, moments[0])
    times = np.array([(moment - start).total_seconds() for moment in moments])
    air, fire = _grids(wrf, options, notes)
    fine = wrf.has("FGRNHFX")
    model = Model(
        source="WRF-SFIRE",
        version=_version(wrf.first),
        name=str(wrf.first.attribute("TITLE", otherwise="WRF-SFIRE run")).strip(),
        start=start,
        times=times,
        grid=fire if fine else air,
        fuel_grid=fire,
        air=air if fine else None,
        still={},
        moving={},
        files=sorted({frame.path for frame in wrf.frames}),
        projection=_projection(wrf.first),
        mean_s=float(wrf.first.attribute("DT", otherwise=0.0)),
        sources=[(frame.path, frame.index) for frame in wrf.frames],
        close=wrf.files.close,
    )
    notes += [said, "latitude and longitude on WRF's sphere of 6370 km are used as WGS84 coordinates"]
    _flux(wrf, model, notes)
    if wrf.has("FIRE_AREA"):
        notes.append("burned fraction is FIRE_AREA: burned areas are sums of burned shares of cells")
        model.moving["burned_fraction"] = lambda i: _share(wrf, i)
    _near_ground(wrf, model, notes)
    _on_levels(wrf, model, notes)
    _still(wrf, model, land, options, notes)
    model.assumptions = notes + land.assumptions
    return model


def _moments(file: netcdf.File) -> list[datetime]:
    if "Times" not in file:
        raise file.error("has no variable Times, which is needed")
    with file.sense():
        rows = np.asarray(file.variables["Times"][:])
    moments = []
    for row in np.atleast_2d(rows):
        text = row.tobytes().decode("ascii", "replace").strip("\0 ")
        try:
            moments.append(datetime.strptime(text, "%Y-%m-%d_%H:%M:%S").replace(tzinfo=UTC))
        except ValueError:
            raise file.error(f"its Times say {text!r}, no date and time; it is damaged") from None
    if not moments:
        raise file.error("has no times; it is incomplete")
    return moments


def _start(file: netcdf.File, first: datetime) -> tuple[datetime, str]:
    """Find the time origin of TIGN_G: the start of the simulation, also for files of a restart."""
    for name in ("SIMULATION_START_DATE", "START_DATE"):
        try:
            text = str(file.attribute(name, otherwise=""))
            return datetime.strptime(text, "%Y-%m-%d_%H:%M:%S").replace(
                tzinfo=UTC
            ), f"times count from {name}"
        except ValueError:
            pass
    return first, "no start time: times count from the first one"


def _sizes(file: netcdf.File) -> tuple[int, int, int, int]:
    try:
        ny, nx = file.dimensions["south_north"], file.dimensions["west_east"]
        fy, fx = file.dimensions["south_north_subgrid"], file.dimensions["west_east_subgrid"]
    except KeyError as error:
        raise file.error(f"has no dimension {error.args[0]}") from None
    sy, sx = fy // (ny + 1), fx // (nx + 1)
    if sy < 1 or sx < 1 or sy * (ny + 1) != fy or sx * (nx + 1) != fx:
        raise file.error(
            f"its fire grid of {fy} x {fx} does not divide the atmosphere's of {ny} x {nx} cells"
        )
    return ny, nx, sy, sx


def _grids(wrf: _Wrf, options: Options, notes: list[str]) -> tuple[Grid, Grid]:
    x, y = (wrf.fire(name, 0).astype(np.float64) for name in ("FXLONG", "FXLAT"))
    unit = float(wrf.read("UNIT_FXLONG", 0)) if wrf.has("UNIT_FXLONG") else 0.0
    metres = unit == 1.0 or np.abs(y).max() > 90.0
    if metres:  # an ideal run without georeference
        fire, said = local(x.mean(axis=0), y.mean(axis=1), options.at)
        notes.append(said)
        return Grid(_block(fire.latitude, wrf.sy), _block(fire.longitude, wrf.sx)), fire
    if wrf.has("XLAT", "XLONG"):
        return Grid(*(wrf.read(name, 0).astype(np.float64) for name in ("XLAT", "XLONG"))), Grid(y, x)
    return Grid(wrf.mean(y), wrf.mean(x)), Grid(y, x)


def _block(axis: NDArray, step: int) -> NDArray:
    return axis.reshape(-1, step).mean(axis=1)


def _flux(wrf: _Wrf, model: Model, notes: list[str]) -> None:
    fine = wrf.has("FGRNHFX")
    if not fine and not wrf.has("GRNHFX"):
        raise Error(f"{wrf.first.path}: has neither FGRNHFX nor GRNHFX, the heat flux of the fire")
    (ground, canopy), get = (("FGRNHFX", "FCANHFX"), wrf.fire) if fine else (("GRNHFX", "CANHFX"), wrf.read)
    crown, where = wrf.has(canopy), "fire" if fine else "atmosphere"
    notes.append(f"heat flux is {ground}{f' + {canopy}' if crown else ''} (sensible, on the {where}'s grid)")
    model.moving["heat_flux"] = lambda i: (get(ground, i) + get(canopy, i)) if crown else get(ground, i)


def _share(wrf: _Wrf, i: int) -> NDArray:
    """Compute the burned fraction (0..1) of each fire cell."""
    return np.clip(np.nan_to_num(wrf.fire("FIRE_AREA", i)), 0, 1)


def _near_ground(wrf: _Wrf, model: Model, notes: list[str]) -> None:
    """Read wind (east, north) and temperature near the ground: at 10 m and 2 m, or at the lowest level."""
    winds = None
    if wrf.has("U10", "V10"):
        notes.append("wind is U10, V10, turned from the grid's axes to east and north")
        winds = lambda i: (wrf.read("U10", i), wrf.read("V10", i))  # noqa: E731
    elif wrf.has("U", "V"):
        notes.append("wind is taken from the lowest level, rotated from the grid's axes to east and north")
        winds = lambda i: (wrf.read("U", i, stag=2)[0], wrf.read("V", i, stag=1)[0])  # noqa: E731
    if winds:
        turned = lru_cache(1)(lambda i: _air(model).east_north(*winds(i)))  # both are requested in turn
        model.moving |= {"wind_east": lambda i: turned(i)[0], "wind_north": lambda i: turned(i)[1]}
    if wrf.has("T2"):
        model.moving["temperature"] = lambda i: wrf.read("T2", i)
    elif wrf.has("T", "P", "PB"):
        model.moving["temperature"] = lambda i: _kelvin(wrf, i)[0]


def _on_levels(wrf: _Wrf, model: Model, notes: list[str]) -> None:
    if not wrf.has("PH", "PHB") or wrf.first.dimensions.get("bottom_top", 0) < 2:
        return
    fields = {}
    if wrf.has("tr17_1", "T", "P", "PB"):
        unit = str(wrf.first.attribute("units", "tr17_1", "")).strip().lower()
        scale = 1e-9 if unit.startswith("ug") else 1e-3
        notes.append(
            f"smoke is tr17_1 as {'ug' if scale < 1e-6 else 'g'} per kg of dry air, times its density"
        )
        fields["smoke_3d"] = lambda i: wrf.read("tr17_1", i) * (_dry_density(wrf, i) * np.float32(scale))
    if wrf.has("T", "P", "PB"):
        fields["temperature_3d"] = lambda i: _kelvin(wrf, i)
    if wrf.has("U", "V", "W"):
        winds = lru_cache(1)(lambda i: _winds(wrf, model, i))
        fields |= {"wind_east_3d": lambda i: winds(i)[0], "wind_north_3d": lambda i: winds(i)[1]}
        fields["wind_up_3d"] = lambda i: wrf.read("W", i, stag=0)
    if fields:
        fields["height_3d"] = lambda i: (
            (wrf.read("PH", i, stag=0) + wrf.read("PHB", i, stag=0)) / np.float32(_G)
        )
        model.moving |= fields
        model.levels |= dict.fromkeys(fields, wrf.first.dimensions["bottom_top"])


def _winds(wrf: _Wrf, model: Model, i: int) -> tuple[NDArray, NDArray]:
    return _air(model).east_north(wrf.read("U", i, stag=2), wrf.read("V", i, stag=1))


def _air(model: Model) -> Grid:
    return model.grid if model.air is None else model.air


def _kelvin(wrf: _Wrf, i: int) -> NDArray:
    """Compute the temperature from T, potential temperature minus 300 K: theta (p / 1e5 Pa)^(R/cp)."""
    pressure = wrf.read("P", i) + wrf.read("PB", i)
    with np.errstate(invalid="ignore"):
        return (wrf.read("T", i) + np.float32(_T0)) * (pressure / np.float32(_P0)) ** np.float32(_RD / _CP)


def _dry_density(wrf: _Wrf, i: int) -> NDArray:
    """Compute the density of dry air, kg/m3: p / (R T (1 + q Rv/R))."""
    moist = 1 + wrf.read("QVAPOR", i) * np.float32(_RV / _RD) if wrf.has("QVAPOR") else np.float32(1)
    return (wrf.read("P", i) + wrf.read("PB", i)) / (np.float32(_RD) * _kelvin(wrf, i) * moist)


def _still(
    wrf: _Wrf, model: Model, land: companion_rasters.LandRasters, options: Options, notes: list[str]
) -> None:
    fine = model.air is not None
    if wrf.has("ZSF"):
        model.still["fuel_elevation"] = lambda: wrf.fire("ZSF", 0)
        model.still["elevation"] = lambda: wrf.fire("ZSF", 0) if fine else wrf.mean(wrf.fire("ZSF", 0))
    if wrf.has("HGT") and not (fine and wrf.has("ZSF")):
        model.still["elevation"] = lambda: wrf.spread(wrf.read("HGT", 0)) if fine else wrf.read("HGT", 0)
    if wrf.has("NFUEL_CAT"):
        notes.append(
            "surface fuel is WRF-SFIRE's load (fgi) of Anderson's model NFUEL_CAT; a namelist.fire may differ"
        )
        model.still["surface_fuel"] = lambda: fuels.loads(wrf.fire("NFUEL_CAT", 0), "sfire")
        model.still["fuel_category"] = lambda: wrf.fire("NFUEL_CAT", 0)
    model.still["fuel_arrival_time"] = lambda: _arrival(wrf, model.times)
    notes.append(f"time of arrival is {_arrival_from(wrf)}")
    land.complete(model.still, model.grid, model.fuel_grid, options.projection)


def _arrival_from(wrf: _Wrf) -> str:
    if not wrf.has("TIGN_G"):
        return "interpolated between files"
    if wrf.has("FIRE_AREA"):
        return "TIGN_G, or where FIRE_AREA passes a half between two other times, interpolated there"
    return "TIGN_G where the fire is in the last file"


def _arrival(wrf: _Wrf, times: NDArray) -> NDArray:
    shape, last = (wrf.ny * wrf.sy, wrf.nx * wrf.sx), len(wrf.frames) - 1
    if wrf.has("TIGN_G", "FIRE_AREA"):
        return arrival.held(wrf.fire("TIGN_G", last), times, lambda i: _share(wrf, i))
    if wrf.has("TIGN_G", "LFN"):
        ignition, burned = wrf.fire("TIGN_G", last), wrf.fire("LFN", last) <= 0
    elif wrf.has("LFN"):
        return arrival.from_levels(times, lambda i: wrf.fire("LFN", i), shape)
    elif wrf.has("FIRE_AREA"):
        return arrival.from_share(times, lambda i: _share(wrf, i), shape)
    else:
        raise Error(f"{wrf.first.path}: has neither LFN nor FIRE_AREA, one of which is needed for the front")
    return np.where(burned & (ignition <= times[-1]), ignition, np.float32(np.nan))


def _version(file: netcdf.File) -> str:
    match = re.search(r"V[\d.]+", str(file.attribute("TITLE", otherwise="")))
    return match[0] if match else ""


def _projection(file: netcdf.File) -> str:
    """Format WRF's projection as a PROJ string for display."""
    kinds = {1: "lcc", 2: "stere", 3: "merc"}
    kind = kinds.get(int(file.attribute("MAP_PROJ", otherwise=0)))
    if kind is None:
        return "none: metres or latitude and longitude"
    keys = {"lat_1": "TRUELAT1", "lat_2": "TRUELAT2", "lat_0": "MOAD_CEN_LAT", "lon_0": "STAND_LON"}
    said = [
        f"+{key}={file.attribute(name):g}" for key, name in keys.items() if file.attribute(name) is not None
    ]
    return " ".join([f"+proj={kind}", *said, "+a=6370000 +b=6370000"])
