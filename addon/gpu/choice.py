"""Choice between GPU and processor for Cycles."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass

from ..progress import duration
from .cards import Card

COMPILE_MINUTES = 6, 10
"""Minutes that a driver takes to compile the kernels of Blender 4.5 once, on one thread: "about 6 min" on an
H200, "10 mins" on servers (TRELLIS, issue 204)."""
FRAME, MEGASAMPLE = 5.0, 9.0
"""Processor seconds that a GPU saves per frame, and per million samples of it: a fit to
examples/king_fire.toml with all its passes. A frame of 1920 x 1080 took about 130 processor seconds on the
host of an H100, and 65 with the H100, which leaves all work but ray tracing to the processor; 28 and 16 with
640 x 360."""


@dataclass(frozen=True)
class Choice:
    """Decision for a render, and the sentence that explains it: "Cycles renders on " and `text`."""

    gpu: bool
    text: str


def estimate_saving(frames: int, pixels: int, samples: int, cores: int | None = None) -> float:
    """Estimate the time that a GPU with ready kernels saves, s; wrong by a factor of two for unusual scenes.

    Parameters
    ----------
    pixels
        Number of pixels of a picture.
    cores
        Processor cores; None: those that this process may use.
    """
    return frames * (FRAME + MEGASAMPLE * pixels * samples / 1e6) / (cores or _count_cores())


def _count_cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def choose(wanted: str, gpus: str, uncompiled: Sequence[Card], saved_s: float, blender: str) -> Choice:
    """Choose the device of a render.

    Parameters
    ----------
    wanted
        "auto", "cpu" or "gpu".
    gpus
        Names of the GPUs with the interface, such as "NVIDIA L4 by OptiX"; empty without a GPU.
    uncompiled
        Cards among them whose kernels would be compiled first.
    saved_s
        Estimated time that the GPU saves, without compilation, s.
    blender
        Version of Blender, for the sentence.
    """
    if wanted == "cpu":
        return Choice(False, "the processor")
    if not gpus:
        return Choice(False, "the processor (no GPU found)")
    if not uncompiled:
        return Choice(True, gpus)
    names = " and ".join(dict.fromkeys(card.architecture for card in uncompiled))
    wait = f"{COMPILE_MINUTES[0]} to {COMPILE_MINUTES[1]} minutes"
    why = f"as Blender {blender} has no ready kernels for {names}"
    saved = duration(saved_s)
    if wanted == "gpu" or saved_s > 60 * COMPILE_MINUTES[1]:
        gain = "" if wanted == "gpu" else f"; it then saves about {saved}"
        return Choice(True, f"{gpus}, which first compiles its kernels for {wait}, once, {why}{gain}")
    return Choice(
        False,
        f"the processor: {gpus} would first compile its kernels for {wait}, {why}, to save about {saved}; "
        "`firetwin gpu --warm` compiles them once",
    )
