"""Fuzzing of fire models' files: damaged files, each converted in a separate process to a run or an error.

``python damage.py KIND[,KIND...] FOLDER COUNT SEED`` writes a line of JSON for each. An error must be one
readable line.
"""

import contextlib
import importlib
import io
import json
import mmap
import os
import shutil
import signal
import struct
import subprocess
import sys
import time
import warnings
from pathlib import Path
from typing import NamedTuple

import model_files as made
import numpy as np
import odd_netcdf
import small_run

KINDS = ("wrf", "cfbm", "forefire", "landscape", "tiff", "ascii", "lcp", "npz", "cf", "folder")
CUTS = (0.0, 0.01, 0.3, 0.6, 0.9, 0.999)
"""Fractions of the file's length."""

MEMORY = 6 << 30  # memory limit of a process, bytes
SECONDS = 20  # s of CPU time after which a conversion counts as an endless loop
SILENT = 10  # s of those without a heartbeat: a library hangs, and `convert.PATIENCE` ends that

_heartbeat = mmap.mmap(-1, 8)  # the last one in CPU seconds; shared with the forked processes


class End(NamedTuple):
    """Result of a damaged file: what refused it, the signal that ended it, and its fault."""

    way: str
    said: str
    signal: int
    wrong: str


def files_of(kind, folder):
    """A small file of each kind, and the options that it needs."""
    arrival = np.hypot(*np.mgrid[-8:9, -8:9]) * 30.0
    dated = {"start": "2020-07-01"}
    if kind == "wrf":
        return made.wrf(folder, times=(60,))[0], {}
    if kind == "cfbm":
        return made.cfbm(folder, count=2, shape=(8, 9))[0], {}
    if kind == "forefire":
        return [made.forefire(folder / "ForeFire.0.nc", arrival)], {}
    if kind == "landscape":
        fuel = np.full((1, 1, 17, 17), 3, np.int16)
        box = "-120.01,38.99,-119.99,39.01"
        land = made.landscape(folder / "data.nc", fuel, 100 * fuel, size=2000.0, box=box)
        return [land, made.forefire(folder / "ForeFire.0.nc", arrival, lx=2000.0, ly=2000.0)], {}
    if kind == "tiff":
        path = folder / "time_of_arrival_0000001_0000600.tif"
        return [made.tiff(path, arrival.astype(np.float32))], dated
    if kind == "ascii":
        return [made.ascii_grid(folder / "x_arrival.asc", arrival / 60)], dated
    if kind == "lcp":
        layers = np.full((17, 17, 8), 102, np.int16)
        return [
            made.lcp(folder / "a.lcp", layers),
            made.ascii_grid(folder / "x_arrival.asc", arrival / 60),
        ], dated
    if kind == "cf":
        mapping = folder / "map.toml"
        mapping.write_text('[fields]\nheat_flux = { variable = "hfx", scale = 2.0 }\n')
        return [made.cf(folder / "a.nc")[0], mapping], {}
    if kind == "folder":
        return _run(folder), {}
    path = folder / "a.npz"
    np.savez(path, time_of_arrival=arrival / 60, cell_width=30.0, cell_height=30.0)
    return [path], dated


def _run(folder):
    run = folder / "run"
    run.mkdir()
    (run / "run.toml").write_text(small_run.RUN_TOML)
    for name, values in small_run.small_fields().items():
        small_run.write_field(run, name, values, "text" if name in ("elevation", "latitude") else "npy")
    return sorted(run.iterdir())


def tried(kind, folder, count, seed):
    """Results of `count` damaged files of a kind, created and converted in other processes."""
    return (end for _, end in tried_all([kind], folder, count, seed))


