"""Memory that a render takes at most, from what is known before its first frame."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ..blender.owned import Stage
from ..progress import size
from ..shot.shot import Shot
from ..smoke import sources

BASE, SOLVER = 0.72e9, 0.3e9
PIXEL, PLANT, FACE, CELL, VOXEL = 790.0, 2550.0, 255.0, 175.0, 7.0
"""Bytes of Blender, our libraries and flames, and of the solver's process; of a pixel of a picture, a plant,
a face of a mesh, a cell of a flow that is being solved, and a voxel of the box in which smoke is painted.

Fitted to peaks of the first frame of examples/king_fire.toml without smoke, 0.96 to 2.98 GB: all plants, a
third and none, 640 and 1920 pixels wide, a mesh of a third. That of a voxel is the film's, of which a tenth
of the box holds smoke; where all of it does, smoke takes several times as much.
"""


@dataclass(frozen=True)
class Load:
    """What a render holds at once; `cells` and `voxels` are those of smoke."""

    pixels: int
    plants: int
    faces: int
    cells: int = 0
    voxels: int = 0

    @property
    def bytes(self) -> int:
        """Memory at most."""
        of = PIXEL * self.pixels + PLANT * self.plants + FACE * self.faces
        return round(BASE + of + VOXEL * self.voxels)

    @property
    def solver(self) -> int:
        """What the process takes that solves the flow meanwhile, until it is done; 0: there is none."""
        return round(SOLVER + CELL * self.cells) if self.cells else 0


def load(shot: Shot, stage: Stage, frames: Iterable[int] = ()) -> Load | None:
    """What rendering a shot's one camera on its built stage holds; `frames` show smoke.

    Nothing is known of smoke that is not a solved flow drawn along rays: None.
    """
    (camera,) = shot.settings.cameras
    smoky = list(frames)
    if smoky and not sources.is_integrated(shot):
        return None
    drawn = [thing for thing in stage.scene.objects if thing.type == "MESH" and not thing.hide_render]
    forest = {thing.data for thing in stage.things("Forest") if thing in drawn}
    return Load(
        pixels=math.prod(shot.resolution(camera)),
        plants=sum(len(mesh.vertices) for mesh in forest),
        faces=sum(len(mesh.polygons) for mesh in {thing.data for thing in drawn}),
        **_smoke(shot, smoky),
    )


def _smoke(shot: Shot, frames: list[int]) -> dict[str, int]:
    if not frames:
        return {}
    source = sources.select(shot)
    prepared = all(map(source.is_prepared, frames))
    return {
        "cells": 0 if prepared else sum(each.cells for each in source.domains),
        "voxels": source.painted_voxels(),
    }


def describe(load: Load) -> str:
    """What to tell before a render."""
    beside = f", and {size(load.solver)} while the smoke's flow is solved" if load.solver else ""
    return f"rendering takes about {size(load.bytes)} of memory at most{beside}"
