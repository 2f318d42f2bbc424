"""Test files in the exact structure of each fire model: a front that moves east at a constant speed."""

import tomllib
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

netCDF4 = pytest.importorskip("netCDF4", reason="pip install 'firetwin[models]'")  # noqa: N816

NY, NX, SR, LEVELS = 6, 8, 4, 5
SPEED = 1.5  # m/s, of the front
START = datetime(2020, 7, 1, 18)


def wrf(
    folder, *, times=(60, 120, 180), per_file=2, turn=0.0, ideal=False, seed=1, without=(),
    shape=(NY, NX), cell=40.0, came=lambda x, y: x / SPEED, touched=False, **attributes,
):  # fmt: skip
    """wrfout files: staggering, subgrid, unused border, grid rotated by `turn` degrees.

    `came` gives the arrival time (s) at a point (m). TIGN_G is the time at the centre of a cell, or
    if `touched` at first contact. FIRE_AREA is the burned fraction of the cell.
    """
    rng = np.random.default_rng(seed)
    NY, NX = shape  # noqa: N806
    fy, fx = (NY + 1) * SR, (NX + 1) * SR
    side = cell / SR
    j, i = np.mgrid[0:fy, 0:fx]
    x, y = (i + 0.5) * side, (j + 0.5) * side
    inner = (np.arange(8) + 0.5) / 8 - 0.5
    within = came(x[..., None, None] + side * inner, y[..., None, None] + side * inner[:, None])
    within = np.broadcast_to(within, (fy, fx, 8, 8)).reshape(fy, fx, 64)
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    lat = 39.0 + (s * x + c * y) / 111_100.0
    lon = -120.0 + (c * x - s * y) / (111_300.0 * np.cos(np.radians(39.0)))
    if ideal:
        lat, lon = y, x
    junk = (j >= NY * SR) | (i >= NX * SR)
    paths, groups = [], [times[k : k + per_file] for k in range(0, len(times), per_file)]
    truth = {
        "FIRE_AREA": [],
        "FGRNHFX": [],
        "GRNHFX": [],
        "U10": [],
        "V10": [],
        "T": [],
        "P": [],
        "PB": [],
        "tr17_1": [],
    }
    fixed = {"ZSF": rng.uniform(900, 950, (fy, fx)), "HGT": rng.uniform(900, 950, (NY, NX))}
    for group in groups:
        path = folder / f"wrfout_d01_{START + timedelta(seconds=group[0]):%Y-%m-%d_%H_%M_%S}"
        with netCDF4.Dataset(path, "w", format="NETCDF4") as f:
            f.TITLE = " OUTPUT FROM WRF V4.4 MODEL"
            f.SIMULATION_START_DATE = f"{START:%Y-%m-%d_%H:%M:%S}"
            f.START_DATE = f"{START:%Y-%m-%d_%H:%M:%S}"
            f.DT, f.MAP_PROJ = np.float32(0.5), np.int32(0 if ideal else 1)
            f.TRUELAT1, f.TRUELAT2, f.MOAD_CEN_LAT, f.STAND_LON = np.float32([39, 39, 39, -120])
            f.setncatts(attributes)
            for name, size in {
                "Time": None, "DateStrLen": 19, "west_east": NX, "south_north": NY, "bottom_top": LEVELS,
                "west_east_stag": NX + 1, "south_north_stag": NY + 1, "bottom_top_stag": LEVELS + 1,
                "west_east_subgrid": fx, "south_north_subgrid": fy,
            }.items():  # fmt: skip
                f.createDimension(name, size)
            dims = {
                "f": ("Time", "south_north_subgrid", "west_east_subgrid"),
                "a": ("Time", "south_north", "west_east"),
                "m": ("Time", "bottom_top", "south_north", "west_east"),
                "u": ("Time", "bottom_top", "south_north", "west_east_stag"),
                "v": ("Time", "bottom_top", "south_north_stag", "west_east"),
                "w": ("Time", "bottom_top_stag", "south_north", "west_east"),
                "": ("Time",),
            }  # fmt: skip

            def put(name, kind, values, f=f, dims=dims):
                k = f["Times"].shape[0] - 1
                if name in without:
                    return
                if name not in f.variables:
                    f.createVariable(name, "f4", dims[kind])
                f[name][k] = values

            times_variable = f.createVariable("Times", "S1", ("Time", "DateStrLen"))
            for k, second in enumerate(group):
                text = f"{START + timedelta(seconds=second):%Y-%m-%d_%H:%M:%S}"
                times_variable[k] = np.frombuffer(text.encode(), "S1")
                level = SPEED * (came(x, y) - second)
                share = (within < second).mean(-1)
                lit, ignition = (share > 0, within.min(-1)) if touched else (level < 0, came(x, y))
                put("FXLONG", "f", np.where(junk, 0, lon))
                put("FXLAT", "f", np.where(junk, 0, lat))
                put("UNIT_FXLONG", "", 1.0 if ideal else 96_000.0)
                put("UNIT_FXLAT", "", 1.0 if ideal else 111_000.0)
                mass = np.s_[: NY * SR, : NX * SR]
                for name, each in (("XLAT", lat), ("XLONG", lon)):
                    mean = each[mass].reshape(NY, SR, NX, SR).mean((1, 3))
                    put(name, "a", 0 * mean if ideal else mean)
                flux = np.where((level < 0) & (level > -3 * side), rng.uniform(1e4, 9e4, (fy, fx)), 0)
                put("LFN", "f", np.where(junk, 0, level))
                put("FIRE_AREA", "f", np.where(junk, np.nan, share))
                put("TIGN_G", "f", np.where(lit, ignition, second + 7))
                put("FGRNHFX", "f", np.where(junk, np.nan, flux))
                coarse = flux[mass].reshape(NY, SR, NX, SR).mean((1, 3)).astype(np.float32)
                put("GRNHFX", "a", coarse)
                put("NFUEL_CAT", "f", np.where(x < 100, 1, np.where(x < 200, 8, 14)))
                put("ZSF", "f", np.where(junk, 0, fixed["ZSF"]))
                put("HGT", "a", fixed["HGT"])
                u10, v10 = rng.normal(3, 1, (2, NY, NX)).astype(np.float32)
                put("U10", "a", u10)
                put("V10", "a", v10)
                put("U", "u", np.broadcast_to(np.arange(NX + 1.0), (LEVELS, NY, NX + 1)))
                put("V", "v", np.full((LEVELS, NY + 1, NX), 2.0))
                put("W", "w", np.broadcast_to(np.arange(LEVELS + 1.0)[:, None, None], (LEVELS + 1, NY, NX)))
                heights = 900 + 50.0 * np.arange(LEVELS + 1)[:, None, None] + np.zeros((1, NY, NX))
                put("PHB", "w", heights * 9.81)
                put("PH", "w", 0 * heights)
                theta = rng.uniform(-5, 5, (LEVELS, NY, NX)).astype(np.float32)
                base = np.broadcast_to(9e4 - 500.0 * np.arange(LEVELS)[:, None, None], theta.shape)
                put("T", "m", theta)
                put("PB", "m", base)
                put("P", "m", np.full(theta.shape, 12.0))
                smoke = rng.uniform(0, 1, theta.shape).astype(np.float32)
                put("tr17_1", "m", smoke)
                for name, value in (
                    ("FIRE_AREA", share[mass]),
                    ("FGRNHFX", flux[mass].astype(np.float32)), ("GRNHFX", coarse), ("U10", u10),
                    ("V10", v10), ("T", theta), ("PB", base.astype(np.float32)), ("tr17_1", smoke),
                ):  # fmt: skip
                    truth[name].append(value)
        paths.append(path)
    truth |= {
        "lat": lat[: NY * SR, : NX * SR], "lon": lon[: NY * SR, : NX * SR],
        "x": x[: NY * SR, : NX * SR], **fixed,
    }  # fmt: skip
    return paths, truth


