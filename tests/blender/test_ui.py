"""The panel: what is refused and why, what its operators do, how work is stopped, and what is left."""

import time
from types import SimpleNamespace

import bpy
import firetwin
import pytest
from firetwin.ui import clock, job, render, run, view

SCENE = """\
run = "{run}"
cache = "cache"
[time]
start = 2014-09-17T21:00:00Z
end = 2014-09-17T22:00:00Z
frames = 3
[terrain]
near_radius = 0.0
apron = 20000.0
[forest]
stand_radius = 0.0
[smoke]
enabled = false
[render]
resolution = [64, 36]
samples = 1
video = false
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.825
longitude = -120.56
height = 400.0
target = "fire"
"""


@pytest.fixture
def settings():
    """The panel of a new file, as Blender starts with."""
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    yield bpy.context.scene.firetwin
    if hasattr(bpy.types.Scene, "firetwin"):
        firetwin.unregister()


@pytest.fixture
def scene_file(run_folder, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(run=run_folder))
    return path


def inventory():
    """What an add-on can leave in Blender."""
    handlers = [
        (kind, function)
        for kind in dir(bpy.app.handlers)
        if isinstance(functions := getattr(bpy.app.handlers, kind), list)
        for function in functions
    ]
    kinds = bpy.types, bpy.types.Scene, bpy.types.WindowManager, bpy.types.Object, bpy.ops.firetwin
    return handlers, [set(dir(kind)) for kind in kinds]


def test_unregister_leaves_nothing():
    bpy.ops.wm.read_factory_settings()
    before = inventory()
    for _ in range(2):
        firetwin.register()
        assert inventory() != before
        assert bpy.context.scene.firetwin.run == ""
        firetwin.unregister()
        assert inventory() == before


def refusal(operator):
    """Why an operator cannot be called."""
    assert not operator.poll()
    with pytest.raises(RuntimeError) as refused:
        operator()
    return str(refused.value)


def test_every_refusal_says_what_to_do(settings, run_folder, scene_file):
    assert "Choose a run folder" in refusal(bpy.ops.firetwin.build)
    assert "Choose a run folder" in refusal(bpy.ops.firetwin.inspect)
    assert "Build the scene first" in refusal(bpy.ops.firetwin.view)
    assert "Nothing goes on" in refusal(bpy.ops.firetwin.stop)
    settings.run = str(run_folder)
    assert "Save the .blend file" in refusal(bpy.ops.firetwin.build)
    assert "Save the .blend file" in refusal(bpy.ops.firetwin.render)
    settings.scene_file = str(scene_file)
    assert bpy.ops.firetwin.build.poll()  # a scene file says where the smoke is kept
    assert "Save the .blend file" in refusal(bpy.ops.firetwin.render)
    settings.output = str(run_folder.parent / "out")
    assert bpy.ops.firetwin.render.poll()
    settings.passes = set()
    assert "pass" in refusal(bpy.ops.firetwin.render)
    settings.passes = {"rgb"}
    job.Job.current = job.Job("Build scene", iter(()))
    try:
        assert "Build scene is not finished" in refusal(bpy.ops.firetwin.render)
        assert bpy.ops.firetwin.stop.poll()
    finally:
        job.Job.current = None


def test_a_run_is_known_as_soon_as_it_is_chosen(settings, run_folder):
    settings.run = str(run_folder)
    found = run.read(settings.facts)
    rows = dict(found["rows"])
    assert rows["Grid"].startswith("24 x 24 cells of 3")
    assert rows["First"] == "17 Sep 2014 14:00 PDT"
    assert rows["Burned"].endswith("acres")
    assert found["cameras"] == ["overview", "satellite"]
    assert [item[0] for item in render.camera_items(settings, None)] == ["*", "overview", "satellite"]


def test_a_scene_file_brings_its_run(settings, scene_file, run_folder):
    settings.scene_file = str(scene_file)
    assert settings.run == str(run_folder)
    assert run.read(settings.facts)["cameras"] == ["drone"]
    assert not settings.problem


@pytest.mark.parametrize(
    ("text", "place", "remedy"),
    [("[time]\nframe = 3\n", "scene.toml:2:1", 'did you mean "frames"'), ("run = \n", "scene.toml:1:7", "")],
)
def test_a_mistake_in_a_scene_file_is_shown_with_its_place(settings, tmp_path, text, place, remedy):
    (tmp_path / "scene.toml").write_text(text)
    settings.scene_file = str(tmp_path / "scene.toml")
    assert place in settings.problem
    assert remedy in settings.problem
    assert not settings.facts


def test_a_missing_run_is_shown_and_reported(settings, tmp_path):
    settings.run = str(tmp_path / "nowhere")
    assert settings.problem.startswith(str(tmp_path / "nowhere"))
    assert "check the path" in settings.problem
    with pytest.raises(RuntimeError, match="check the path"):
        bpy.ops.firetwin.inspect()
    settings.output = str(tmp_path)
    before = set(bpy.data.objects)
    with pytest.raises(RuntimeError, match="check the path"):
        bpy.ops.firetwin.build()
    assert set(bpy.data.objects) == before


