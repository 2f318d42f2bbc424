"""Pictures of tiles as tiled images (UDIM): links with UDIM names to files of the cache."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

import bpy

from ... import files
from ...blender import owned
from .reuse import MADE_OF, STATE
from .slot import Slot

_FIRST = 1001


def load(
    slots: Mapping[str, Slot], folder: Path, loaded: Sequence[bpy.types.Image] = ()
) -> list[bpy.types.Image]:
    """Load the images of all slots.

    Their files are links to the pictures in `folder`, in a folder named by the hash of their contents.

    Parameters
    ----------
    loaded
        Images of the last build, which are reused if unchanged.
    """
    members: dict[int, dict[int, str]] = {}
    for picture, slot in slots.items():
        members.setdefault(slot.image, {})[slot.part] = picture
    return [_load(number, members[number], folder, loaded) for number in sorted(members)]


def _load(
    number: int, parts: dict[int, str], folder: Path, loaded: Sequence[bpy.types.Image]
) -> bpy.types.Image:
    end = Path(parts[0]).suffix
    made_of = hashlib.sha256(repr(sorted(parts.items())).encode()).hexdigest()[:32]
    place = folder / "pictures" / made_of
    place.mkdir(parents=True, exist_ok=True)
    for part, picture in parts.items():
        _link(folder / picture, place / f"{_FIRST + part}{end}")
    path, numbers = str(place / f"<UDIM>{end}"), sorted(_FIRST + part for part in parts)
    for image in loaded:
        if image.get(MADE_OF) == made_of and image[STATE] == _state(image) and _at(image) == path:
            return image
    image = bpy.data.images.new(f"Firetwin Tiles {number + 1}", 8, 8, tiled=True)
    image.filepath = path
    image.source = "TILED"
    for part in numbers[1:]:
        image.tiles.new(part)
    image[MADE_OF], image[STATE] = made_of, _state(image)
    return owned.mark(image)


def _at(image: bpy.types.Image) -> str:
    return bpy.path.abspath(image.filepath)


def _state(image: bpy.types.Image) -> str:
    """List the settings of an image that an artist may change, as text."""
    numbers = sorted(part.number for part in image.tiles)
    packed = bool(image.packed_files) or image.is_dirty
    space = image.colorspace_settings.name, image.alpha_mode
    return hashlib.sha256(repr((numbers, image.source, packed, space)).encode()).hexdigest()[:32]


def _link(source: Path, path: Path) -> None:
    """Link a file under another name, or copy it if the disk has no links."""
    if path.exists() and path.samefile(source):
        return

    def put(part: Path) -> None:
        part.unlink(missing_ok=True)
        files.link_or_copy(source, part)

    files.write(path, put, durable=False)