def cfbm(folder, *, count=4, step=30, shape=(20, 30), cell=10.0, turn=0.0, seed=2):
    """fire_output files: (ny, nx) float32 without any attribute, with the time only in the name."""
    rng = np.random.default_rng(seed)
    ny, nx = shape
    x, y = np.meshgrid((np.arange(nx) + 0.5) * cell, (np.arange(ny) + 0.5) * cell)
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    lat = (39.0 + (s * x + c * y) / 111_000.0).astype(np.float32)
    lon = (-120.0 + (c * x - s * y) / (111_000.0 * np.cos(np.radians(39.0)))).astype(np.float32)
    paths, fluxes = [], []
    for k in range(count):
        path = folder / f"fire_output_{START + timedelta(seconds=step * k):%Y-%m-%d_%H:%M:%S}.nc"
        level = x - SPEED * step * k if k else np.full(shape, 999.0)
        flux = np.where(
            (level < 0) & (level > -40), rng.uniform(1e4, 8e4, shape), rng.uniform(0, 1e-3, shape)
        )
        flux = flux.astype(np.float32)
        if k == 0:
            flux[:] = 7.0e4  # the model never sets it
        with netCDF4.Dataset(path, "w") as f:
            f.createDimension("nx", nx)
            f.createDimension("ny", ny)
            for name, values in {
                "lats": lat, "lons": lon, "fgrnhfx": flux, "fgrnqfx": flux, "lfn": level,
                "fire_area": np.clip(0.5 - level / cell, 0, 1), "fuel_frac": np.where(level < 0, 0.5, 1.0),
                "uf": np.full(shape, 3.0), "vf": np.full(shape, 4.0), "zsf": 900 + y, "emis_smoke": 0 * x,
                "nfuel_cat": np.where(x < 150, 3.0, 14.0),
            }.items():  # fmt: skip
                f.createVariable(name, "f4", ("ny", "nx"))[:] = values
        paths.append(path)
        fluxes.append(flux)
    return paths, {"flux": fluxes, "x": x, "y": y, "lat": lat.astype(float), "lon": lon.astype(float)}


