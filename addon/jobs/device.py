"""Device of a render job: chosen before the build, with its kernels compiled before the first picture."""

from __future__ import annotations

import os
from collections.abc import Sequence

import bpy

from .. import leases
from ..blender import devices
from ..blender.devices import Gpus
from ..errors import Error, TryAgainError, UnavailableError, input_error
from ..gpu import caches, cards, choice, kernels
from ..gpu.cards import Card
from ..progress import MessageCallback
from ..render import cycles_status
from ..shot.schema import scene_text
from ..shot.settings import Settings


def select(settings: Settings, frames: int, tell: MessageCallback) -> Gpus | None:
    """Choose the GPUs, or the processor (None), for a number of frames; compile missing kernels.

    Raises
    ------
    TryAgainError
        A GPU is requested and there is none; an `UnavailableError` that names the line of a scene file.
    """
    wanted = settings.render.device
    gpus = None if wanted == "cpu" else devices.find_gpus()
    if wanted == "gpu" and gpus is None:
        raise _no_gpu(settings)
    uncompiled = find_uncompiled(gpus)
    width, height = settings.render.resolution
    saved = choice.estimate_saving(frames, width * height, settings.render.samples)
    chosen = choice.choose(wanted, str(gpus or ""), uncompiled, saved, bpy.app.version_string)
    tell(f"Cycles renders on {chosen.text}")
    if not chosen.gpu:
        return None
    if gpus is not None and uncompiled:
        compile_kernels(gpus, uncompiled, tell)
    return gpus


def _no_gpu(settings: Settings) -> Error:
    """Return the error for a missing GPU, at its line of the scene file if there is one."""
    tried = ", ".join(devices.NAMES.values())
    reason = f'device = "gpu", but Cycles finds no GPU here (tried {tried}); set it to "auto" or "cpu"'
    if not settings.path.is_file():
        return TryAgainError(reason)
    at = scene_text.error_at(settings.path, ("render", "device"), reason)
    return input_error(at.path, at.reason, line=at.line, column=at.column, kind=UnavailableError)


def find_uncompiled(gpus: Gpus | None) -> list[Card]:
    """List the NVIDIA cards whose kernels the driver would compile at their first use.

    Other vendors' cards are not listed: Blender ships kernels for HIP and oneAPI, and Metal compiles while
    it renders.
    """
    if gpus is None or gpus.kind not in ("OPTIX", "CUDA"):
        return []
    folder, version = kernels.folder(), bpy.app.version
    missing = [card for card in cards.list_cards() if kernels.find(card, folder, version) is None]
    return [card for card in missing if not caches.is_compiled(card, blender_build(), os.environ)]


def blender_build() -> str:
    """Return version and build hash of Blender, on which compiled kernels depend."""
    return f"{bpy.app.version_string} {bpy.app.build_hash.decode(errors='replace')}"


def compile_kernels(gpus: Gpus, uncompiled: Sequence[Card], tell: MessageCallback) -> None:
    """Compile the kernels of these cards into the driver's cache, by a picture of one sample.

    One process of a machine compiles; others wait for it.
    """
    place, _ = caches.folders(os.environ)
    place.mkdir(parents=True, exist_ok=True)
    build = blender_build()

    def is_done() -> bool:
        return all(caches.is_compiled(card, build, os.environ) for card in uncompiled)

    with leases.lock(place / "firetwin.lock", is_done, lambda: None) as mine:
        if mine and not is_done():
            draw_sample(gpus, tell)
            caches.record_compiled(list(uncompiled), build, os.environ)


def draw_sample(gpus: Gpus | None, tell: MessageCallback) -> None:
    """Render a picture of one sample with these GPUs, which loads their kernels."""
    scene = bpy.data.scenes.new("Firetwin kernels")
    camera = bpy.data.objects.new("Firetwin kernels", bpy.data.cameras.new("Firetwin kernels"))
    try:
        scene.collection.objects.link(camera)
        scene.camera, scene.render.engine = camera, "CYCLES"
        scene.render.resolution_x = scene.render.resolution_y = 16
        scene.cycles.samples, scene.cycles.use_denoising = 1, False
        devices.use(gpus, scene)
        with cycles_status.reported(tell):
            bpy.ops.render.render(scene=scene.name)
    finally:
        data = camera.data
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(data)
        bpy.data.scenes.remove(scene)