def tried_all(kinds, folder, count, seed):
    """Kinds and results of `count` damaged files of each kind; one process imports the readers for all."""
    command = [sys.executable, __file__, ",".join(kinds), str(folder), str(count), str(seed)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            kind, *end = json.loads(line)
            yield kind, End(*end)
    if process.returncode:
        raise RuntimeError(f"{kinds}: the process that damages files ended with {process.returncode}")


def _damaged(whole, count, rng, cuts):
    """Descriptions of damage to bytes, and the damaged bytes."""
    for share in cuts[:count]:
        yield f"cut to {share}", whole[: int(share * len(whole))]
    odd = {b"PK": odd_netcdf.archive, b"CD": odd_netcdf.netcdf, b"\x89H": odd_netcdf.netcdf}.get(whole[:2])
    for number in range(count - len(cuts)):
        if odd and number % 2:
            yield odd(whole, rng)
        else:
            way = WAYS[number // 2 % len(WAYS) if odd else number % len(WAYS)]
            yield way, damaged(whole, way, rng)


def _flip(data, rng, most=100, within=None):
    for at in rng.integers(0, min(len(data), within or len(data)), rng.integers(1, most)):
        data[at] ^= 1 << int(rng.integers(0, 8))
    return bytes(data)


def _span(data, rng):
    at = int(rng.integers(0, len(data)))
    return at, min(at + int(rng.integers(1, 300)), len(data))


def _block(data, rng):
    at, end = _span(data, rng)
    data[at:end] = bytes([int(rng.choice([0, 0xFF, 0x7F, 0x20, 0x39]))]) * (end - at)
    return bytes(data)


def _insert(data, rng):
    at, end = _span(data, rng)
    data[at:at] = rng.choice(
        [bytes(end - at), b"\x1b[31m\n", b"nan ", b"-1e999 ", b"\xff\xfe", bytes(data[at:end])]
    )
    return bytes(data)


def _leave_out(data, rng):
    at, end = _span(data, rng)
    del data[at:end]
    return bytes(data)


def _move(data, rng):
    (at, end), to = _span(data, rng), int(rng.integers(0, len(data)))
    piece = data[at:end]
    del data[at:end]
    data[to:to] = piece
    return bytes(data)


_DAMAGE = {
    "flips in the head": lambda data, rng: _flip(data, rng, within=4000),
    "flips": _flip,
    "block": _block,
    "cut": lambda data, rng: bytes(data[: rng.integers(0, len(data))]),
    "inserted": _insert,
    "left out": _leave_out,
    "moved": _move,
    "a few": lambda data, rng: _flip(data, rng, most=4),
}


WAYS = tuple(_DAMAGE)


def damaged(data, way, rng):
    """Bytes damaged in one of the ways."""
    return _DAMAGE[way](bytearray(data), rng)


def _convert(paths, options, folder):
    """Convert, and read the whole run; returns what refused it."""
    from firetwin import cli
    from firetwin.jobs import convert
    from firetwin.run import info, readers, zone
    from firetwin.run.models import heartbeat

    out, said = folder / "out", io.StringIO()
    with contextlib.redirect_stderr(said), heartbeat.to(_beat):
        try:
            if options is None:
                run = readers.open(paths[0].parent)
            else:
                convert.in_process(paths, out, options)
                run = readers.open(out)
            info.page(info.gather(run, zone.time_zone(run)))
        except Exception as error:
            cli._report(error)
            if options is not None and (out / "run.toml").exists():
                said.write(" (and yet there is a run)")
    return said.getvalue()


def _beat():
    _heartbeat[:] = struct.pack("d", time.process_time())


def _hangs(kind, used):
    """Fault of a conversion in an endless loop; its parent ends one without a heartbeat."""
    silent = used - struct.unpack("d", _heartbeat)[0]
    return "" if kind != "folder" and silent > SILENT else "hangs"


def _main(kinds, folder, count, seed):
    """Try the kinds, each in its own folder, after importing all readers once for all forks."""
    from firetwin.run import readers

    warnings.simplefilter("ignore")
    os.fsync = lambda descriptor: None  # no test cuts the power
    for name in ("netCDF4", "rasterio", "pyproj", "firetwin.run.models.write", "firetwin.run.info"):
        importlib.import_module(name)
    readers.models()
    for kind in kinds:
        (folder / kind).mkdir()
        _try_kind(kind, folder / kind, count, seed)


def _try_kind(kind, folder, count, seed):
    """Damage one of the files at a time, convert them in a fork, and restore the file."""
    import polite

    paths, options = files_of(kind, folder)
    asked = None if kind == "folder" else [options.get("start", ""), "", "", 0.0]
    rng = np.random.default_rng(seed)
    ways = [list(range(count))[k :: len(paths)] for k in range(len(paths))]
    if (end := _forked(paths, asked, folder)) != ("", 0):
        raise RuntimeError(f"{kind}: the whole files are not read: {end}")
    for path, numbers in zip(paths, ways, strict=True):
        shutil.rmtree(folder / "out", ignore_errors=True)
        whole, cuts = path.read_bytes(), CUTS if path == paths[0] else ()
        for way, data in _damaged(whole, len(numbers), rng, cuts):
            path.write_bytes(data)
            said, status = _forked(paths, asked, folder)
            ended = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
            hangs = ended in (signal.SIGXCPU, signal.SIGKILL)
            wrong = polite.rude(said) if not ended else _hangs(kind, SECONDS) if hangs else ""
            if wrong:
                kept = Path("build/fuzz/findings") / f"{kind}-{seed}-{path.name}"
                kept.parent.mkdir(parents=True, exist_ok=True)
                kept.write_bytes(data)
            print(json.dumps([kind, f"{path.name}: {way}", said, ended, wrong]), flush=True)
            shutil.rmtree(folder / "out", ignore_errors=True)
        path.write_bytes(whole)


def _forked(paths, options, folder):
    """Error of a conversion in a forked process, and how the process ended."""
    _heartbeat[:] = bytes(8)
    ear, mouth = os.pipe()
    pid = os.fork()
    if pid == 0:
        import resource  # not on Windows

        os.close(ear)
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 5))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        with os.fdopen(mouth, "w") as file:
            file.write(_convert(paths, options, folder))
        os._exit(0)
    os.close(mouth)
    with os.fdopen(ear) as file:
        said = file.read()
    return said, os.waitpid(pid, 0)[1]


if __name__ == "__main__":
    _main(sys.argv[1].split(","), Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]))
