"""Project of Blender's Video Sequencer (story.blend): a strip for each shot, text and dissolve, and markers.

Strips have names, and record where they were placed. A strip that an artist moved, cut or rewrote stays;
others follow the storyboard. Pictures keep their files from render to render, so that all strips show them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby, pairwise
from pathlib import Path

import bpy

from ..blender import compat
from ..cuts.cut import CameraFilm, Clip, Edit, Marker
from ..escaped import escaped
from .captions import Caption
from .storyboard import CARD
from .timeline import Span
from .words import SAFE

SCENE_NAME = "Story"
_PLACED = "firetwin"  # custom property of strips
_DISSOLVES, _WORDS, _FACTS, _MARK = 3, 4, 5, 6  # channels; shots alternate between 1 and 2
_DARK = (0.015, 0.016, 0.018)
_PLATE = (0.0, 0.0, 0.0, 0.6)  # behind letters; white ones have a contrast of 5.7 on it over white
_BAR = 0.84  # of the width, left of the colour bar of infrared pictures
_PUSH = 1.06  # scale at the end of a still
_MARKER = "GREEN"  # colour of markers in files of other programs


@dataclass(frozen=True)
class Reel:
    """Pictures of a shot.

    Attributes
    ----------
    folder
        Folder of the pictures, relative to the project; empty for a card.
    files
        Name of the picture of each frame of the film.
    still
        True if pictures stay for so long that the view moves over them.
    """

    span: Span
    folder: str = ""
    files: tuple[str, ...] = ()
    still: bool = False


@dataclass(frozen=True)
class Project:
    """Content of a project.

    Attributes
    ----------
    markers
        Frame and text of each event.
    mark
        Text over all of the film, such as "synthetic".
    """

    path: Path
    reels: tuple[Reel, ...]
    captions: tuple[Caption, ...]
    markers: tuple[tuple[int, str], ...]
    size: tuple[int, int]
    fps: int
    mark: str

    @property
    def frames(self) -> int:
        """Number of frames of the film."""
        return self.reels[-1].span.end - 1


@dataclass(frozen=True)
class _Text:
    """Text strip: its size (heights of the picture), and the corner of the picture at which it is placed."""

    text: str
    size: float
    place: tuple[float, float]
    side: str = "LEFT"
    base: str = "BOTTOM"
    plate: bool = True


def lay_out(scene: bpy.types.Scene, project: Project) -> None:
    """Lay out a project in a scene: missing strips are added, and strips that nobody changed follow it."""
    editor = scene.sequence_editor or scene.sequence_editor_create()
    wanted: set[str] = set()
    shots = [_shot(editor, project, reel, 1 + k % 2, wanted) for k, reel in enumerate(project.reels)]
    for k, reel in enumerate(project.reels[:-1]):
        if reel.span.overlap:
            _dissolve(editor, reel.span, shots[k : k + 2], wanted)
    for name, channel, first, end, text in _texts(project):
        _write(editor, project, name, channel, (first, end), text, wanted)
    for strip in [each for each in editor.strips if each.name not in wanted and _is_as_placed(each)]:
        editor.strips.remove(strip)
    _mark(scene, project)


def describe_cut(scene: bpy.types.Scene, film: str) -> Edit:
    """Describe the cut that the film of a scene shows, with its markers; `film` is the file of the film."""
    frames = range(1, scene.frame_end + 1)
    size = scene.render.resolution_x, scene.render.resolution_y
    source = CameraFilm(SCENE_NAME, film, tuple(frames), size)
    (stretch,) = source.stretches
    clips = (Clip(source, stretch, at, end - at, escaped(name)) for name, at, end in _cut(scene, frames))
    markers = sorted((each.frame, each.name) for each in scene.timeline_markers if each.frame in frames)
    marked = tuple(Marker(frame, escaped(name), _MARKER) for frame, name in markers)
    return Edit(SCENE_NAME, Fraction(scene.render.fps), (source,), tuple(clips), marked)


def _cut(scene: bpy.types.Scene, frames: range) -> Iterator[tuple[str, int, int]]:
    """Yield strip, first frame and end of each part of a film; a dissolve is part of the strip after it."""
    spans = {each: compat.strip_span(each) for each in scene.sequence_editor.strips if _has_picture(each)}
    edges = {frames.start, frames.stop}.union(*((first, first + length) for first, length in spans.values()))
    parts = pairwise(sorted(edge for edge in edges if frames.start <= edge <= frames.stop))
    shown = [
        (_shown([each for each, (at, n) in spans.items() if at <= first < at + n]), first, end)
        for first, end in parts
    ]
    for name, each in groupby(shown, key=lambda part: part[0]):
        same = list(each)
        if name:
            yield name, same[0][1], same[-1][2]


def _has_picture(strip: bpy.types.Strip) -> bool:
    return not strip.mute and strip.type not in ("TEXT", "SOUND", "ADJUSTMENT")


def _shown(strips: Sequence[bpy.types.Strip]) -> str:
    """Return the name of the uppermost of these strips, of an effect its last input; "" without strips."""
    if not strips:
        return ""
    strip = max(strips, key=lambda each: each.channel)
    while source := getattr(strip, "input_2", None) or getattr(strip, "input_1", None):
        strip = source
    return str(strip.name)


def set_up(scene: bpy.types.Scene) -> None:
    """Set up a scene for a project: pictures are display-referred, and its film is H.264."""
    scene.name, render = SCENE_NAME, scene.render
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"
    scene.sequencer_colorspace_settings.name = "sRGB"
    render.use_sequencer, render.use_compositing, render.dither_intensity = True, False, 0.0
    compat.film_settings(render)
    render.ffmpeg.format, render.ffmpeg.codec, render.ffmpeg.audio_codec = "MPEG4", "H264", "NONE"
    render.ffmpeg.constant_rate_factor, render.ffmpeg.ffmpeg_preset = "HIGH", "GOOD"
    render.use_file_extension = False
    render.filepath = "//story.mp4"


def _shot(
    editor: bpy.types.SequenceEditor, project: Project, reel: Reel, channel: int, wanted: set[str]
) -> bpy.types.Strip:
    """Place the strip of a shot: its pictures, or a dark ground."""
    span = reel.span
    strip = _kept(editor, span.shot.name, (span.first, span.length, channel), "", wanted)
    if strip is None and span.shot.picture == CARD:
        strip = compat.new_strip(editor, span.shot.name, "COLOR", channel, span.first, span.length)
        strip.color = _DARK
        return _placed(strip)
    if strip is None:
        first = f"//{reel.folder}/{reel.files[0]}"
        strip = editor.strips.new_image(span.shot.name, first, channel, span.first, fit_method="FIT")
        for name in reel.files[1:]:
            strip.elements.append(name)
        if reel.still:
            _push(strip, span)
        return _placed(strip)
    if strip.type == "IMAGE":
        strip.directory = f"//{reel.folder}/"
        for element, name in zip(strip.elements, reel.files, strict=False):
            element.filename = name
    return strip


def _push(strip: bpy.types.Strip, span: Span) -> None:
    """Move slowly into a still."""
    for axis in ("scale_x", "scale_y"):
        usual = getattr(strip.transform, axis)
        for frame, scale in ((span.first, 1.0), (span.end, _PUSH)):
            setattr(strip.transform, axis, usual * scale)
            strip.transform.keyframe_insert(axis, frame=frame)


def _dissolve(
    editor: bpy.types.SequenceEditor, span: Span, shots: Sequence[bpy.types.Strip], wanted: set[str]
) -> None:
    """Dissolve into the next shot, if both are where they were placed; otherwise keep the artist's cut."""
    name = f"{span.shot.name} dissolve"
    if all(_is_as_placed(each) for each in shots) and name not in editor.strips:
        strip = compat.new_strip(editor, name, "CROSS", _DISSOLVES, span.free, span.overlap, shots)
        _placed(strip)
    wanted.add(name)


