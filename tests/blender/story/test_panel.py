"""Panel of stories: the list mirrors the storyboard in the folder, and edits are written into it."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import firetwin
import pytest
import whole_run
from bpy.utils import previews
from firetwin.jobs.worker import StoppedError
from firetwin.shot.settings import scene_file as file
from firetwin.story import film, panel, scenes, sequencer, story_file
from firetwin.story.pictures import ShotPictures
from firetwin.ui import job, scene_file, working

OPERATORS = ("make", "render", "edit", "move", "open")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with a run and its scene file; the first test makes a story there."""
    folder = tmp_path_factory.mktemp("panel")
    whole_run.write(folder / "run", cells=16)
    (folder / "scene.toml").write_text('run = "run"\ncache = "cache"\n')
    return folder


@pytest.fixture
def story(scene, folder):
    """Storyboard of the panel, as it was chosen."""
    firetwin.register()
    scene_file.fill(scene, file.read(folder / "scene.toml"), inspect=False)
    path = folder / "story" / story_file.NAME
    assert not any(getattr(bpy.ops.firetwin, f"story_{name}").poll() for name in OPERATORS)  # nothing to edit
    scene.firetwin.story_folder = str(path.parent)
    if not path.exists():
        assert not bpy.ops.firetwin.story_move.poll()
        assert bpy.ops.firetwin.story_make() == {"FINISHED"}
    before = path.read_text()
    yield path
    path.write_text(before)
    firetwin.unregister()
    assert not hasattr(bpy.types.WindowManager, "firetwin_story")
    assert not panel._thumbnails


def _listed():
    return [(each.name, each.seconds) for each in bpy.context.window_manager.firetwin_story.shots]


def _written(path):
    return [(each.name, each.seconds) for each in story_file.read(path).shots]


def test_the_list_has_the_shots_of_the_folder(story):
    assert _listed() == _written(story)
    assert [name for name, _ in _listed()][:3] == ["title", "place", "growth"]
    assert file.read(story.with_name("scene.toml")).run.samefile(story.parents[1] / "run")
    assert story.with_suffix(".srt").is_file()
    bpy.context.scene.firetwin.story_folder = str(story.parents[1])
    assert not _listed()


def test_edits_are_written_and_read_back(story):
    shown, names = bpy.context.window_manager.firetwin_story, [name for name, _ in _listed()]
    shown.index = 2
    assert bpy.ops.firetwin.story_move(by=-1) == {"FINISHED"}
    assert [name for name, _ in _written(story)] == ["title", "growth", "place", *names[3:]]
    assert shown.shots[shown.index].name == "growth"
    story.write_text(story.read_text().replace("fps = 24", "fps = 25"))  # by hand
    assert bpy.ops.firetwin.story_edit(seconds=7.5) == {"FINISHED"}
    assert bpy.ops.firetwin.story_edit(caption=r"How it\ngrew") == {"FINISHED"}
    again = story_file.read(story)
    assert (again.fps, again.shots[1].seconds, again.shots[1].caption) == (25, 7.5, "How it\ngrew")
    assert _listed() == _written(story)
    story.write_text(story.read_text().replace('name = "growth"', 'name = "other"'))
    with pytest.raises(RuntimeError, match="has changed: it has no such shot"):
        bpy.ops.firetwin.story_edit(seconds=1.0)
    assert _listed() == _written(story)


def test_a_render_is_stopped_and_finished_pictures_stay_and_are_shown(story, monkeypatch):
    picture = story.parent / "shots/growth/map/growth_map_000001.png"
    picture.parent.mkdir(parents=True)

    def make(self, resume, progress, tell, stop):
        picture.write_bytes(b"picture")
        progress(1, 2, "drawing")
        work.stop.now()
        assert stop.asked
        raise StoppedError

    monkeypatch.setattr(film.Film, "make", make)
    operator = SimpleNamespace(shot="")
    work = job.Job("Render story", panel.FIRETWIN_OT_story_render.steps(operator, bpy.context))
    with pytest.raises(StoppedError):
        work.run()
    assert picture.is_file()
    assert [key.rpartition(" ")[0] for key in panel._thumbnails[0]] == [str(picture)]


def test_thumbnails_share_a_collection(story, tmp_path, monkeypatch):
    board, new = replace(story_file.read(story), path=tmp_path / story.name), previews.new
    opened = []
    monkeypatch.setattr(previews, "new", lambda: opened.append(new()) or opened[-1])
    for shot in board.shots[:3]:
        picture = tmp_path / scenes.FOLDER / shot.name / "map" / f"{shot.name}.png"
        picture.parent.mkdir(parents=True)
        picture.write_bytes(b"picture")
    panel.show(board)
    assert [len(each) for each in opened] == [3]


def test_one_shot_is_rendered_without_the_film(story, monkeypatch):
    asked = []
    monkeypatch.setattr(ShotPictures, "make", lambda self, spans, *_: asked.extend(spans))
    assert bpy.ops.firetwin.story_render(shot="scar") == {"FINISHED"}
    assert [span.shot.name for span in asked] == ["scar"]
    with pytest.raises(RuntimeError, match='has no shot "crane"'):
        bpy.ops.firetwin.story_render(shot="crane")


def test_the_project_opens(story):
    with pytest.raises(RuntimeError, match="press Render story first"):
        bpy.ops.firetwin.story_open()
    scene = bpy.data.scenes.new(sequencer.SCENE_NAME)
    bpy.ops.wm.save_as_mainfile(filepath=str(story.with_name(film.BLEND)), copy=True)
    bpy.data.scenes.remove(scene)
    assert bpy.ops.firetwin.story_open() == {"FINISHED"}
    assert Path(bpy.data.filepath) == story.with_name(film.BLEND)
    assert sequencer.SCENE_NAME in bpy.data.scenes


class _Layout:
    """Layout that notes the calls of a panel."""

    def __init__(self):
        self.calls = []

    def __getattr__(self, name):
        def call(*arguments, **options):
            self.calls.append((name, arguments, options))
            return self

        return call


def test_the_panel_reads_no_file(story, monkeypatch):
    monkeypatch.setattr(story_file, "read", lambda _: pytest.fail("the panel reads"))
    monkeypatch.setattr(bpy.utils.previews, "new", lambda: pytest.fail("the panel loads pictures"))
    monkeypatch.setattr(working, "draw_messages", lambda *_: None)  # needs a window
    bpy.context.window_manager.firetwin_story.index = 1
    layout = _Layout()
    panel.FIRETWIN_PT_story.draw(SimpleNamespace(layout=layout), bpy.context)
    for item in bpy.context.window_manager.firetwin_story.shots:
        panel.FIRETWIN_UL_story.draw_item(None, bpy.context, layout, None, item, 0, None, "")
    drawn = [arguments[0] for name, arguments, _ in layout.calls if name == "operator"]
    assert {each.split(".")[1] for each in drawn} == {f"story_{name}" for name in OPERATORS}
    assert "Render place" in [options.get("text") for _, _, options in layout.calls]
    assert "6 s" in [options.get("text") for _, _, options in layout.calls]
