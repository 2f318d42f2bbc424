"""Builds the whole scene of a project."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
from firetwin_core.run import Run

from ..project import Project
from . import cameras, clock, collections, display, fire, forest, light, sensors, smoke, stand, terrain
from .ground import Ground
from .paths import Path, eyes, paths


def build(project: Project, run: Run, scene: bpy.types.Scene | None = None) -> bpy.types.Scene:
    """Build everything into `scene` (the current one unless given); what an earlier build made goes first."""
    scene = scene or bpy.context.scene
    for _ in steps(project, run, scene):
        pass
    return scene


def steps(project: Project, run: Run, scene: bpy.types.Scene) -> Iterator[str]:
    """Build everything in steps, each named before it is taken."""
    yield "surveying the ground"
    collections.root(scene)
    clock.build(project, run, scene)
    ground, views = survey(project, run)
    yield "growing the forest"
    grown = stand.grow(project, ground, views) if project.forest.trees else None
    yield "building the terrain"
    terrain.build(project, run, ground, views, grown)
    yield "planting the forest"
    forest.build(project, run, ground, views, grown)
    yield "lighting the fire"
    fire.build(project, run, ground, views, grown)
    yield "hanging the smoke"
    smoke.build(project, run)
    yield "setting sun and cameras"
    light.build(project, run, scene)
    cameras.build(project, run, views, scene)
    sensors.build(project, run, scene)
    display.build()


def survey(project: Project, run: Run) -> tuple[Ground, list[Path]]:
    """The ground with detail near the cameras, and the paths of the cameras over it."""
    ground = Ground(project, run)
    ground.eyes = eyes(paths(project, run, ground), project.terrain.near_radius)
    return ground, paths(project, run, ground)
