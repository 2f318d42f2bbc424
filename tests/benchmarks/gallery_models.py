"""Fire models that the gallery's runs come from: pyretechnics and ForeFire, each writing its own files.

pyretechnics is the extra "simulate"; ForeFire (`pip install forefire`) is among the tests' packages.
"""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from gallery_land import WATER, Land
from numpy.typing import NDArray

LIT = 5.0  # minutes: weather bands; a fire is lit and looked at no oftener


@dataclass(frozen=True)
class Weather:
    """What is the same everywhere.

    Attributes
    ----------
    wind
        (hour, km/h at 10 m, direction it comes from in degrees), by time; between them it changes evenly.
    dead, live
        Fuel moisture, kg of water for each kg of wood: dead fuel of one hour, and live.
    """

    wind: Sequence[tuple[float, float, float]]
    dead: float = 0.06
    live: float = 0.7
    temperature: float = 28.0  # degrees Celsius

    def at(self, hours: NDArray) -> tuple[NDArray, NDArray]:
        """km/h, and degrees that it comes from."""
        known, speed, source = np.array(self.wind, np.float64).T
        turned = np.unwrap(np.radians(source))
        return np.interp(hours, known, speed), np.degrees(np.interp(hours, known, turned)) % 360.0


@dataclass(frozen=True)
class Ignition:
    """Where (ny, nx), and how many minutes after the start."""

    where: NDArray[np.bool_]
    minute: float = 0.0


@dataclass
class Spread:
    """A fire that pyretechnics spreads."""

    land: Land
    weather: Weather
    ignitions: list[Ignition]
    minutes: float
    spots: dict | None = None
    band: float = field(default=LIT, init=False)

    def write(self, folder: Path) -> list[Path]:
        """Simulate, and write the matrices as `firetwin convert` takes them."""
        from pyretechnics.eulerian_level_set import (
            SpreadState,
            spread_fire_with_phi_field,
        )

        bands = int(np.ceil(self.minutes / self.band)) + 1
        cubes, state = self._cubes(bands), SpreadState((bands, *self.land.shape))
        resolution = (self.band, self.land.cell, self.land.cell)
        moments = [*sorted({each.minute for each in self.ignitions}), self.minutes]
        spots: dict = {}
        for begin, end in itertools.pairwise(moments):
            for each in self.ignitions:
                if each.minute == begin:
                    self._light(state, each.where)
            fresh = state.get_simulation_time() < 0
            first = {"start_time": begin, "cube_resolution": resolution} if fresh else {}
            more = {"spot_ignitions": spots, "spot_config": self.spots} if self.spots else {}
            done = spread_fire_with_phi_field(
                cubes,
                state,
                max_duration=end - begin,
                crown_max_lw_ratio=6.0,
                **more,
                **first,
            )
            state, spots = done["spread_state"], done.get("spot_ignitions", {})
        return [self._save(folder, state)]

    def _light(self, state: object, where: NDArray[np.bool_]) -> None:
        burned = np.asarray(state.get_full_matrices(["phi"])["phi"]) < 0  # type: ignore[attr-defined]
        fuel = self.land.surface_fuel > 0
        state.ignite_cells((0, 0), np.where(where & fuel & ~burned, -1.0, 1.0).astype(np.float32))  # type: ignore[attr-defined]

    def _cubes(self, bands: int) -> dict[str, object]:
        from pyretechnics.space_time_cube import SpaceTimeCube

        land, air = self.land, self.weather
        slope, aspect = land.slope_and_aspect
        speed, source = self._blows(bands)
        layers = {
            "slope": slope,
            "aspect": aspect,
            "fuel_model": land.category,
            "canopy_cover": land.cover,
            "canopy_height": land.height,
            "canopy_base_height": land.base,
            "canopy_bulk_density": land.density,
            "wind_speed_10m": speed.reshape(bands, 1, 1),
            "upwind_direction": source.reshape(bands, 1, 1),
            "temperature": air.temperature,
            "fuel_moisture_dead_1hr": air.dead,
            "fuel_moisture_dead_10hr": air.dead + 0.01,
            "fuel_moisture_dead_100hr": air.dead + 0.02,
            "fuel_moisture_live_herbaceous": 0.6 * air.live,
            "fuel_moisture_live_woody": air.live,
            "foliar_moisture": 0.9,
        }
        return {
            name: SpaceTimeCube((bands, *land.shape), np.asarray(values, np.float32))
            for name, values in layers.items()
        }

    def _blows(self, bands: int) -> tuple[NDArray, NDArray]:
        """km/h and degrees that the wind comes from, of each band."""
        return self.weather.at((np.arange(bands) + 0.5) * self.band / 60.0)

    def _save(self, folder: Path, state: object) -> Path:
        latitude, longitude = self.land.axes
        path = folder / "pyretechnics.npz"
        speed, source = self._blows(int(np.ceil(self.minutes / self.band)) + 1)
        found = state.get_full_matrices()  # type: ignore[attr-defined]
        arrival = np.where(found["phi"] < 0, found["time_of_arrival"], np.nan)
        first = (found["phi"] < 0) & ~np.isfinite(found["time_of_arrival"])  # lit before the first step
        first |= np.isfinite(arrival) & (arrival < 0)
        found |= {"time_of_arrival": np.where(first, 0.0, arrival)}
        np.savez(
            path,
            latitude=latitude,
            longitude=longitude,
            elevation=self.land.elevation,
            surface_fuel=self.land.surface_fuel,
            canopy_fuel=self.land.canopy_fuel,
            fuel_category=self.land.category,
            wind_speed_10m=speed,
            upwind_direction=source,
            band_duration=self.band,
            **found,
        )
        return path


