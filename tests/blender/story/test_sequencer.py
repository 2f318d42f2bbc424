"""Projects of stories: strips by name, and what an artist changed stays when the shots are rendered again."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import bpy
import numpy as np
import opentimelineio
import pytest
from firetwin.blender import compat
from firetwin.cuts import otio
from firetwin.story import sequencer, timeline
from firetwin.story.captions import Caption
from firetwin.story.sequencer import Project, Reel
from firetwin.story.storyboard import CARD, Storyboard, StoryShot
from firetwin.story.words import LETTERS, SAFE
from firetwin_core import sensor

START = datetime(2014, 9, 17, 23, tzinfo=UTC)
SIZE = (32, 18)


@pytest.fixture
def project(tmp_path):
    """A title and two shots of 2 s, whose three pictures are held, with captions and a marker."""
    shots = (
        StoryShot("title", CARD, seconds=1.0, caption="A fire"),
        StoryShot(
            "chase", start=START, end=START + timedelta(seconds=2), seconds=2.0, caption="From a drone"
        ),
        StoryShot("above", start=START, end=START + timedelta(seconds=2), seconds=2.0, caption="From above"),
    )
    spans = timeline.lay_out(Storyboard(shots=shots))
    for name in ("chase", "above"):
        for k in range(1, 4):
            path = tmp_path / "shots" / name / f"{name}_{k}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            sensor.write_image(path, np.full((*SIZE[::-1], 3), 0.2 * k, np.float32))
    return Project(
        tmp_path / "story.blend",
        tuple(map(_reel, spans)),
        tuple(
            Caption(each, each.first, each.free, each.shot.caption, START, f"t{k}")
            for k, each in enumerate(spans)
        ),
        ((30, "ignition"),),
        SIZE,
        24,
        "synthetic",
    )


def _reel(span):
    if span.shot.picture == CARD:
        return Reel(span)
    name = span.shot.name
    files = tuple(f"{name}_{1 + 3 * k // span.length}.png" for k in range(span.length))
    return Reel(span, f"shots/{name}", files, still=name == "above")


@pytest.fixture
def cut(scene, project):
    """A scene with the project."""
    sequencer.set_up(scene)
    sequencer.lay_out(scene, project)
    return scene


def _places(cut):
    return {each.name: (each.channel, *_ends(each)) for each in cut.sequence_editor.strips}


def _ends(strip):
    first, length = compat.strip_span(strip)
    return first, first + length


def _move(strip, frames):
    """Move a strip as an artist does; the property has another name from 5.2 on."""
    name = "content_start" if hasattr(strip, "content_start") else "frame_start"
    setattr(strip, name, getattr(strip, name) + frames)


def test_each_shot_text_and_dissolve_has_a_strip(cut, project):
    assert _places(cut) == {
        "title": (1, 1, 25),
        "chase": (2, 13, 61),
        "above": (1, 49, 97),
        "title dissolve": (3, 13, 25),
        "chase dissolve": (3, 49, 61),
        "title text": (4, 1, 13),
        "chase text": (4, 13, 49),
        "chase facts 1": (5, 13, 49),
        "above text": (4, 49, 97),
        "above facts 1": (5, 49, 97),
        "mark": (6, 1, 97),
    }
    assert (cut.frame_start, cut.frame_end, cut.render.fps) == (1, 96, 24)
    assert [(each.name, each.frame) for each in cut.timeline_markers] == [("ignition", 30)]
    chase = cut.sequence_editor.strips["chase"]
    assert [each.filename for each in chase.elements] == list(project.reels[1].files)
    assert Path(bpy.path.abspath(chase.directory, start=str(project.path.parent))).name == "chase"
    assert cut.sequence_editor.strips["title text"].text == "A fire"


def test_the_text_of_a_card_follows_the_dissolve_into_it(scene, project):
    shots = tuple(replace(project.reels[0].span.shot, name=name) for name in ("title", "end"))
    reels = tuple(map(_reel, timeline.lay_out(Storyboard(shots=shots))))
    sequencer.set_up(scene)
    sequencer.lay_out(scene, replace(project, reels=reels, captions=()))
    assert _places(scene)["end"] == (2, 13, 37)
    assert _places(scene)["end text"] == (4, 25, 37)


def _luminance(level):
    """Relative luminance of a grey (WCAG 2.2)."""
    return level / 12.92 if level <= 0.04045 else ((level + 0.055) / 1.055) ** 2.4


def test_letters_are_readable_on_any_picture(cut):
    """Contrast of WCAG 2.2 over white, the safe area of EBU R 95, and a least size at any resolution."""
    for strip in cut.sequence_editor.strips:
        if strip.type == "TEXT":
            behind = 1.0 - strip.box_color[3] if strip.use_box else max(sequencer._DARK)
            assert (1.0 + 0.05) / (_luminance(behind) + 0.05) >= 4.5, strip.name
            assert strip.font_size >= LETTERS * SIZE[1]
            assert all(SAFE <= part <= 1.0 - SAFE for part in strip.location)
            assert strip.wrap_width <= 1.0 - 2.0 * SAFE


def test_letters_of_other_scripts_are_not_boxes(scene, project):
    words = {"title": "A fire", "chase": "Über Größe", "above": "火災"}
    shown = [replace(each, words=words[each.span.shot.name]) for each in project.captions]
    reels = [
        replace(
            each, span=replace(each.span, shot=replace(each.span.shot, caption=words[each.span.shot.name]))
        )
        for each in project.reels
    ]
    sequencer.set_up(scene)
    sequencer.lay_out(scene, replace(project, captions=tuple(shown), reels=tuple(reels)))
    fonts = {name: scene.sequence_editor.strips[f"{name} text"].font for name in words}
    assert fonts["title"] == fonts["chase"] == compat.typeface()
    assert fonts["above"] is None  # the built-in typefaces, which have these letters


def test_a_still_is_moved_over(cut):
    above, scales = cut.sequence_editor.strips["above"], []
    for frame in (49, 97):
        cut.frame_set(frame)
        scales.append(above.transform.scale_x)
    assert scales[1] == pytest.approx(1.06 * scales[0])


def test_the_artist_s_cut_stays_and_shows_new_pictures(cut, project):
    strips = cut.sequence_editor.strips
    _move(strips["above"], 40)
    strips["chase text"].text = "By drone"
    strips.remove(strips["mark"])
    finer = replace(project.reels[1], files=tuple(f"chase_{k}.png" for k in range(48)))
    sequencer.lay_out(cut, replace(project, reels=(project.reels[0], finer, project.reels[2])))
    assert _places(cut)["above"] == (1, 89, 137)
    assert strips["chase text"].text == "By drone"
    assert "mark" in strips
    assert [each.filename for each in strips["chase"].elements] == list(finer.files)


def test_strips_that_nobody_changed_follow_the_storyboard(cut, project):
    before = _places(cut)
    sequencer.lay_out(cut, project)
    assert _places(cut) == before
    shots = tuple(replace(each.span.shot, seconds=1.0) for each in project.reels[:2])
    reels = tuple(map(_reel, timeline.lay_out(Storyboard(shots=shots))))
    sequencer.lay_out(cut, replace(project, reels=reels, captions=()))
    assert _places(cut) == {
        "title": (1, 1, 25),
        "chase": (2, 13, 37),
        "title dissolve": (3, 13, 25),
        "title text": (4, 1, 13),
        "chase text": (4, 13, 37),
        "mark": (6, 1, 37),
    }


def _strips(cut):
    """Shot that each frame shows: the strip of the highest channel, after a dissolve begins the next one."""
    shown = []
    for frame in range(1, cut.frame_end + 1):
        there = [
            each
            for each in cut.sequence_editor.strips
            if each.type in ("IMAGE", "COLOR", "CROSS") and _ends(each)[0] <= frame < _ends(each)[1]
        ]
        top = max(there, key=lambda each: each.channel, default=None)
        shown.append(top and (top.input_2 if top.type == "CROSS" else top).name)
    return shown


def _played(timeline):
    """Clip and picture of the film at each frame of the first track."""
    played = []
    for item in timeline.video_tracks()[0]:
        at, length = item.source_range.start_time, round(item.source_range.duration.value)
        is_clip = isinstance(item, opentimelineio.schema.Clip)
        start = item.media_reference.available_range.start_time if is_clip else at
        played += [
            (item.name or None, round((at - start).value) + k if is_clip else k) for k in range(length)
        ]
    return played


@pytest.mark.parametrize("moved", [0, -30, 20])
def test_the_cut_for_other_programs_shows_the_strips(cut, moved):
    strips = cut.sequence_editor.strips
    _move(strips["above"], moved)
    edit = sequencer.describe_cut(cut, "story.mp4")
    timeline = opentimelineio.adapters.read_from_string(otio.text(edit), "otio_json")
    played = _played(timeline)
    shown = _strips(cut)
    assert [name for name, _ in played] == shown[: len(played)]
    assert not any(shown[len(played) :])
    assert all(at == k for k, (name, at) in enumerate(played) if name)  # the film's frame at its own time
    assert [each.name for each in timeline.tracks.markers] == ["ignition"]
