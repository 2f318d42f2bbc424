"""Solved flames: blocks of the mixture fraction over time, from which flames are drawn.

A block is a loop of frames of a flame that is one flame length L high (its visible tips, half of the time),
with lengths in L and times in sqrt(L / g), so that it serves flames of any size (Froude scaling). Lines
of fire are periodic along y, and the wind blows towards +x. `data/flames/solve.py` computes the blocks. Needs
no Blender.
"""

from __future__ import annotations

import zipfile
import zlib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core.flames import FlameBlock as CoreBlock
from firetwin_core.flames import FlameLibrary
from numpy.typing import NDArray

from ...data.flames import FOLDER
from ...errors import input_error

KINDS = ("calm", "breeze", "wind", "crown")
SEEDS = (1, 2)

_FIELDS = ("codes", "rise", "cell", "front", "interval", "fade", "wind", "crown")
_LARGEST = 1 << 27  # bytes of an unpacked block
_ALONG = 8  # cells along y are a multiple of it, for mip levels


@dataclass(frozen=True)
class FlameBlock:
    """A loop of frames of a solved flame.

    Attributes
    ----------
    codes : (frames, nz, ny, nx) uint8. Code q is the mixture fraction Z = 4 (q / 255)^2 in units of its
        stoichiometric value. Periodic along y; z = 0 is the ground.
    rise : (nz,) float32, mean vertical speed of hot gas, sqrt(gL).
    cell : edge of a cell, L.
    front : position along x of the leading edge of burning fuel, or of a trunk, L from the first face.
    interval : time between frames, sqrt(L / g).
    fade : number of last frames that blend into the first ones.
    wind : speed of the wind, sqrt(gL).
    crown : base, top and radius of the foliage of a burning crown, L; zeros for a line. The trunk is in the
        middle along y.
    """

    codes: NDArray[np.uint8]
    rise: NDArray[np.float32]
    cell: float
    front: float
    interval: float
    fade: int
    wind: float
    crown: tuple[float, float, float] = (0.0, 0.0, 0.0)


def load(kind: str, seed: int = 1) -> FlameBlock:
    """Return a block of the library; `kind` is one of `KINDS`, `seed` one of `SEEDS`.

    Raises
    ------
    InputError
        If the file is missing, damaged or larger than a block can be.
    """
    return read(Path(FOLDER) / f"{kind}_{seed}.npz")


@lru_cache(maxsize=1)
def library() -> FlameLibrary:
    """Return the library of all blocks, for `FlameVolume`."""
    *lines, crowns = ([_core_block(kind, seed) for seed in SEEDS] for kind in KINDS)
    return FlameLibrary(lines, crowns)


def _core_block(kind: str, seed: int) -> CoreBlock:
    block = load(kind, seed)
    scale = {name: getattr(block, name) for name in ("cell", "front", "interval", "fade", "wind")}
    return CoreBlock(block.codes, block.rise, **scale, periodic=kind != "crown", soft=True)


def read(path: Path) -> FlameBlock:
    """Read and check the file of a block."""
    try:
        _check_size(path)
        with np.load(path, allow_pickle=False) as stored:
            block = _block({name: stored[name] for name in _FIELDS})
    except OSError as error:
        raise input_error(path, f"cannot be read ({error.strerror}); install Firetwin again") from error
    except (ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise input_error(path, f"not a block of flames ({error}); install Firetwin again") from error
    return block


def _check_size(path: Path) -> None:
    """Raise a ValueError if the arrays of a file are too large to unpack."""
    with zipfile.ZipFile(path) as archive:
        size = sum(member.file_size for member in archive.infolist())
    if size > _LARGEST:
        raise ValueError(f"{size} bytes, more than {_LARGEST}")


def _block(fields: dict[str, Any]) -> FlameBlock:
    """Return the block of stored arrays; a ValueError tells what is wrong with them."""
    codes, rise = fields["codes"], fields["rise"]
    if codes.dtype != np.uint8 or codes.ndim != 4 or 0 in codes.shape or codes.shape[2] % _ALONG:
        raise ValueError(f"codes are {codes.dtype} of shape {codes.shape}")
    if rise.dtype != np.float32 or rise.shape != codes.shape[1:2] or not np.isfinite(rise).all():
        raise ValueError(
            f"rise is {rise.dtype} of shape {rise.shape}, not finite float32 of {codes.shape[1:2]}"
        )
    cell, front, interval, wind = (float(fields[name]) for name in ("cell", "front", "interval", "wind"))
    fade = int(fields["fade"])
    if not (0 < cell < 1 and 0 < interval < 1 and np.isfinite(front) and 0 <= wind < 10):
        raise ValueError(f"cell {cell}, interval {interval}, front {front}, wind {wind}")
    if not 0 < fade < len(codes):
        raise ValueError(f"{fade} of {len(codes)} frames fade")
    base, top, radius = map(float, fields["crown"])
    codes.setflags(write=False)
    return FlameBlock(codes, rise, cell, front, interval, fade, wind, (base, top, radius))
