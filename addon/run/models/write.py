"""Run writer: writes a model as a run in steps, resumable after an interruption, and atomically.

Data goes to a hidden folder next to the run's. It gets run.toml after all else is on the disk, and the run's
name last. A journal records how many times have reached the disk; these are not computed again.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import time
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ... import files, output
from ...errors import Error, InputError, input_error, reading, writing
from ...progress import Progress, size
from .. import bounds, opening
from .model import LONGEST, Model

JOURNAL = "journal.json"
_OFTEN = 1 << 29  # bytes between journal entries
_SECONDS = 15.0
FILL = {
    "heat_flux": 0.0,
    "burned_fraction": 0.0,
    "smoke_3d": 0.0,
    "fuel_arrival_time": np.nan,
    "fuel_category": np.nan,
}
_LARGEST = 1 << 31  # bytes of one time of one field at most


def part_of(out: Path) -> Path:
    """Return the temporary folder that becomes `out`."""
    return out.with_name(f".{out.name}.part")


def check(out: Path) -> None:
    """Check that a run can be written to a place.

    Raises
    ------
    InputError
        The place is taken.
    """
    output.refuse_run_folders(out)
    if part_of(out).is_symlink():
        raise input_error(part_of(out), "is a link, which is not followed; remove it")
    if out.exists() and not (out.is_dir() and not any(out.iterdir())):
        raise input_error(out, "already exists; remove it or choose another path")


def write(model: Model, out: Path, inputs: str, progress: Progress) -> None:
    """Write a run.

    Parameters
    ----------
    inputs
        Fingerprint text of the inputs. Data written from other inputs is discarded.

    Raises
    ------
    InputError
        The disk is full, or the model makes no valid run.
    """
    times = model.times
    if not np.isfinite(times).all() or (np.diff(times) <= 0).any() or np.ptp(times) > LONGEST:
        raise input_error(model.files[0], "its times are invalid: they do not ascend, or span centuries")
    part = part_of(out)
    try:
        placed = {before: grid.placed for before, grid in model.grids.items()}
    except Error as error:
        raise input_error(model.files[0], str(error)) from None
    shapes = {
        name: (
            len(model.times),
            *([model.levels[name]] if name in model.levels else []),
            *model.grid_of(name).placed.shape,
        )
        for name in model.moving
    }
    _room(out, sum(4 * int(np.prod(shape, dtype=np.float64)) for shape in shapes.values()))
    if max((4 * np.prod(shape[1:], dtype=np.float64) for shape in shapes.values()), default=0) > _LARGEST:
        raise input_error(model.files[0], f"a grid of {placed[''].shape} cells is more than can be held")
    with writing(out):
        out.parent.mkdir(parents=True, exist_ok=True)
        done = _done(part, inputs)
        part.mkdir(exist_ok=True)
        _moving(model, shapes, part, inputs, done, progress)
        for name, get in model.still.items():
            where = model.grid_of(name).placed
            with reading(model.files[0]):
                values = where.put(get(), FILL.get(name))
            _save(part / f"{name}.npy", values, where.shape)
        for before, where in placed.items():
            _save(part / f"{before}latitude.npy", where.latitude)
            _save(part / f"{before}longitude.npy", where.longitude)
        (part / JOURNAL).unlink(missing_ok=True)
        files.write(
            part / "run.toml",
            lambda path: path.write_text(description(model, inputs), encoding="utf-8", newline="\n"),
        )
        _check(part, model)
        if out.is_dir():
            out.rmdir()
        part.rename(out)


def _check(part: Path, model: Model) -> None:
    """Open the new run as a check; remove the result of a damaged model if this fails."""
    try:
        run = opening.open(part)
        bounds.check_times(run)
        bounds.check_heights(run)
        bounds.check_flux(run)
    except InputError as error:
        shutil.rmtree(part, ignore_errors=True)
        reason = f"makes no run: {Path(error.path).stem}: {error.reason}; it is most likely damaged"
        raise input_error(model.files[0], reason) from None


def _moving(
    model: Model, shapes: dict[str, tuple[int, ...]], part: Path, inputs: str, done: int, progress: Progress
) -> None:
    """Write all time-dependent fields, time by time; one thread reads while another writes."""
    open_files: dict[str, BinaryIO] = {}
    pending: list[Future] = []
    count, what = len(model.times), "times"
    try:
        for name, shape in shapes.items():
            open_files[name] = _open(part / f"{name}.npy", shape, done)
        since, last = 0, time.monotonic()
        with ThreadPoolExecutor(1) as pool:
            for index in range(done, count):
                progress(index, count, what)
                for name, get in model.moving.items():
                    with reading(model.files[0]):
                        values = on_run_grid(model, name, get(index))
                    if values.shape != shapes[name][1:]:
                        reason = f"{name} is {values.shape} at time {index + 1}, not {shapes[name][1:]}"
                        raise input_error(model.files[0], reason)
                    pending.append(pool.submit(_all, open_files[name], values))
                    since += values.nbytes
                while len(pending) > len(model.moving):
                    pending.pop(0).result()
                if since > _OFTEN or time.monotonic() - last > _SECONDS:
                    while pending:
                        pending.pop(0).result()
                    _journal(part, inputs, index + 1, open_files)
                    since, last = 0, time.monotonic()
            while pending:
                pending.pop(0).result()
        _journal(part, inputs, count, open_files)
        progress(count, count, what)
    finally:
        for file in open_files.values():
            file.close()


def on_run_grid(model: Model, name: str, values: NDArray) -> NDArray[np.float32]:
    """Resample a horizontal or 3D field to the run's grid."""
    where = model.grid_of(name).placed
    return where.put_share(values) if name == "burned_fraction" else where.put(values, FILL.get(name))


