"""Credits of tiles and photos, drawn into all pictures for viewing, whatever the settings.

Pictures of passes that make films have credits in their pixels. Depth, masks, normals, temperatures (EXR) and
the linear picture (EXR) are unchanged: their credits are in the manifest and in the sidecars of
`shot.passes.pose`.
"""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..blender import compat, owned
from ..imaging import credits
from ..imaging.credits import Block, Credits
from ..scene.credits import read_scene

_STRIP = 0.05  # grey level behind the text


def burn(path: Path, words: Credits, note: str, around: bool = False) -> None:
    """Draw credits into a PNG file.

    Parameters
    ----------
    note
        Description of the content, for the file's metadata.
    around
        The picture is a stereo panorama.

    Raises
    ------
    ValueError
        The credits do not fit into the picture.
    """
    if not words:
        return
    picture = sensor.read_image(path)[..., :3].copy()
    height, width = picture.shape[:2]
    for block in credits.blocks(words, width, height, around):
        rows = slice(block.top, block.top + block.height)
        columns = slice(block.left, block.left + block.width)
        picture[rows, columns] = _STRIP + (1.0 - _STRIP) * _rasterize(block)[..., None]
    sensor.write_image(path, picture, {"Note": note})


def stamp(stage: owned.Stage) -> None:
    """Add the credits to the metadata of Blender's own renders of a scene."""
    if words := read_scene(stage):
        render = stage.scene.render
        render.use_stamp = render.use_stamp_note = True
        render.stamp_note_text = f"{render.stamp_note_text}\n{words.text()}"
        render.stamp_font_size = max(round(render.resolution_y / 54), 11)
        render.stamp_foreground, render.stamp_background = (1.0, 1.0, 1.0, 1.0), (0.0, 0.0, 0.0, 0.8)


@functools.lru_cache(maxsize=8)
def _rasterize(block: Block) -> NDArray[np.float32]:
    """Draw a block's text in Blender's typeface, which covers most scripts, as opacity (h, w), 0..1."""
    import blf
    import imbuf

    face, image = _load_typeface(), imbuf.new((block.width, block.height))
    rows = max(len(block.at_left), len(block.at_right))
    edge, line = 0.5 * block.size, (block.height - 0.5 * block.size) / rows
    blf.color(face, 1.0, 1.0, 1.0, 1.0)
    with blf.bind_imbuf(face, image):
        for lines, right in ((block.at_left, False), (block.at_right, True)):
            for number, text in enumerate(reversed(lines)):
                blf.size(face, block.size)
                wide = blf.dimensions(face, text)[0]
                if wide > block.width - 2.0 * edge:  # a script wider than estimated
                    blf.size(face, block.size * (block.width - 2.0 * edge) / wide)
                    wide = blf.dimensions(face, text)[0]
                at = block.width - edge - wide if right else edge
                blf.position(face, at, edge + number * line, 0.0)
                blf.draw_buffer(face, text)
    with tempfile.TemporaryDirectory(prefix="firetwin-") as folder:
        path = Path(folder, "credits.png")
        imbuf.write(image, filepath=str(path))
        pixels = sensor.read_image(path)
    return pixels[..., -1]


@functools.cache
def _load_typeface() -> int:
    """Load Blender's typeface with its fallbacks, and return its number."""
    import blf

    path = compat.typeface_path()
    found = blf.load(path) if path else 0
    return max(int(found), 0)