def forefire(path, arrival, *, lx=3000.0, ly=1000.0, west=0.0, south=0.0, year=2020, day=200):
    """Output of `save[]`: float64, an undeclared fill value -9999 where unburned, no coordinates."""
    with netCDF4.Dataset(path, "w") as f:
        f.createDimension("DIMX", arrival.shape[1])
        f.createDimension("DIMY", arrival.shape[0])
        f.createDimension("domdim", 1)
        f.createVariable("arrival_time_of_front", "f8", ("DIMY", "DIMX"))[:] = arrival
        f.createVariable("domain", "S1", ("domdim",)).setncatts(
            {
                "SWx": west,
                "SWy": south,
                "Lx": lx,
                "Ly": ly,
                "Lz": 0.0,
                "refYear": np.int32(year),
                "refDay": np.int32(day),
            }
        )
    return path


def landscape(path, fuel, altitude, *, size, box, wind=None, **domain):
    """ForeFire's data file: netCDF-3, (NT, NZ, NY, NX) layers with separate dimensions."""
    with netCDF4.Dataset(path, "w", format="NETCDF3_CLASSIC") as f:
        layers = [("fuel", "f", fuel), ("altitude", "n", altitude)]
        layers += zip(("windU", "windV"), "uv", wind or (), strict=False)
        for name, letter, values in layers:
            axes = [f"{letter}{axis}" for axis in "tzyx"]
            for axis, length in zip(axes, values.shape, strict=True):
                f.createDimension(axis, length)
            f.createVariable(name, values.dtype, axes)[:] = values
        f.createDimension("domdim", 1)
        said = {"SWx": 0.0, "SWy": 0.0, "Lx": size, "Ly": size, "BBoxWSEN": box} | domain
        f.createVariable("domain", "S1", ("domdim",)).setncatts(said)
    return path


