"""A file of `firetwin build --live` is as complete in the panels as a scene that they built."""

import bpy
import firetwin
import pytest
from firetwin.blender import owned
from firetwin.jobs import build as build_job
from firetwin.jobs import worker
from firetwin.scene import built
from firetwin.scene.live import build as live_build
from firetwin.scene.smoke import volume_files
from firetwin.shot.source import ShotSource
from firetwin.ui import job, landmarks, panel_state, scene_file, time
from firetwin.ui.live import FIRETWIN_OT_live, FIRETWIN_OT_show_live
from firetwin.ui.viewport.panel import FIRETWIN_PT_viewport
from firetwin.ui.vr import landmark_list
from firetwin.ui.vr.panel import FIRETWIN_PT_vr
from made_once import made_once
from panel_scene import SCENE
from small_scene import simplify_looks
from smoke_scene import here


@pytest.fixture(scope="session")
def live_file(factory, run_folder, tmp_path_factory):
    """A file of `firetwin build --live`."""

    def make(folder):
        (folder / "scene.toml").write_text(SCENE.format(run=run_folder))
        with pytest.MonkeyPatch.context() as patch:
            simplify_looks(patch)
            patch.setattr(live_build, "TRIANGLES", 8000)
            patch.setattr(worker, "run", here)
            build_job.run(ShotSource(scene=str(folder / "scene.toml")), folder / "scene.blend", live=True)

    return made_once(tmp_path_factory, "job_scene", make) / "scene.blend"


@pytest.fixture
def opened(live_file):
    """Its scene, opened with the add-on."""
    firetwin.register()
    bpy.ops.wm.open_mainfile(filepath=str(live_file))
    yield bpy.context.scene
    firetwin.unregister()


def unavailable():
    """Names of panels and operators of a built scene that are not available."""
    every = (FIRETWIN_PT_viewport, FIRETWIN_PT_vr, FIRETWIN_OT_live, FIRETWIN_OT_show_live)
    return [each.__name__ for each in every if not each.poll(bpy.context)]


def state(scene):
    """Facts and settings of a scene in its panels."""
    panel = scene.firetwin
    facts = {name: getattr(panel, name) for name in built.NAMES}
    return facts, panel.changed, scene_file.read_settings(scene)


def test_panels_know_what_they_know_of_their_own_build(opened, panel_blend):
    assert not unavailable()
    facts, changed, settings = state(opened)
    bpy.ops.wm.open_mainfile(filepath=str(panel_blend))
    expected, _, same = state(bpy.context.scene)
    assert facts == pytest.approx(expected)
    assert changed == ""
    assert (settings.run, settings.cameras, settings.time) == (same.run, same.cameras, same.time)


def test_time_and_landmarks_are_those_of_the_frame(opened):
    places = []
    for frame in (1, 3):
        opened.frame_set(frame)
        assert time.shown_time(opened.firetwin).isoformat() == f"2014-09-17T2{(frame + 1) // 2}:00:00+00:00"
        places.append(landmark_list.pose(opened, landmarks.HEAD).place)
    assert (places[1] - places[0]).length > 100.0
    assert landmark_list.names(opened)[:2] == [landmarks.HEAD, landmarks.IGNITION]


def test_opening_reads_no_run(live_file, monkeypatch):
    monkeypatch.setattr(job.Job, "last", None)
    firetwin.register()
    bpy.ops.wm.open_mainfile(filepath=str(live_file))
    assert bpy.context.scene.firetwin.facts == ""
    assert job.Job.last is None
    firetwin.unregister()


def test_without_stored_facts_nothing_is_built_for_the_panels(opened, tmp_path):
    built.clear(owned.stage(opened))
    for name in built.NAMES:
        opened.firetwin.property_unset(name)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "earlier.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "earlier.blend"))
    assert len(unavailable()) == 4
    with pytest.raises(RuntimeError, match=panel_state.BUILD_FIRST):
        bpy.ops.firetwin.show_live()


def test_a_removed_scene_stays_removed(opened, tmp_path):
    mine = bpy.data.objects.new("Mine", None)
    owned.stage(opened).root.objects.link(mine)  # so that the collection stays
    bpy.ops.firetwin.remove()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "removed.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "removed.blend"))
    assert bpy.context.scene.firetwin.first_time == ""
    assert len(unavailable()) == 4


def test_own_settings_of_a_file_stay(opened, live_file, tmp_path):
    opened.firetwin.seed = 77
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))
    panel = bpy.context.scene.firetwin
    assert panel.seed == 77
    assert panel.changed == "seed"


def test_settings_of_another_version_are_told(opened):
    opened.firetwin.property_unset("run")
    volume_files.store_source(owned.stage(opened), "nonsense = 1", "")
    panel_state.show(opened)
    assert "nonsense" in opened.firetwin.problem
    assert not unavailable()


def test_the_open_file_is_shown_when_the_addon_is_enabled(live_file):
    bpy.ops.wm.open_mainfile(filepath=str(live_file))
    firetwin.register()
    assert unavailable()
    panel_state.show_all()  # a timer calls it in a window
    assert not unavailable()
    firetwin.unregister()
    assert panel_state.show_all not in bpy.app.handlers.load_post


def test_linked_scenes_are_left_alone(opened, live_file):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(live_file), link=True) as (there, to):
        to.scenes = there.scenes
    panel_state.show_all()
    assert [each.firetwin.first_time for each in bpy.data.scenes] == ["", ""]
