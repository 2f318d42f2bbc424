"""Write an ensemble folder, member by member; it gets its name last."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ... import files
from ...errors import Error, InputError, input_error, writing
from ...run.models import write as run_write
from .ensemble import ARRIVAL
from .manifest import MANIFEST, LeftOut, Manifest, Member, text

Read = tuple[Member, NDArray | InputError | str]
"""Member, and its arrival times (ny, nx), s since the issue time; or the reason why it is left out."""


def write(
    out: Path,
    manifest: Manifest,
    latitude: NDArray[np.float64],
    longitude: NDArray[np.float64],
    members: Iterable[Read],
    amend: Callable[[Manifest], Manifest] | None = None,
) -> Manifest:
    """Write an ensemble to a folder that does not exist, and return its manifest.

    Parameters
    ----------
    manifest
        Its members are replaced by `members` with arrival times; others are left out, with the reason.
    latitude, longitude
        Cell centres (ny,) and (nx,), degrees.
    amend
        Change of the manifest after all members are written.

    Raises
    ------
    InputError
        The folder exists, the disk is full, a member has another shape, or none has arrival times.
    """
    run_write.check(out)
    part = run_write.part_of(out)
    shutil.rmtree(part, ignore_errors=True)
    try:
        with writing(out):
            part.mkdir(parents=True)
            kept, left_out = _members(part / ARRIVAL, (len(latitude), len(longitude)), members)
            if not kept:
                why = f"; {left_out[0].name}: {left_out[0].reason}" if left_out else ""
                raise input_error(out, f"no member has arrival times{why}")
            complete = _complete(manifest, kept, left_out)
            complete = amend(complete) if amend else complete
            np.save(part / "latitude.npy", latitude)
            np.save(part / "longitude.npy", longitude)
            files.write_text(part / MANIFEST, text(complete))
            if out.is_dir():
                out.rmdir()
            part.rename(out)
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return complete


def _members(
    path: Path, shape: tuple[int, int], members: Iterable[Read]
) -> tuple[list[Member], list[LeftOut]]:
    """Append the arrival times of each member to a file, whose header gets their count last."""
    kept: list[Member] = []
    left_out: list[LeftOut] = []
    with path.open("w+b") as file:
        _header(file, 0, shape)
        for member, values in members:
            if isinstance(values, InputError):
                values = values.reason
            if isinstance(values, str):
                left_out.append(LeftOut(member.name, values))
                continue
            file.write(_checked(path, member, values, shape).data.cast("B"))
            kept.append(member)
        file.seek(0)
        _header(file, len(kept), shape)
    return kept, left_out


def _header(file: BinaryIO, count: int, shape: tuple[int, int]) -> None:
    """Write the header of an .npy file; NumPy pads it, so that any count of members takes the same bytes."""
    head = {"descr": "<f4", "fortran_order": False, "shape": (count, *shape)}
    np.lib.format.write_array_header_1_0(file, head)


def _checked(path: Path, member: Member, values: NDArray, shape: tuple[int, int]) -> NDArray[np.float32]:
    """Check the arrival times of one member.

    Raises
    ------
    InputError
        They have another shape, or a time is -inf.
    """
    values = np.ascontiguousarray(values, "<f4")
    if values.shape != shape:
        reason = f"member {member.name} has {values.shape} cells, and the ensemble {shape}"
        raise input_error(path, f"{reason}; all members need the same grid")
    if (values == -np.inf).any():
        raise input_error(path, f"member {member.name} has an arrival time of -inf; use NaN or +inf")
    return values


def _complete(manifest: Manifest, kept: list[Member], left_out: list[LeftOut]) -> Manifest:
    """Fill in members and horizon.

    Raises
    ------
    Error
        Neither the manifest nor a member gives the length of the forecast.
    """
    ends = [member.end for member in kept if np.isfinite(member.end)]
    horizon = manifest.horizon or max(ends, default=0.0)
    if not horizon > 0.0:
        raise Error("the ensemble has no horizon; give the length of the forecast")
    return replace(manifest, members=tuple(kept), left_out=(*manifest.left_out, *left_out), horizon=horizon)
