"""Reader of QUIC-Fire: a folder for each simulation, with ``Output/mburnt_integ-<seconds>.bin``.

- ``mburnt_integ``: per cent of the fuel mass that has burned, one Fortran record of float32 (y, x), rows from
  the south. A cell burns from the middle between the last output without loss and the first with a loss.
- ``QU_simparams.inp``: numbers and sizes of cells, UTM coordinates of the south-west corner
- ``QUIC_fire.inp``: ignition as a Unix time

Names and order of lines: silvxlabs/quicfire-tools (inputs.py, outputs.py).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, input_error, reading
from ....files import check_size, check_text_size
from ....limits import UNPACKED_BYTES
from ....run.models import raster
from ....run.models.grid import Grid
from ....run.models.model import Options
from .. import write
from ..manifest import Member
from ..member_set import MemberSet, attempt, burned, check_start, describe

NAME, ORDER = "QUIC-Fire", 60

_MASS = re.compile(r"mburnt_integ-(\d+)\.bin$")
_GRID, _FIRE = "QU_simparams.inp", "QUIC_fire.inp"
_MOST = 1 << 26  # cells
_NORTH = 14  # number of the letter N: UTM bands from it on are in the northern hemisphere


@dataclass(frozen=True)
class _Set:
    """Inputs of a simulation: cells (ny, nx), their sides (m), corner (m), projection and ignition."""

    shape: tuple[int, int]
    side: tuple[float, float]
    corner: tuple[float, float]
    projection: str
    issued: datetime


def sniff(paths: list[Path]) -> bool:
    """Check for folders of simulations."""
    return bool(_folders(paths))


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each folder."""
    folders = _folders(paths)
    opened = {folder: attempt(_inputs, folder) for folder in folders}
    good = {folder: each for folder, each in opened.items() if isinstance(each, _Set)}
    if not good:
        raise input_error(paths[0], f"none of its {len(folders)} folders can be read; {opened[folders[0]]}")
    first_folder, first = next(iter(good.items()))
    for folder, each in good.items():
        check_start(folder, each.issued, first_folder, first.issued)
        if replace(each, issued=first.issued) != first:
            raise input_error(
                folder, f"has other cells than {first_folder.name}; members need cells of one grid"
            )
    grid, note = _grid(first, options)
    horizon = horizon or float(max(max(_masses(folder)) for folder in good))
    issued = replace(options, start=options.start or first.issued)
    head, _ = describe(issued, paths[0], NAME, horizon, f"{len(folders)} folders of {NAME}")
    notes = [
        "a cell burns from the middle between the last output without loss of mass and the first with it",
        "" if options.start else f"issue time is the ignition in {_FIRE}, as UTC",
        note,
    ]
    return MemberSet(head, grid, burned(_members(opened), horizon), notes)


def _members(opened: dict[Path, _Set | InputError]) -> Iterator[write.Read]:
    for folder, inputs in opened.items():
        if isinstance(inputs, InputError):
            yield Member(folder.name), inputs
        else:
            masses = _masses(folder)
            yield Member(folder.name, end=float(max(masses))), attempt(_arrival, masses, inputs.shape)


def _arrival(masses: dict[int, Path], shape: tuple[int, int]) -> NDArray[np.float32]:
    """Return arrival times (ny, nx), s, rows from the south, from the outputs by time (s)."""
    arrival = np.full(shape, np.inf, np.float32)
    before = None
    for seconds, path in masses.items():
        new = (_lost(path, shape) > 0.0) & np.isinf(arrival)
        arrival[new] = seconds if before is None else (before + seconds) / 2.0
        before = seconds
    return arrival


def _lost(path: Path, shape: tuple[int, int]) -> NDArray[np.float32]:
    """Read the burned mass (ny, nx), per cent."""
    size = 4 * shape[0] * shape[1]
    with reading(path, "output of QUIC-Fire"):
        check_size(path, UNPACKED_BYTES)
        data = path.read_bytes()
    if len(data) != size + 8 or data[:4] != np.array(size, "<i4").tobytes() or data[:4] != data[-4:]:
        raise input_error(path, f"holds {len(data):,} bytes, not a record of {shape[0]} x {shape[1]} cells")
    values = np.frombuffer(data, "<f4", shape[0] * shape[1], 4).reshape(shape)
    if not ((values >= 0.0) & (values <= 100.01)).all():
        raise input_error(path, "has values outside of 0 to 100 per cent; it is damaged")
    return values


def _inputs(folder: Path) -> _Set:
    """Read the inputs of a simulation."""
    grid, fire = _lines(folder / _GRID), _lines(folder / _FIRE)
    nx, ny, _, dx, dy = (_number(folder / _GRID, grid, at) for at in range(1, 6))
    if not (1 <= nx * ny <= _MOST and nx >= 1 and dx > 0 and dy > 0):
        raise input_error(folder / _GRID, f"has {nx:g} x {ny:g} cells of {dx:g} x {dy:g} m; correct it")
    x, y, zone, letter, turned = (
        _after(grid, word) for word in ("UTMX", "UTMY", "UTM zone[^l]*$", "UTM zone l", "rot")
    )
    if turned:
        raise input_error(folder / _GRID, f"is turned by {turned:g} degrees; grids are upright")
    times = next((at for at, line in enumerate(fire) if "FIRE TIMES" in line), -1)
    begun = _number(folder / _FIRE, fire, times + 1)
    if times < 0 or not 0 < begun < 4e9:
        raise input_error(folder / _FIRE, "has no ignition as a Unix time after FIRE TIMES")
    side = 6 if letter >= _NORTH else 7
    projection = f"EPSG:32{side}{int(zone):02}" if (x or y) and 1 <= zone <= 60 else ""
    return _Set((int(ny), int(nx)), (dy, dx), (x, y), projection, datetime.fromtimestamp(begun, UTC))


def _lines(path: Path) -> list[str]:
    with reading(path):
        check_text_size(path)
        return path.read_text(encoding="utf-8", errors="replace").splitlines()


def _number(path: Path, lines: list[str], at: int) -> float:
    """Read the number at the beginning of a line; a comment follows it."""
    try:
        return float(lines[at].split("!")[0])
    except (ValueError, IndexError):
        raise input_error(path, "has no number where QUIC-Fire has one", line=at + 1) from None


def _after(lines: list[str], comment: str) -> float:
    """Return the number of the line with a comment; 0 without one."""
    for line in lines:
        value, _, said = line.partition("!")
        if re.search(comment, said.strip()):
            try:
                return float(value)
            except ValueError:
                continue
    return 0.0


def _grid(said: _Set, options: Options) -> tuple[Grid, str]:
    x, y = (
        (np.arange(count) + 0.5) * side for count, side in zip(said.shape[::-1], said.side[::-1], strict=True)
    )
    projection = options.projection or said.projection
    if projection:
        return Grid.projected(said.corner[0] + x, said.corner[1] + y, projection), ""
    return raster.local(x, y, options.at)


def _masses(folder: Path) -> dict[int, Path]:
    """Return the outputs of burned mass by time, s."""
    places = [each for each in (folder, folder / "Output") if each.is_dir()]
    matches = {path: _MASS.match(path.name) for place in places for path in place.iterdir()}
    return dict(sorted((int(match[1]), path) for path, match in matches.items() if match))


def _folders(paths: list[Path]) -> list[Path]:
    """Return the folders of simulations among the paths, and in them."""
    folders = [path for path in paths if path.is_dir()]
    inner = [each for path in folders for each in sorted(path.iterdir()) if each.is_dir()]
    return [each for each in [*folders, *inner] if (each / _FIRE).is_file() and _masses(each)]
