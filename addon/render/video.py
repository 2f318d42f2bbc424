"""Video encoding: H.264 films of finished frames by Blender's sequencer and FFmpeg, with time captions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
from firetwin_core import sensor

from .. import files
from ..blender import compat, text
from ..errors import writing
from ..imaging import credits, slate
from ..imaging.credits import Credits
from ..progress import Progress, silent
from ..run import times
from ..shot import passes
from ..shot.shot import Shot
from . import engine, films, manifest, prores, spherical, timecode_track, verify
from .picture import Picture
from .sharing import RenderSession
from .store import describe

_PAPER, _INK = 0.08, 0.95  # grey levels of a slate


def make(shot: Shot, session: RenderSession, progress: Progress = silent) -> None:
    """Encode the films of these cameras and passes that are missing or older than their pictures."""
    wanted = list(films.missing(shot, session.store, session.made_with))
    for done, (camera, name, inputs) in enumerate(wanted, start=1):
        path = films.path_of(inputs)
        session.wait_for_lease(path)
        try:  # another render may have finished it meanwhile
            this = {(camera, name): session.made_with[camera, name]}
            for film in films.missing(shot, session.store, this):
                if films.path_of(film[2]) == path:
                    _film(shot, session, *film)
            any(films.missing(shot, session.store, this))  # records in the store that the film is up to date
        finally:
            session.leases.release(path)
        progress(done, len(wanted), "filming")


def _film(shot: Shot, session: RenderSession, camera: str, name: str, made_from: dict[str, Any]) -> None:
    out = session.store.out
    kind, codec, around = made_from["kind"], made_from["codec"], shot.camera(camera).rig.around
    path = out / films.path_of(made_from)
    scene = bpy.data.scenes.new("Firetwin Film")
    try:
        with session.leases.part_folder() as part:
            film = part / path.name
            frames = [frame for frame, _ in made_from["frames"]]
            size = passes.known()[name].size(shot.resolution(shot.camera(camera)))
            board = _slate(part, made_from["slate"], size, around) if "slate" in made_from else None
            _settings(shot, size, scene, film, len(frames) + bool(board), codec)
            engine.set_metadata(shot.run_of(camera), scene)
            mine = session.made_with[camera, name]
            _strips(shot, scene, out, camera, name, frames, manifest.read_credits(mine), kind, board)
            with writing(path):
                bpy.ops.render.render(animation=True, scene=scene.name)
            if codec == "prores":
                prores.tag_colours(film)
            if around and codec == "h264":
                spherical.film(film)
            timecode_track.add(film, films.first_count(made_from, shot), shot.settings.time.rate)
            verify.film(film)
            entry = describe(film) | {"camera": camera, "pass": name, "film": kind}
            entry |= manifest.credit_entry(mine) | ({"slate_frames": 1} if board else {})
            files.publish(film, path)
            session.store.add(made_from, {films.path_of(made_from): entry})
    finally:
        bpy.data.scenes.remove(scene)


def _slate(folder: Path, rows: list[list[str]], size: tuple[int, int], around: bool) -> Path:
    """Draw the slate of a film into a file."""
    places = slate.lay_out(rows, *size, around, text.measure_width)
    shown = text.draw_lines([text.Line(*place) for place in places], *size)[..., None]
    path = folder / "slate.png"
    sensor.write_image(path, _PAPER + (_INK - _PAPER) * np.repeat(shown, 3, axis=-1))
    return path


def _settings(
    shot: Shot, size: tuple[int, int], scene: bpy.types.Scene, path: Path, count: int, codec: str
) -> None:
    """Set codec and container; the view transform is Standard, as pictures are display-referred already."""
    render = scene.render
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    compat.set_frame_rate(render, shot.settings.time.rate)
    scene.frame_start, scene.frame_end = 1, count
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"
    scene.view_settings.exposure, scene.view_settings.gamma = 0.0, 1.0
    scene.sequencer_colorspace_settings.name = "sRGB"
    render.use_sequencer, render.use_compositing = True, False
    render.dither_intensity = 0.0
    compat.film_settings(render)
    render.ffmpeg.format = "QUICKTIME" if codec == "prores" else "MPEG4"
    render.ffmpeg.codec = codec.upper()
    if codec == "prores":
        render.ffmpeg.ffmpeg_prores_profile = "422_HQ"
    render.image_settings.color_depth = "8" if codec == "h264" else "10"
    render.ffmpeg.constant_rate_factor, render.ffmpeg.ffmpeg_preset = "PERC_LOSSLESS", "GOOD"
    render.ffmpeg.gopsize = round(shot.settings.time.rate)
    render.ffmpeg.audio_codec = "NONE"
    render.use_file_extension = False
    render.filepath = str(path)


def _strips(
    shot: Shot,
    scene: bpy.types.Scene,
    out: Path,
    camera: str,
    name: str,
    numbers: list[int],
    words: Credits,
    kind: str,
    board: Path | None,
) -> None:
    """Add a strip for each picture, with its model time as a caption (one for each eye in stereo films).

    Captions are placed above the pictures' credits. A slate precedes the first picture.
    """
    editor, first = scene.sequence_editor_create(), 2 if board else 1
    if board:
        editor.strips.new_image("slate", str(board.resolve()), 1, 1, fit_method="ORIGINAL")
    captions = kind == "review" and passes.known()[name].captions
    (width, height), around = shot.resolution(shot.camera(camera)), shot.camera(camera).rig.around
    above = 0.035 + (0.0 if around else credits.strip_height(words, width, height) / height)
    size, low = (height / 60, (0.17, 0.67)) if around else (height / 20, (above,))
    left, right = (0.44, 0.56) if around else (0.025, 0.975)
    for position, number in enumerate(numbers, start=first):
        shown = str((out / Picture(camera, number, name).file("png")).resolve())
        editor.strips.new_image(f"picture {number}", shown, 1, position, fit_method="ORIGINAL")
        if not captions:
            continue
        label = times.text(shot.utc(number), shot.settings.time.zone)
        for eye, up in enumerate(low):
            _text(editor, label, position, 1, 2 + eye, size, (left, up), "LEFT")
    if shot.run_of(camera).synthetic and captions:
        for eye, up in enumerate(low):
            place = right, up - 0.03 * around
            _text(editor, "synthetic sample run", first, len(numbers), 4 + eye, size / 1.5, place, "RIGHT")


def _text(
    editor: bpy.types.SequenceEditor,
    words: str,
    start: int,
    length: int,
    channel: int,
    size: float,
    place: tuple[float, float],
    side: str,
) -> None:
    strip = compat.new_strip(editor, words, "TEXT", channel, start, length)
    strip.text, strip.font_size, strip.font = words, size, compat.strip_typeface(words)
    strip.color, strip.location = (1.0, 1.0, 1.0, 1.0), place
    strip.anchor_x, strip.anchor_y, strip.alignment_x = side, "BOTTOM", side
    strip.use_shadow, strip.shadow_color = True, (0.0, 0.0, 0.0, 0.8)
    strip.use_outline, strip.outline_color, strip.outline_width = True, (0.0, 0.0, 0.0, 0.7), 0.04
