"""Faults around an artist: Esc at any time, a lost run, a full disk, several scenes, libraries."""

import time
from types import SimpleNamespace

import bpy
import panel_scene
import pytest
from firetwin.blender import owned
from firetwin.errors import Error
from firetwin.jobs.worker import StoppedError
from firetwin.shot.settings import scene_file as file
from firetwin.ui import build, camera_list, job, queue, run, scene_file, working
from panel_scene import state
from small_scene import simplify_looks


@pytest.fixture(scope="module")
def blend(run_folder, tmp_path_factory):
    """A scene that the panel built, as a file, with a copy of the run that may vanish."""
    with pytest.MonkeyPatch.context() as patch:
        simplify_looks(patch)
        return panel_scene.build_with_run(run_folder, tmp_path_factory.mktemp("failures"))


@pytest.fixture
def panel(blend):
    """A built scene of the panel."""
    yield from panel_scene.opened(blend)


def stopped_after(count):
    """Build, stopped after so many steps, as the window ends it; the last of them, or None: it was done."""
    bpy.ops.ed.undo_push(message="before")
    work = job.Job("Build scene", build.FIRETWIN_OT_build.steps(SimpleNamespace(part="all"), bpy.context))
    for _ in range(count):
        if work._step(wait=True):
            return None
    work.stop.now()
    with pytest.raises(StoppedError):
        work.run()
    if work.touched:
        bpy.ops.ed.undo_push(message="Build scene")
        working.undo_last()
    return work.what


def test_a_build_stopped_at_every_third_step_leaves_the_scene_as_it_was(panel, plain_looks):
    bpy.context.scene.objects["Firetwin Ground"].location.x = 5.0  # by hand
    panel.light.haze = 0.7
    before, seen = state(), []
    while (what := stopped_after(3 * len(seen))) is not None:
        seen.append(what)
        assert state() == before, what
    assert seen[0] == "Build scene"
    assert len(set(seen)) > 3
    assert state() != before


def test_a_first_build_stopped_in_the_middle_brings_the_startup_scene_back(panel, plain_looks, blend):
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    bpy.context.scene.firetwin.scene_file = str(blend.with_suffix(".toml"))
    before = state()
    assert stopped_after(7) == "building the smoke"
    assert state() == before
    assert set(bpy.context.scene.objects.keys()) == {"Cube", "Light", "Camera"}


def message(operator, **options):
    """Return the message of an operator that fails."""
    with pytest.raises(RuntimeError) as refused:
        operator(**options)
    text = str(refused.value)
    assert "Traceback" not in text
    assert "Unexpected" not in text
    return text


def test_a_run_that_vanishes_is_a_message_and_nothing_is_lost(panel, plain_looks, blend, tmp_path):
    folder, scene = blend.parent / "run", bpy.context.scene
    facts, cameras = panel.facts, camera_list.cameras(panel)
    hidden, panel.which, panel.output = folder.rename(blend.parent / "away"), "frame", str(tmp_path)
    before = state()
    try:
        for frame in (2, 3, 1):
            scene.frame_set(frame)
        for call, options in (
            (bpy.ops.firetwin.inspect, {}),
            (bpy.ops.firetwin.build, {}),
            (bpy.ops.firetwin.build, {"part": "fire"}),
            (bpy.ops.firetwin.camera_add, {"kind": "poses"}),
            (bpy.ops.firetwin.camera_aim, {"target": "head"}),
            (bpy.ops.firetwin.render, {}),
            (bpy.ops.firetwin.assets, {}),
        ):
            assert "check the path" in message(call, **options), call
            assert state() == before
        assert (panel.facts, camera_list.cameras(panel)) == (facts, cameras)
        assert "check the path" in panel.problem
        bpy.ops.firetwin.render_background()
        (item,) = queue.items
        while item.state == queue.RENDERING:
            time.sleep(0.01)
        assert (item.state, "check the path" in item.text) == (queue.FAILED, True)
    finally:
        hidden.rename(folder)
    assert bpy.ops.firetwin.inspect() == {"FINISHED"}
    assert not panel.problem
    assert bpy.ops.firetwin.build(part="fire") == {"FINISHED"}


def test_reading_a_run_that_is_stopped_says_how_to_go_on(panel):
    work = job.Job("Read run", run.inspect_run(bpy.context.scene.session_uid))
    work._step(wait=True)
    work.stop.now()
    with pytest.raises(StoppedError):
        work.run()
    assert panel.problem.endswith("use Read run")
    assert panel.facts


def names(scene):
    """Return the content of a scene, with the identity of its data."""
    return {(thing.name, thing.session_uid) for thing in scene.objects}


def test_two_scenes_of_one_file_do_not_mix(panel, plain_looks, blend):
    first = bpy.context.scene
    bpy.ops.scene.new(type="NEW")
    second = bpy.context.window.scene
    second.name = "Second"
    second.firetwin.scene_file = str(blend.with_suffix(".toml"))
    before = names(first), file.text(scene_file.read_settings(first))
    assert bpy.ops.firetwin.build() == {"FINISHED"}
    assert not names(first) & names(second)
    assert not set(first.collection.children_recursive) & set(second.collection.children_recursive)
    assert len(names(first)) == len(names(second))
    assert second.camera == owned.stage(second).camera("drone") != first.camera
    second.camera.location.z, second.camera.name = 7000.0, "Other"
    assert bpy.ops.firetwin.build(part="cameras") == {"FINISHED"}
    assert second.firetwin.cameras.keys() == ["Other"]
    assert (names(first), file.text(scene_file.read_settings(first))) == before
    assert bpy.ops.firetwin.remove() == {"FINISHED"}
    assert not second.objects
    assert names(first) == before[0]
    bpy.context.window.scene = first
    assert bpy.ops.firetwin.build() == {"FINISHED"}
    assert first.firetwin.cameras.keys() == ["drone"]


CAMERA = ("camera_key", "camera_aim", "camera_path", "camera_lens")
REFUSED = ("inspect", "build", "remove", "camera_add", *CAMERA, "render", "open", "quality")


def test_what_is_linked_is_left_alone_and_what_is_appended_is_ours(panel, plain_looks, blend):
    there = file.text(scene_file.read_settings(bpy.context.scene))
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(str(blend), link=True) as (source, wanted):
        wanted.scenes = source.scenes
    (linked,) = wanted.scenes
    bpy.context.window.scene = linked
    for name in REFUSED:
        assert "linked" in message(getattr(bpy.ops.firetwin, name)), name
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(str(blend)) as (source, wanted):
        wanted.scenes = source.scenes
    (appended,) = wanted.scenes
    bpy.context.window.scene = appended
    assert file.text(scene_file.read_settings(appended)) == there
    before = {name for name, _ in names(appended)}
    assert bpy.ops.firetwin.build() == {"FINISHED"}
    assert {name for name, _ in names(appended)} == before
    with bpy.data.libraries.load(str(blend), link=True) as (source, wanted):
        wanted.objects = ["Firetwin Camera drone"]
    appended.collection.objects.link(wanted.objects[0])
    appended.camera = wanted.objects[0]
    for name in CAMERA:
        assert "linked" in message(getattr(bpy.ops.firetwin, name)), name
    assert bpy.ops.firetwin.remove() == {"FINISHED"}
    assert appended.objects.keys() == ["Firetwin Camera drone"]


def test_reports_are_one_line_without_what_turns_or_colours_text():
    text = "a\x1b[31m\nb\u202e"
    assert job.describe_error(Error(text)) == job.Message(text).text == "a\\x1b[31m\\nb\\u202e"
