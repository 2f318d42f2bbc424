"""Smoke volumes of a built scene: missing, made on demand, and announced in the picture."""

import shutil
from functools import partial
from pathlib import Path
from unittest.mock import MagicMock

import bpy
import firetwin
import pytest
import smoke_scene
from firetwin.blender import owned
from firetwin.jobs import bake as bake_job
from firetwin.jobs import build as build_job
from firetwin.jobs import worker
from firetwin.scene.smoke import volume_files
from firetwin.shot.source import ShotSource
from firetwin.smoke import bake
from firetwin.ui import job, smoke_volumes, working
from smoke_scene import here


@pytest.fixture(scope="module")
def folder(run_folder, tmp_path_factory):
    """A folder with a scene file and its .blend file, of which no smoke volume is written."""
    place = tmp_path_factory.mktemp("volumes")
    said = smoke_scene.write(place, run_folder)
    told = next(text for text in said if "no smoke volume yet" in text)
    assert told.startswith("3 frames of scene.blend")
    assert told.endswith(f"firetwin bake --volumes {place / 'scene.toml'}")
    assert not (place / "cache").exists()
    return place


@pytest.fixture
def opened(folder, tmp_path, monkeypatch):
    """A copy of that file in its folder, opened with the add-on; work is done in this process."""
    monkeypatch.setattr(worker, "run", here)
    shutil.rmtree(folder / "cache", ignore_errors=True)
    firetwin.register()
    bpy.ops.wm.open_mainfile(filepath=str(folder / "scene.blend"))
    yield owned.stage(bpy.context.scene)
    firetwin.unregister()


def instances(what="Firetwin Smoke Notice"):
    """Count the instances of an object in the scene as it is drawn."""
    graph = bpy.context.evaluated_depsgraph_get()
    return sum(each.is_instance and each.object.name == what for each in graph.object_instances)


def has_grids(stage):
    """Return whether Blender finds the file of the shown frame."""
    evaluated = volume_files.volumes(stage)[-1].evaluated_get(bpy.context.evaluated_depsgraph_get())
    grids = evaluated.data.grids
    grids.load()  # its result is of the first attempt
    return len(grids) > 0


def drawn():
    """Return the paragraphs and the texts of buttons that the panel draws."""
    layout, texts = MagicMock(), []
    layout.column.return_value = layout
    layout.row.return_value = layout
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(smoke_volumes, "draw_paragraph", lambda context, layout, text, *_: texts.append(text))
        patch.setattr(working, "draw_messages", lambda *_: None)
        smoke_volumes.draw(bpy.context, layout)
    return texts, [call.kwargs["text"] for call in layout.operator.call_args_list if "text" in call.kwargs]


def test_a_frame_without_its_volume_says_so_in_the_picture_and_no_other(opened, folder):
    """Also without the add-on, and after all files are moved together."""
    firetwin.unregister()
    try:
        scene = bpy.context.scene
        for frame in (1, 2, 3):
            scene.frame_set(frame)
            assert instances() == 1
        scene.frame_set(4)
        assert instances() == 0  # the shot ends before
        place = bake.bake(ShotSource(scene=str(folder / "scene.toml")).shot(), frames=[2])
        assert sorted(path.name for path in place.iterdir()) == ["smoke_000002.txt", "smoke_000002.vdb"]
        for frame, shown in ((1, 1), (2, 0), (3, 1)):
            scene.frame_set(frame)
            assert instances() == shown
            assert has_grids(opened) == (not shown)
        moved = folder.with_name("moved")
        shutil.copytree(folder, moved)
        shutil.rmtree(folder / "cache")
        bpy.ops.wm.open_mainfile(filepath=str(moved / "scene.blend"))
        bpy.context.scene.frame_set(2)
        assert instances() == 0
        shutil.rmtree(moved)
    finally:
        firetwin.register()


def test_letters_of_the_notice_fill_a_part_of_the_picture(opened):
    bpy.context.scene.frame_set(1)
    graph = bpy.context.evaluated_depsgraph_get()
    (matrix,) = (
        each.matrix_world.copy()
        for each in graph.object_instances
        if each.is_instance and each.object.name == "Firetwin Smoke Notice"
    )
    camera = bpy.context.scene.camera
    letters = bpy.data.meshes["Firetwin Smoke Notice"]
    letters = next(mesh for mesh in bpy.data.meshes if mesh.name.startswith(letters.name) and mesh.polygons)
    corners = [camera.matrix_world.inverted() @ matrix @ vertex.co for vertex in letters.vertices]
    half = camera.data.sensor_width / camera.data.lens / 2
    across = [corner.x / -corner.z / half for corner in corners]
    assert all(corner.z < -camera.data.clip_start for corner in corners)
    assert 0.4 < max(across) - min(across) < 1.9
    assert max(map(abs, across)) < 0.95


def test_a_button_writes_the_shown_frame_or_the_playback_range(opened, folder):
    scene = bpy.context.scene
    texts, buttons = drawn()
    assert texts == [
        "Frame 1 has no smoke volume yet: Blender shows it without smoke",
        "0 of 3 frames have their smoke",
    ]
    assert buttons == ["Smoke of frame 1", "Of frames 1 to 3"]
    assert bpy.ops.firetwin.smoke_volumes(which="frame") == {"FINISHED"}
    assert volume_files.missing(opened) == [2, 3]
    assert has_grids(opened)
    assert instances() == 0
    texts, buttons = drawn()
    assert texts == ["1 of 3 frames have their smoke"]
    scene.use_preview_range = True
    scene.frame_preview_start, scene.frame_preview_end = 1, 2
    assert drawn()[1] == ["Smoke of frame 1", "Of frames 1 to 2"]
    assert bpy.ops.firetwin.smoke_volumes(which="range") == {"FINISHED"}
    assert volume_files.missing(opened) == [3]
    assert "Wrote the smoke of 1 frame" in [each.text for each in job.Job.last.messages]
    scene.use_preview_range = False
    assert bpy.ops.firetwin.smoke_volumes(which="range") == {"FINISHED"}
    assert not volume_files.missing(opened)
    assert drawn() == ([], [])
    assert bpy.ops.firetwin.smoke_volumes(which="frame") == {"FINISHED"}
    assert job.Job.last.messages[-1].text == "These frames have their smoke already"