_FOREFIRE = """
import sys, numpy, pyforefire
from pyforefire import helpers
land = numpy.load("land.npz")
ff = pyforefire.ForeFire()
ff["caseDirectory"] = "."
width, height = land["size"]
for key, value in {"spatialIncrement": 2.0, "perimeterResolution": 20.0, "minimalPropagativeFrontDepth": 20.0,
                   "atmoNX": 60, "atmoNY": 60, "refYear": int(land["day"][0]), "refDay": int(land["day"][1]),
                   "propagationModel": "Rothermel", "windReductionFactor": 0.4}.items():
    ff[key] = value
rows = [row for row in helpers.standardRothermelFuelTable().split("\\n") if not row.startswith("512;")]
water = rows[1].split(";")
water[0], water[7], water[8], water[9] = "512", "0", "0", "0"
table = "\\n".join([*rows, ";".join(water)])
open("fuels.csv", "w").write(table + "\\n")
ff["fuelsTable"] = table
ff.execute(f"FireDomain[sw=(0,0,0);ne=({width},{height},0);t=0]")
ff.addLayer("propagation", "Rothermel", "propagationModel")
size = (0, 0, 0, width, height, 0)
ff.addIndexLayer("table", "fuel", *size, land["fuel"].astype("int32")[None, None])
ff.addScalarLayer("table", "altitude", *size, land["altitude"].astype(float)[None, None])
one = numpy.ones((1, 2, 4, 4))
ff.addScalarLayer("windScalDir", "windU", *size, one * [[[[1]], [[0]]]])
ff.addScalarLayer("windScalDir", "windV", *size, one * [[[[0]], [[1]]]])
east, north = land["wind"]
ff.execute(f"trigger[wind;loc=(0.,0.,0.);vel=({east},{north},0.);t=0.]")
for x, y in land["ignitions"]:
    ff.execute(f"startFire[loc=({x},{y},0);t=0]")
for _ in range(int(land["minutes"])):
    ff.execute("step[dt=60]")
ff.execute("save[]")
"""


@dataclass
class Fronts:
    """A fire that ForeFire spreads, over CORINE's kinds of land (its own table of fuels).

    Attributes
    ----------
    fuel
        (ny, nx) CORINE codes: 321 grassland, 323 shrubs, 312 conifers, 512 water.
    ignitions
        Metres east and north of the land's middle.
    wind
        m/s to the east and to the north.
    day
        Year and day of the year.
    """

    land: Land
    fuel: NDArray
    ignitions: list[tuple[float, float]]
    wind: tuple[float, float]
    minutes: float
    day: tuple[int, int]

    def write(self, folder: Path) -> list[Path]:
        """Simulate in a process of its own, which writes what the model writes and its landscape."""
        import netCDF4

        (ny, nx), cell = self.land.shape, self.land.cell
        size = np.array([nx, ny]) * cell
        (folder / "ForeFire").mkdir()
        np.savez(
            folder / "land.npz",
            size=size,
            day=self.day,
            fuel=self.fuel,
            altitude=self.land.elevation,
            wind=self.wind,
            ignitions=np.array(self.ignitions) + size / 2,
            minutes=self.minutes,
        )
        clean = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        code = [sys.executable, "-c", _FOREFIRE]
        subprocess.run(code, cwd=folder, check=True, timeout=300, capture_output=True, env=clean)
        latitude, longitude = self.land.axes
        half = np.array([np.diff(latitude)[0], np.diff(longitude)[0]]) / 2
        box = (
            longitude[0] - half[1],
            latitude[0] - half[0],
            longitude[-1] + half[1],
            latitude[-1] + half[0],
        )
        with netCDF4.Dataset(folder / "landscape.nc", "w", format="NETCDF3_CLASSIC") as file:
            for name, letter, values in (
                ("fuel", "f", self.fuel),
                ("altitude", "n", self.land.elevation),
            ):
                axes = [f"{letter}{axis}" for axis in "tzyx"]
                for axis, length in zip(axes, (1, 1, ny, nx), strict=True):
                    file.createDimension(axis, length)
                file.createVariable(name, "i2", axes)[:] = np.rint(values)[None, None]
            for axis in "tzyx":
                file.createDimension(f"w{axis}", 1)
            for name, value in zip(("windU", "windV"), self.wind, strict=True):
                file.createVariable(name, "f4", [f"w{axis}" for axis in "tzyx"])[:] = value
            file.createDimension("domdim", 1)
            said = {"SWx": 0.0, "SWy": 0.0, "Lx": size[0], "Ly": size[1]}
            said |= {"BBoxWSEN": ",".join(f"{each:.8f}" for each in box)}
            file.createVariable("domain", "S1", ("domdim",)).setncatts(said)
        return [folder / "ForeFire.0.nc", folder / "landscape.nc", folder / "fuels.csv"]


def corine(land: Land) -> NDArray:
    """CORINE codes of a land's fuel models: grass, shrub, timber and water."""
    number = land.category
    return np.select([number == WATER, number < 130, number < 160], [512, 321, 323], default=312)
