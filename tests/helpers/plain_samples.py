"""Rendered samples of closed form: a camera above a level plane, and maps of one value that tests change."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
from firetwin.dataset.rendered import Rendered, SampleCamera
from firetwin.dataset.survey import Place
from firetwin.passes import masks
from firetwin.shot.georeference import Georeference
from firetwin_core import geo


def looking(
    pitch: float, height: float = 100.0, fov: float = 60.0, size: tuple[int, int] = (64, 48)
) -> SampleCamera:
    """Make a camera at a height (m) above the origin that looks north, with a pitch in degrees."""
    width, rows = size
    focal = 0.5 * width / np.tan(np.radians(0.5 * fov))
    ahead = np.array([0.0, np.cos(np.radians(pitch)), np.sin(np.radians(pitch))])
    right = np.array([1.0, 0.0, 0.0])
    to_world = np.eye(4)
    to_world[:3, :3] = np.column_stack([right, np.cross(right, ahead), -ahead])
    to_world[:3, 3] = 0.0, 0.0, height
    return SampleCamera(to_world, focal, focal, 0.5 * width, 0.5 * rows, width, rows)


def directions(camera: SampleCamera) -> np.ndarray:
    """Directions (h, w, 3) of the rays through pixel centres, of planar length 1, in the scene."""
    u, v = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    x, y = (u - camera.cx) / camera.fx, (camera.cy - v) / camera.fy
    return np.stack([x, y, -np.ones_like(x)], axis=-1) @ camera.to_world[:3, :3].T


def plane(camera: SampleCamera, **maps) -> Rendered:
    """Make the sample of a grey level plane at z = 0 under a lighter sky, with some maps replaced."""
    rays = directions(camera)
    down = rays[..., 2] < 0.0
    depth = np.where(down, camera.to_world[2, 3] / np.where(down, -rays[..., 2], 1.0), np.inf)
    shape = depth.shape
    kind = np.where(down, masks.GROUND, masks.SKY).astype(np.uint8)
    picture = np.repeat(np.where(down, 0.5, 0.6).astype(np.float32)[..., None], 3, axis=-1)
    dark = np.zeros((*shape, 3), np.float32)
    sample = Rendered(
        rgb=picture,
        twin=picture,
        light=picture,
        twin_light=picture,
        smoke_light=dark,
        exposure=0.0,
        clear=np.ones(shape, np.float32),
        smoke_range=np.full(shape, np.inf, np.float32),
        classes=kind,
        surface=kind,
        instance=np.zeros(shape, np.int32),
        depth=depth.astype(np.float32),
        range=(depth * np.linalg.norm(rays, axis=-1)).astype(np.float32),
        fire=dark,
        twin_fire=dark,
        kelvin=np.full(shape, 300.0, np.float32),
        camera=camera,
        time=datetime(2014, 9, 17, 18, tzinfo=UTC),
        model_time=3600.0,
    )
    return replace(sample, **maps)


def flat_place(**more) -> Place:
    """Make a place whose ground is z = 0 and burned, 25 m below the ellipsoid's sea level."""
    frame = geo.LocalFrame(38.8, -120.6, 0.0)
    place = Place(
        Georeference(frame, -25.0, "a test"),
        ground=lambda x, _: np.zeros(np.shape(x)),
        burns=lambda x, _: np.ones(np.shape(x), bool),
        ignition=0.0,
    )
    return replace(place, **more)


def degrees(place: Place, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Convert points at z = 0 to degrees east and north (n, 2)."""
    latitude, longitude, _ = place.georeference.frame.reverse(np.column_stack([x, y, np.zeros(len(x))]))
    return np.column_stack([longitude, latitude])
