"""Asset library job: writes a .blend file of assets and its catalogue file."""

from __future__ import annotations

import uuid
from functools import partial
from pathlib import Path

from .. import files, output
from ..errors import input_error
from ..progress import READING, MessageCallback, Progress, no_message, notify_if_slow, silent
from ..shot.source import ShotSource
from . import worker
from .build import save

BLEND, CATALOGUE = "firetwin_assets.blend", "blender_assets.cats.txt"
CATALOGUES = ("Trees", "Undergrowth", "Materials", "Geometry Nodes", "Shader Nodes", "Compositor", "Cameras")
SCENE = """\
run = "sample"

[time]
start = 2014-09-17T16:00:00-07:00
end = 2014-09-17T16:24:00-07:00
frames = 2

[smoke]
method = "preview"

[[cameras]]
name = "drone"

[[cameras.keys]]
latitude = 38.984
longitude = -120.558
height = 600.0
target = "head"
"""
"""Default scene file, of the sample run."""

_SPACE = uuid.UUID("6f1b2c1e-2f53-4a86-9d0c-6b9a6f0f7a11")  # names of our catalogues are unique within it


def identifier(catalogue: str) -> str:
    """Compute the UUID of a catalogue from its name."""
    return str(uuid.uuid5(_SPACE, catalogue))


def catalogue() -> str:
    """Compose the text of the catalogue definition file."""
    above = f"{identifier('Firetwin')}:Firetwin:Firetwin"  # otherwise Blender adds one and asks to save
    lines = [above, *(f"{identifier(name)}:Firetwin/{name}:Firetwin-{name}" for name in CATALOGUES)]
    head = "# This is an Asset Catalog Definition file for Blender.\n\nVERSION 1\n\n"
    return head + "\n".join(lines) + "\n"


def run(
    choice: ShotSource,
    out: Path,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    overwrite: bool = False,
) -> int:
    """Write the asset library into the folder `out`: a shot's trees, materials and node groups.

    Parameters
    ----------
    overwrite
        Replace a changed catalogue.

    Returns
    -------
    Number of assets.

    Raises
    ------
    InputError
        `out` holds the catalogue of another library, or cannot be written.
    """
    out = out.absolute()
    _refuse_strangers(out)
    output.check_blend(out / BLEND)
    output.check(out / CATALOGUE, overwrite)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise input_error(out, f"cannot be made ({error.strerror}); choose another folder") from None
    with notify_if_slow(READING):
        choice.shot()
    count = worker.run(partial(in_blender, choice, out / BLEND), progress, stop=stop, tell=tell)
    output.write_text(out / CATALOGUE, catalogue(), overwrite)
    return count


def _refuse_strangers(out: Path) -> None:
    """Refuse a folder that holds another asset library."""
    there = out / CATALOGUE
    if there.exists() and identifier(CATALOGUES[0]) not in files.read_text(there, errors="replace"):
        raise input_error(there, "belongs to another asset library; choose another folder")


def in_blender(choice: ShotSource, out: Path, progress: Progress, tell: MessageCallback) -> int:
    """Create the assets in an empty Blender, and save them."""
    import bpy

    from ..blender import owned
    from ..render import groups
    from ..scene import assets

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    shot = choice.shot()
    groups.build(shot.settings, owned.adopt(bpy.context.scene))
    count = assets.build(shot, identifier, progress)
    save(out, tell)
    return count
