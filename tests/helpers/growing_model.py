"""A model that is still running: writes a small front that moves east, one time at a time."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np

CELLS, CELL, STEP = 24, 30.0, 600.0
START = "seconds since 2020-07-01 20:00:00"
LATITUDE = 38.9 + np.arange(CELLS) * CELL / 111_000.0
LONGITUDE = -120.6 + np.arange(CELLS) * CELL / 86_600.0


def flux(index: int, factor: float = 1.0) -> np.ndarray:
    """Heat flux (ny, nx), W/m2, at a time: a band three cells wide that moves two cells per time."""
    column = np.arange(CELLS)[None, :] + 0.3 * np.abs(np.arange(CELLS)[:, None] - CELLS / 2)
    head = 4.0 + 2.0 * index
    return (factor * 40e3 * ((column <= head) & (column > head - 3.0))).astype(np.float32)


def _netcdf(path: Path, kind: str):
    import netCDF4

    data = netCDF4.Dataset(path, "w", format=kind)
    data.createDimension("time", None)
    for name, axis, units in (("lat", LATITUDE, "degrees_north"), ("lon", LONGITUDE, "degrees_east")):
        data.createDimension(name, CELLS)
        data.createVariable(name, "f8", (name,))[:] = axis
        data[name].units = units
    data.createVariable("time", "f8", ("time",)).units = START
    data.createVariable("heat_flux", "f4", ("time", "lat", "lon"))
    data.createVariable("surface_fuel", "f4", ("lat", "lon"))[:] = 0.8
    data.createVariable("elevation", "f4", ("lat", "lon"))[:] = 100.0
    return data


class Writer:
    """Writer of one file or store: ``netcdf3``, ``netcdf4`` or ``zarr``."""

    def __init__(self, path: Path, kind: str) -> None:
        self.kind, self.count = kind, 0
        if kind == "zarr":
            import zarr

            self.data = group = zarr.open_group(path, mode="w")
            for name, axis, units in (("lat", LATITUDE, "degrees_north"), ("lon", LONGITUDE, "degrees_east")):
                group.create_array(name, data=axis).attrs["units"] = units
            group.create_array("surface_fuel", data=np.full((CELLS, CELLS), 0.8, np.float32))
            group.create_array("elevation", data=np.full((CELLS, CELLS), 100.0, np.float32))
            group.create_array("time", shape=(0,), chunks=(1,), dtype="f8").attrs["units"] = START
            shape, chunks = (0, CELLS, CELLS), (1, CELLS, CELLS)
            group.create_array("heat_flux", shape=shape, chunks=chunks, dtype="f4")
        else:
            self.data = _netcdf(path, "NETCDF4" if kind == "netcdf4" else "NETCDF3_64BIT_OFFSET")

    def append(self, factor: float = 1.0) -> None:
        """Write the next time, as a model does."""
        index = self.count
        if self.kind == "zarr":
            time_array, array = self.data["time"], self.data["heat_flux"]
            array.resize((index + 1, CELLS, CELLS))
            time_array.resize((index + 1,))
            time_array[index] = STEP * index
            array[index] = flux(index, factor)
        else:
            self.data["time"][index] = STEP * index
            self.data["heat_flux"][index] = flux(index, factor)
            self.data.sync()
        self.count += 1

    def close(self) -> None:
        """Close the file."""
        if self.kind != "zarr":
            self.data.close()


class Process:
    """A model in a separate process, which writes a time for each call of `append`."""

    def __init__(self, path: Path, kind: str, factor: float = 1.0) -> None:
        words = [sys.executable, __file__, path, kind, factor]
        pipes = {name: subprocess.PIPE for name in ("stdin", "stdout", "stderr")}
        self.process = subprocess.Popen([*map(str, words)], text=True, **pipes)

    def append(self) -> None:
        """Write the next time, and wait until it is written."""
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        assert self.process.stdout.readline() == "written\n", self.process.stderr.read()

    def close(self) -> tuple[int, str, str]:
        """Close the file; return the exit status and the remaining output."""
        out, errors = self.process.communicate()
        return self.process.returncode, out, errors

    def kill(self) -> None:
        """Kill the process in the middle of its run."""
        self.process.kill()
        self.process.communicate()


if __name__ == "__main__":
    writer = Writer(Path(sys.argv[1]), sys.argv[2])
    while sys.stdin.readline():
        writer.append(float(sys.argv[3]))
        print("written", flush=True)
    writer.close()
    print("closed", flush=True)
