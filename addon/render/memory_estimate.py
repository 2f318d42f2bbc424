"""Memory estimate: peak memory of a render, from the sizes known before its first frame."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass

from ..blender.owned import Stage
from ..progress import size
from ..shot import passes
from ..shot.shot import Shot
from ..smoke import sources

BASE, SOLVER = 0.72e9, 0.3e9
PIXEL, PLANT, FACE, CELL, VOXEL = 790.0, 2550.0, 255.0, 175.0, 7.0
"""Bytes per pixel of a picture, plant, mesh face, cell of a flow during its solution, and voxel of smoke.

They cover Blender, our libraries, flames and the solver's process. They were fitted to peaks of the first
frame of examples/king_fire.toml without smoke, 0.96 to 2.98 GB: all plants, a third and none, 640 and 1920
pixels wide, a mesh of a third. The figure per voxel applies to the film, in which smoke fills a tenth of the
box. A box full of smoke takes several times as much.
"""


LAYERED = 200.0
"""Bytes per pixel that `comp` adds: a frame of 960 x 540 pixels with flames, without smoke, took 1.04 GB,
and 1.14 GB with `comp`.
"""


@dataclass(frozen=True)
class Load:
    """Sizes that determine a render's memory: pixels, plants, mesh faces, and cells and voxels of smoke.

    `layered` is the number of pixels with layers for compositors.
    """

    pixels: int
    plants: int
    faces: int
    cells: int = 0
    voxels: int = 0
    layered: int = 0

    @property
    def bytes(self) -> int:
        """Estimated peak memory, bytes."""
        of = PIXEL * self.pixels + LAYERED * self.layered + PLANT * self.plants + FACE * self.faces
        return round(BASE + of + VOXEL * self.voxels)

    @property
    def solver(self) -> int:
        """Memory of the concurrent flow solver's process, bytes; 0 without one."""
        return round(SOLVER + CELL * self.cells) if self.cells else 0


def load(shot: Shot, stage: Stage, frames: Iterable[int] = (), names: Collection[str] = ()) -> Load | None:
    """Compute the load of rendering passes of a shot of one camera on its built stage; `frames` show smoke.

    Returns None for smoke other than a ray-marched solved flow, which has no estimate.
    """
    (camera,) = shot.settings.cameras
    smoky = list(frames)
    if smoky and not sources.is_integrated(shot):
        return None
    drawn = [obj for obj in stage.scene.objects if obj.type == "MESH" and not obj.hide_render]
    forest = {obj.data for obj in stage.objects_of("Forest") if obj in drawn}
    pixels = math.prod(shot.resolution(camera))
    return Load(
        pixels=pixels,
        layered=pixels if any(isinstance(passes.known()[name], passes.MarchedPass) for name in names) else 0,
        plants=sum(len(mesh.vertices) for mesh in forest),
        faces=sum(len(mesh.polygons) for mesh in {obj.data for obj in drawn}),
        **_smoke(shot, smoky),
    )


def _smoke(shot: Shot, frames: list[int]) -> dict[str, int]:
    if not frames:
        return {}
    source = sources.select(shot)
    prepared = all(map(source.is_prepared, frames))
    return {
        "cells": 0 if prepared else sum(domain.cells for domain in source.domains),
        "voxels": source.painted_voxels(),
    }


def describe(load: Load) -> str:
    """Format the memory estimate as a message before a render."""
    beside = f", and {size(load.solver)} while the smoke's flow is solved" if load.solver else ""
    return f"rendering takes about {size(load.bytes)} of memory at most{beside}"
