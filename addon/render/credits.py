"""Credits of tiles and photos, drawn into all pictures for viewing, whatever the settings.

Pictures of passes that make films have credits in their pixels. Depth, masks, normals, temperatures (EXR) and
the linear picture (EXR) are unchanged: their credits are in the manifest and in the sidecars of
`passes.pose`.
"""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..blender import owned, text
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
    """Draw a block's text as opacity (h, w), 0..1."""
    rows = max(len(block.at_left), len(block.at_right))
    edge, step = 0.5 * block.size, (block.height - 0.5 * block.size) / rows
    room, lines = block.width - 2.0 * edge, []
    for texts, right in ((block.at_left, False), (block.at_right, True)):
        for number, line in enumerate(reversed(texts)):
            size, wide = float(block.size), text.measure_width(line, block.size)
            if wide > room:  # a script wider than estimated
                size = block.size * room / wide
                wide = text.measure_width(line, size)
            left = block.width - edge - wide if right else edge
            lines.append(text.Line(line, size, left, edge + number * step))
    return text.draw_lines(lines, block.width, block.height)