def _texts(project: Project) -> Iterator[tuple[str, int, int, int, _Text]]:
    """Yield name, channel, first and last frame, and text of each text strip."""
    dissolved = [0, *(reel.span.overlap for reel in project.reels)]
    for reel, before in zip(project.reels, dissolved, strict=False):
        span = reel.span
        own = [each for each in project.captions if each.span == span]
        if span.shot.picture == CARD:
            card = _Text(span.shot.caption, 0.05, (0.5, 0.5), "CENTER", "CENTER", plate=False)
            yield f"{span.shot.name} text", _WORDS, span.first + before, span.free, card
            continue
        if span.shot.caption:
            words = _Text(span.shot.caption, 0.06, (SAFE, SAFE + 0.135))
            yield f"{span.shot.name} text", _WORDS, span.first, span.free, words
        for number, caption in enumerate(own, start=1):
            facts = _Text(caption.lines, 0.042, (SAFE, SAFE))
            yield f"{span.shot.name} facts {number}", _FACTS, caption.first, caption.end, facts
    if project.mark:
        mark = _Text(project.mark, 0.042, (_BAR, SAFE), "RIGHT")
        yield "mark", _MARK, 1, project.frames + 1, mark


def _write(
    editor: bpy.types.SequenceEditor,
    project: Project,
    name: str,
    channel: int,
    frames: tuple[int, int],
    text: _Text,
    wanted: set[str],
) -> None:
    """Place a text strip."""
    first, length = frames[0], frames[1] - frames[0]
    if _kept(editor, name, (first, length, channel), text.text, wanted) is not None:
        return
    strip = compat.new_strip(editor, name, "TEXT", channel, first, length)
    strip.text, strip.font = text.text, compat.strip_typeface(text.text)
    strip.font_size = text.size * project.size[1]
    strip.color, strip.location = (1.0, 1.0, 1.0, 1.0), text.place
    strip.anchor_x, strip.anchor_y, strip.alignment_x = text.side, text.base, text.side
    strip.wrap_width = 1.0 - 2.0 * SAFE
    strip.use_shadow, strip.shadow_color = True, (0.0, 0.0, 0.0, 0.8)
    strip.use_box, strip.box_color, strip.box_margin = text.plate, _PLATE, 0.006
    _placed(strip)