def test_build_takes_the_place_of_the_startup_scene(settings, scene_file):
    settings.scene_file = str(scene_file)
    assert bpy.ops.firetwin.build() == {"FINISHED"}
    names = {thing.name for thing in bpy.context.scene.objects}
    assert {"Firetwin Terrain", "Firetwin Camera drone", "Firetwin Sun"} <= names
    assert not {"Cube", "Light", "Camera"} & names
    assert settings.frames == 3
    assert settings.extent == pytest.approx(24 * 370, rel=0.05)


def test_build_keeps_what_somebody_made(settings, scene_file):
    bpy.data.objects["Cube"].location.x = 1.0
    bpy.context.view_layer.update()
    settings.scene_file = str(scene_file)
    bpy.ops.firetwin.build()
    assert {"Cube", "Light", "Camera", "Firetwin Terrain"} <= {o.name for o in bpy.context.scene.objects}


def test_views_reach_as_far_as_the_world(settings, scene_file, monkeypatch):
    space = SimpleNamespace(clip_start=0.1, clip_end=1000.0, region_3d=SimpleNamespace())
    monkeypatch.setattr(view, "spaces", lambda: [space])
    settings.scene_file = str(scene_file)
    bpy.ops.firetwin.build()
    assert space.clip_end > 200_000
    assert space.region_3d.view_perspective == "CAMERA"
    bpy.ops.firetwin.view(whole=True)
    assert space.region_3d.view_perspective == "PERSP"
    assert space.region_3d.view_distance > settings.extent


def test_model_time_and_frame_are_one(settings, scene_file):
    settings.scene_file = str(scene_file)
    bpy.ops.firetwin.build()
    scene = bpy.context.scene
    settings.model_time = 0.5
    assert scene.frame_current == 2
    assert clock.moment(settings).strftime("%H:%M %Z") == "21:30 UTC"
    scene.frame_set(3)
    assert settings.model_time == 1.0
    scene.frame_set(50)
    assert settings.model_time == 1.0


def test_render_makes_what_the_command_line_makes(settings, scene_file, tmp_path):
    settings.scene_file, settings.output = str(scene_file), str(tmp_path / "out")
    settings.which, settings.frame_list = "list", "2"
    assert bpy.ops.firetwin.render() == {"FINISHED"}
    files = sorted(path.name for path in (tmp_path / "out").rglob("*") if path.is_file())
    assert [name for name in files if name.startswith("drone")] == [
        "drone_rgb_000002.exr",
        "drone_rgb_000002.png",
    ]
    assert "manifest.json" in files
    settings.frame_list = "2,9"
    with pytest.raises(RuntimeError, match=r'Frames: "9" is outside of 1-3'):
        bpy.ops.firetwin.render()


def test_work_in_the_window_goes_step_by_step():
    taken = []

    def steps():
        got = yield job.Away("counting", lambda progress, stop: progress(2, 4, "apples") or 7)
        taken.append(got)
        yield "drawing"
        taken.append("drawn")
        return "all done"

    work = job.Job("Test", steps())
    assert not work.advance()
    assert work.what == "Test"  # shown before anything is done
    while not work.advance():
        time.sleep(0.01)
    assert taken == [7, "drawn"]
    assert work.told == "all done"


def test_the_progress_of_work_says_how_far_it_is():
    work = job.Job("Test", iter(()))
    work.progress(3, 12, "smoke")
    assert work.text.startswith("Smoke 3 of 12, ")
    assert work.text.endswith(" left")
    assert work.factor == 0.25
    work.progress(12, 12, "smoke")
    assert work.text == "Smoke 12 of 12"


def test_errors_of_a_thread_arrive_where_the_work_is():
    def fail(progress, stop):
        raise firetwin.errors.input_error("a.txt", 3, 4, "is wrong; write it otherwise")

    def steps():
        yield job.Away("failing", fail)

    with pytest.raises(firetwin.errors.InputError) as failed:
        job.Job("Test", steps()).run()
    assert job.words(failed.value) == "a.txt:3:4: is wrong; write it otherwise"


def test_a_render_is_stopped_in_the_middle_and_leaves_nothing(settings, scene_file, tmp_path):
    settings.scene_file, settings.output = str(scene_file), str(tmp_path / "out")
    settings.which = "all"
    operator = SimpleNamespace()
    work = job.Job("Render", render.FIRETWIN_OT_render.steps(operator, bpy.context))
    while work.what != "building the scene":  # the worker is at work
        assert not work.advance()
        time.sleep(0.02)
    work.stop.now()
    with pytest.raises(firetwin.worker.StoppedError):
        work.run()
    assert not list(tmp_path.rglob(".part-*"))
    assert not list(tmp_path.rglob("*.png"))


def test_unregister_ends_what_goes_on(settings):
    work = job.Job.current = job.Job("Render", iter(()))
    firetwin.unregister()
    assert work.stop.asked
    assert job.Job.current is None