def _open(path: Path, shape: tuple[int, ...], done: int) -> BinaryIO:
    """Open an .npy file of this shape for appending from the time `done`."""
    file = path.open("r+b" if done else "wb")
    np.lib.format.write_array_header_1_0(file, {"descr": "<f4", "fortran_order": False, "shape": shape})
    file.seek(file.tell() + done * 4 * math.prod(shape[1:]))
    file.truncate()
    return file


def _all(file: BinaryIO, values: NDArray[np.float32]) -> None:
    file.write(np.ascontiguousarray(values, "<f4").data.cast("B"))


def _journal(part: Path, inputs: str, done: int, open_files: dict[str, BinaryIO]) -> None:
    for file in open_files.values():
        file.flush()
        os.fsync(file.fileno())
    text = json.dumps({"inputs": inputs, "times": done})
    files.write_text(part / JOURNAL, text)


def _done(part: Path, inputs: str) -> int:
    """Count the times already written from the same inputs; data from other inputs is removed."""
    try:
        journal = files.read_json(part / JOURNAL)
        if journal["inputs"] == inputs:
            return int(journal["times"])
    except (OSError, ValueError, KeyError, TypeError):
        pass
    shutil.rmtree(part, ignore_errors=True)
    return 0


def _save(path: Path, values: NDArray, shape: tuple[int, ...] | None = None) -> None:
    if shape is not None and values.shape != shape:
        raise input_error(path, f"has shape {values.shape} where the grid has {shape}")
    files.write(path, lambda part: np.save(part, values))


def _room(out: Path, need: int) -> None:
    folder = next(each for each in (out.absolute(), *out.absolute().parents) if each.exists())
    there = part_of(out)
    free = shutil.disk_usage(folder).free + sum(each.stat().st_size for each in there.glob("*.npy"))
    if need > free:
        raise input_error(out, f"needs {size(need)} and the disk has {size(free)} free")


def description(model: Model, inputs: str) -> str:
    """Write the text of run.toml; `inputs` as in `write`."""
    lines = [
        f"name = {toml_text(model.name)}",
        f"start = {model.start:%Y-%m-%dT%H:%M:%S.%f}Z",
        f"times_s = [{', '.join(repr(float(time)) for time in model.times)}]",
        'vertical = "orthometric"',
    ]
    if model.zone:
        lines.append(f"zone = {toml_text(model.zone)}")
    if model.mean_s is not None:
        lines.append(f"mean_s = {float(model.mean_s)!r}")
    lines += [
        "",
        "[source]",
        f"model = {toml_text(model.source)}",
        f"version = {toml_text(model.version or 'not said')}",
        f"projection = {toml_text(' '.join(model.projection.split()) or 'latitude and longitude')}",
        f"files = [{', '.join(toml_text(path.name) for path in model.files)}]",
        f"inputs = {toml_text(inputs)}",
        "assumptions = [",
        *(f"  {toml_text(text)}," for text in [*model.assumptions, *moved(model)]),
        "]",
    ]
    return "\n".join(lines) + "\n"


def moved(model: Model) -> list[str]:
    """List the position errors of resampled grids, each once."""
    said = {
        grid: f"{before.replace('_', ' ')}grid: {grid.placed.error}" for before, grid in model.grids.items()
    }
    return [text for grid, text in said.items() if grid.placed.error]


def toml_text(value: str) -> str:
    """Encode a TOML string with JSON's escapes."""
    return json.dumps("".join(each for each in value if each.isprintable()), ensure_ascii=False)
