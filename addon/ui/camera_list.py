"""Camera list of the scene file in the .blend file: `scene.firetwin.cameras`, one item per camera.

An item has a name, and the camera's table as scene-file text (`[[cameras]]` with its keys, paths absolute).
`get` parses the dataclass `shot.settings.Camera` of an item and `put` writes one into it, without loss::

    camera = camera_list.get(item)
    camera_list.put(item, replace(camera, rig=replace(camera.rig, focal_length=50.0)))
    camera_list.add(scene.firetwin, Camera("mine", Drone(keys=(...))))
    camera_list.cameras(scene.firetwin)  # all cameras, in order

The item's name overrides the name in the table, so that a list in a panel can rename a camera. Build, render
and export use exactly these cameras (see `scene_file.read_settings`). The object of a built camera is
`owned.stage(scene).camera(item.name)`. `scene.firetwin.camera_index` is the item selected in the panel
FIRETWIN_PT_cameras (see `cameras_panel`). Panels of a camera use that panel as their `bl_parent_id`.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable
from dataclasses import replace

import bpy

from ..errors import Error, InputError
from ..shot.schema import Field, fields
from ..shot.settings import Camera, Settings
from . import changed_settings, tables


class FIRETWIN_PG_camera(bpy.types.PropertyGroup):
    """A camera of the scene file"""

    name: bpy.props.StringProperty(
        name="Name",
        description="Name of the camera, its folder and its files: letters, digits, - and _",
        update=changed_settings.update_changes,
    )
    table: bpy.props.StringProperty(options={"HIDDEN"}, update=changed_settings.update_changes)


def get(item: FIRETWIN_PG_camera) -> Camera:
    """Parse the camera of an item.

    Raises
    ------
    Error
        Its text is not a valid camera of this version.
    """
    try:
        return replace(_parse_camera(item.table), name=item.name)
    except InputError as error:
        raise Error(f'camera "{item.name}" cannot be read: {error.reason}') from None


def put(item: FIRETWIN_PG_camera, camera: Camera) -> None:
    """Store a camera in an item."""
    item.name, item.table = camera.name, tables.to_text(_cameras_field(), (camera,))


def add(panel: bpy.types.PropertyGroup, camera: Camera) -> FIRETWIN_PG_camera:
    """Append an item to the list, and select it."""
    item = panel.cameras.add()
    put(item, camera)
    panel.camera_index = len(panel.cameras) - 1
    return item


def make_unique(panel: bpy.types.PropertyGroup, camera: Camera) -> Camera:
    """Rename a camera so that its name is unique in the list: ``drone``, ``drone-2``."""
    taken = {item.name for item in panel.cameras}
    name = next(
        name
        for number in range(1, len(taken) + 2)
        if (name := camera.name if number == 1 else f"{camera.name}-{number}") not in taken
    )
    return replace(camera, name=name)


def cameras(panel: bpy.types.PropertyGroup) -> tuple[Camera, ...]:
    """Return all cameras in order."""
    return tuple(get(item) for item in panel.cameras)


def fill(panel: bpy.types.PropertyGroup, cameras: Iterable[Camera]) -> None:
    """Replace the list with these cameras, and select the first."""
    panel.cameras.clear()
    for camera in cameras:
        add(panel, camera)
    panel.camera_index = 0


def to_text(cameras: Iterable[Camera]) -> str:
    """Serialize cameras to canonical text, for comparison."""
    return tables.to_text(_cameras_field(), tuple(cameras))


def from_text(text: str) -> tuple[Camera, ...]:
    """Parse the cameras of `text`."""
    return tables.from_text(_cameras_field(), text)


@functools.lru_cache(maxsize=64)
def _parse_camera(text: str) -> Camera:
    return from_text(text)[0]


def _cameras_field() -> Field:
    return next(part for part in fields(Settings) if part.name == "cameras")


classes = (FIRETWIN_PG_camera,)