def test_the_panel_notices_what_another_program_wrote(opened, folder):
    drawn()
    bake.bake(ShotSource(scene=str(folder / "scene.toml")).shot(), frames=[2])
    assert drawn()[0][-1] == "0 of 3 frames have their smoke"  # drawing reads no files
    bpy.context.scene.frame_set(2)
    assert drawn()[0] == ["1 of 3 frames have their smoke"]


def test_without_smoke_there_is_no_button(panel):
    assert not smoke_volumes.FIRETWIN_OT_smoke_volumes.poll(bpy.context)
    assert drawn() == ([], [])
    with pytest.raises(RuntimeError, match="Build a scene with smoke first"):
        bpy.ops.firetwin.smoke_volumes()


def test_a_removed_scene_has_no_button(opened):
    assert drawn()[1]
    bpy.ops.firetwin.remove()
    assert drawn() == ([], [])


def test_a_stop_keeps_what_is_written_and_shows_it(opened, monkeypatch):
    def stopped(work, *given, **more):
        choice, volumes, _ = work.args
        here(partial(work.func, choice, volumes, [1]), lambda *_: None)
        raise worker.StoppedError

    monkeypatch.setattr(worker, "run", stopped)
    assert bpy.ops.firetwin.smoke_volumes(which="range") == {"CANCELLED"}
    assert job.Job.last.messages[-1].text == "Write smoke of frames: stopped; finished work remains"
    assert volume_files.missing(opened) == [2, 3]
    assert has_grids(opened)


def test_a_file_of_an_earlier_version_asks_for_a_build(opened):
    volume_files.store_source(opened, "", "")
    with pytest.raises(RuntimeError, match="build it again"):
        bpy.ops.firetwin.smoke_volumes()


def test_volumes_of_changed_code_are_found_in_their_new_folder(opened, monkeypatch):
    """The cache folder depends on the code that makes the smoke."""
    before = volume_files.folder(opened)
    monkeypatch.setattr(bake, "SHOWN", (*bake.SHOWN, "more"))
    bpy.ops.firetwin.smoke_volumes(which="frame")
    assert volume_files.folder(opened) != before
    assert has_grids(opened)
    assert instances() == 0


def test_a_frame_is_completed_before_it_is_rendered(opened, capfd):
    scene = bpy.context.scene
    scene.frame_set(2)
    smoke_volumes.write_before_render(scene)
    assert volume_files.missing(opened) == [1, 3]
    assert "writing the smoke of frame 2 before it is rendered" in capfd.readouterr().err
    smoke_volumes.write_before_render(scene)
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("hide", ["object", "layers"])
def test_smoke_that_is_not_rendered_is_not_written(opened, hide):
    """Skip smoke for the integrated renderer and for passes without smoke."""
    for obj in volume_files.volumes(opened):
        obj.hide_render = hide == "object"
    for layer in opened.scene.view_layers:
        layer.use = hide == "object" or layer.name == "depth"
    smoke_volumes.write_before_render(opened.scene)
    assert volume_files.missing(opened) == [1, 2, 3]


def test_a_render_that_cannot_have_its_smoke_says_why(opened, folder, capfd):
    text, run = volume_files.read_source(opened)
    volume_files.store_source(opened, text.replace('run = "', 'run = "/gone'), run)
    smoke_volumes.write_before_render(opened.scene)
    said = capfd.readouterr().err.splitlines()[-1]
    assert said.startswith("firetwin: frame 1 is rendered without smoke: ")
    assert str(Path("/gone")) in said
    (message,) = job.Job.last.messages
    assert (message.level, f"firetwin: {message.text}") == ("ERROR", said)
    assert instances() == 1


def test_all_volumes_can_be_written_with_the_file(folder, tmp_path, monkeypatch):
    """Write them through the job of `firetwin build --volumes` and `firetwin bake --volumes`."""
    monkeypatch.setattr(worker, "run", here)
    shutil.copy(folder / "scene.toml", tmp_path)
    choice, said = ShotSource(scene=str(tmp_path / "scene.toml")), []
    (place,) = bake_job.run(choice, volumes=True, frames=[1])
    assert [path.name for path in place.glob("*.vdb")] == ["smoke_000001.vdb"]
    build_job.run(choice, tmp_path / "scene.blend", tell=said.append, volumes=True)
    assert not any("no smoke volume yet" in text for text in said)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    stage = owned.stage(bpy.context.scene)
    assert volume_files.folder(stage) == place
    assert not volume_files.missing(stage)


def test_handlers_are_gone_with_the_add_on(panel):
    def ours():
        return [
            handler
            for name in dir(bpy.app.handlers)
            if isinstance(handlers := getattr(bpy.app.handlers, name), list)
            for handler in handlers
            if handler.__module__ == smoke_volumes.__name__
        ]

    assert len(ours()) == 5
    firetwin.unregister()
    assert not ours()
    firetwin.register()