def lcp(path, layers, *, cell=30.0, west=0.0, north=3000.0, height_unit=3, density_unit=3):
    """A landscape of eight 16-bit layers, pixel-interleaved, rows from the north (GDAL, lcpdataset.cpp)."""
    ny, nx, bands = layers.shape
    assert bands == 8
    head = bytearray(7316)
    head[0:12] = np.array([21, 20, 39], "<i4").tobytes()
    head[12:44] = np.array([west, west + nx * cell, north - ny * cell, north], "<f8").tobytes()
    head[4164:4172] = np.array([nx, ny], "<i4").tobytes()
    head[4172:4204] = np.array([west + nx * cell, west, north, north - ny * cell], "<f8").tobytes()
    head[4208:4224] = np.array([cell, cell], "<f8").tobytes()
    units = [0, 0, 2, 0, 1, height_unit, height_unit, density_unit, 1, 1]
    head[4224:4244] = np.array(units, "<i2").tobytes()
    path.write_bytes(bytes(head) + layers.astype("<i2").tobytes())
    return path


def ascii_grid(path, values, *, cell=30.0, west=0.0, south=0.0):
    """Esri ASCII grid: rows from the north, no-data value -9999."""
    lines = [
        f"ncols {values.shape[1]}",
        f"nrows {values.shape[0]}",
        f"xllcorner {west}",
        f"yllcorner {south}",
    ]
    lines += [f"cellsize {cell}", "NODATA_value -9999"]
    rows = [" ".join(f"{v:.9g}" for v in row) for row in np.where(np.isfinite(values), values, -9999)]
    path.write_text("\n".join([*lines, *rows]) + "\n")
    return path


def tiff(
    path, values, *, cell=30.0, west=500_000.0, north=4_300_000.0, projection="EPSG:32610", nodata=-9999
):
    """A GeoTIFF of one band."""
    rasterio = pytest.importorskip("rasterio")
    with rasterio.open(
        path, "w", driver="GTiff", width=values.shape[1], height=values.shape[0], count=1, dtype=values.dtype,
        crs=projection, transform=rasterio.transform.from_origin(west, north, cell, cell), nodata=nodata,
    ) as file:  # fmt: skip
        file.write(values, 1)
    return path


def cf(path, *, name="hfx", times=(0, 60), units="seconds since 2020-07-01 18:00:00"):
    flux = np.random.default_rng(4).uniform(0, 1e5, (len(times), 5, 6)).astype(np.float32)
    with netCDF4.Dataset(path, "w") as f:
        for dim, size in (("t", len(times)), ("y", 5), ("x", 6)):
            f.createDimension(dim, size)
        f.createVariable("t", "f8", ("t",))[:] = times
        f["t"].units = units
        for axis, dim, unit, values in (
            ("la", "y", "degrees_north", 39 + 0.001 * np.arange(5)),
            ("lo", "x", "degrees_east", -120 + 0.001 * np.arange(6)),
        ):
            f.createVariable(axis, "f8", (dim,))[:] = values
            f[axis].units = unit
        variable = f.createVariable(name, "i2", ("t", "y", "x"), fill_value=-1)
        variable.scale_factor, variable.add_offset = 10.0, 5.0
        variable.set_auto_maskandscale(False)
        variable[:] = np.where(flux > 9e4, -1, flux / 10).astype(np.int16)
        raw = variable[:]
    return path, np.where(raw == -1, np.nan, raw * 10.0 + 5.0)


def said(run):
    """Assumptions that a converted run names, as one text."""
    return " ".join(tomllib.loads((Path(run.path) / "run.toml").read_text())["source"]["assumptions"])
