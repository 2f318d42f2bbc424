"""GPU job: lists GPUs with their kernels and caches, compiles kernels in advance, and makes missing ones."""

from __future__ import annotations

import os
from functools import partial

from ..errors import TryAgainError
from ..progress import MessageCallback, Progress, no_message, silent, size
from . import worker

NONE = "Cycles finds no GPU here"


def describe(tell: MessageCallback = no_message) -> list[str]:
    """Describe each GPU, the state of its kernels, and the kernel caches, a line each."""
    return worker.run(describe_in_blender, tell=tell)


def warm(tell: MessageCallback, stop: worker.Stop | None = None) -> list[str]:
    """Compile the kernels of all GPUs into the driver's cache; return the same lines as `describe`."""
    return worker.run(warm_in_blender, tell=tell, stop=stop)


def make_kernels(architecture: str, tell: MessageCallback) -> list[str]:
    """Make Cycles' kernels for an architecture; return the file."""
    return worker.run(partial(make_in_blender, architecture), tell=tell)


def describe_in_blender(progress: Progress = silent, tell: MessageCallback = no_message) -> list[str]:
    """Describe GPUs and caches in a Blender process."""
    import bpy

    from ..blender import devices
    from ..gpu import caches, cards, kernels
    from . import device

    gpus = devices.find_gpus()
    if gpus is None:
        return [NONE]
    uncompiled, lines = device.find_uncompiled(gpus), []
    nvidia = cards.list_cards() if gpus.kind in ("OPTIX", "CUDA") else []
    for card in nvidia:
        ready = kernels.find(card, kernels.folder(), bpy.app.version)
        state = "ready"
        if card in uncompiled:
            state = f"not ready: Blender {bpy.app.version_string} has none, so the driver compiles them once"
        elif ready is None:
            state = "compiled, in the cache"
        lines.append(f"{card.name}, {card.architecture}, driver {card.driver}: kernels {state}")
    if not nvidia:
        return [*lines, *(f"{name} by {devices.NAMES[gpus.kind]}" for name in gpus.names)]
    named = zip(("CUDA", "OptiX"), caches.folders(os.environ), strict=True)
    return [
        *lines,
        f"kernels of Cycles: {kernels.folder()}",
        *(f"cache of {name}: {folder}, {size(caches.size(folder))}" for name, folder in named),
    ]


def warm_in_blender(progress: Progress = silent, tell: MessageCallback = no_message) -> list[str]:
    """Compile the kernels of all GPUs in a Blender process.

    Raises
    ------
    TryAgainError
        There is no GPU.
    """
    from ..blender import devices
    from . import device

    gpus = devices.find_gpus()
    if gpus is None:
        raise TryAgainError(f"{NONE}; nothing to compile")
    tell(f"loading the kernels of Cycles on {gpus}")
    if uncompiled := device.find_uncompiled(gpus):
        device.compile_kernels(gpus, uncompiled, tell)
    else:
        device.draw_sample(gpus, tell)
    return describe_in_blender()


def make_in_blender(architecture: str, progress: Progress, tell: MessageCallback) -> list[str]:
    """Make kernels for an architecture with Blender's own intermediate text."""
    from ..gpu import kernels

    tell(f"translating Cycles' kernels for {architecture}; this takes about 10 minutes and 6 GB of memory")
    return [str(kernels.make(architecture, kernels.folder()))]