def _kept(
    editor: bpy.types.SequenceEditor, name: str, place: tuple[int, int, int], text: str, wanted: set[str]
) -> bpy.types.Strip | None:
    """Return a strip that stays: it is where it should be, or somebody changed it; others are removed."""
    wanted.add(name)
    strip = editor.strips.get(name)
    if strip is None:
        return None
    if not _is_as_placed(strip) or _state(strip) == _joined(place, text):
        return strip
    editor.strips.remove(strip)
    return None


def _placed(strip: bpy.types.Strip) -> bpy.types.Strip:
    """Record the place and text of a strip."""
    strip[_PLACED] = _state(strip)
    return strip


def _is_as_placed(strip: bpy.types.Strip) -> bool:
    """Return whether a strip is as it was placed; False for strips of others."""
    return strip.get(_PLACED) == _state(strip)


def _state(strip: bpy.types.Strip) -> str:
    """Return the place and text of a strip."""
    place = (*compat.strip_span(strip), int(strip.channel))
    return _joined(place, strip.text if strip.type == "TEXT" else "")


def _joined(place: tuple[int, int, int], text: str) -> str:
    return " ".join(map(str, (*place, text)))


def _mark(scene: bpy.types.Scene, project: Project) -> None:
    """Add missing markers; existing ones keep their frames."""
    for frame, words in project.markers:
        if words not in scene.timeline_markers:
            scene.timeline_markers.new(words, frame=frame)
    scene.frame_start, scene.frame_end = 1, project.frames
    scene.render.resolution_x, scene.render.resolution_y = project.size
    scene.render.resolution_percentage = 100
    scene.render.fps, scene.render.fps_base = project.fps, 1.0
