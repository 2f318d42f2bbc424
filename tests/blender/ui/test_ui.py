"""The panel: rejected input and its reasons, operators, stopped work, and its remains."""

import os
import shutil
import time
from dataclasses import replace
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import firetwin
import numpy as np
import pytest
import views
from firetwin import auto_framing
from firetwin.blender import owned, viewport
from firetwin.errors import InputError, input_error
from firetwin.jobs import assets
from firetwin.shot import passes
from firetwin.shot.schema import fields
from firetwin.shot.settings import scene_file as file
from firetwin.smoke import sources
from firetwin.ui import auto_framing as framing
from firetwin.ui import (
    build,
    camera_list,
    job,
    keys,
    maps,
    preferences,
    render,
    run,
    sections,
    solve,
    view,
    working,
)
from firetwin.ui import scene_file as scene_settings
from firetwin.ui import time as model_time


@pytest.fixture
def settings(plain_looks, panel):
    """The panel of a new file, as Blender starts with."""
    return panel


def inventory():
    """Traces that an add-on can leave in Blender."""
    handlers = [
        (kind, function)
        for kind in dir(bpy.app.handlers)
        if isinstance(functions := getattr(bpy.app.handlers, kind), list)
        for function in functions
    ]
    kinds = bpy.types, bpy.types.Scene, bpy.types.WindowManager, bpy.types.Object, bpy.ops.firetwin
    config = bpy.context.window_manager.keyconfigs.addon
    keys = [(name, len(keymap.keymap_items)) for name, keymap in config.keymaps.items()]
    menus = (bpy.types.VIEW3D_MT_editor_menus, bpy.types.TOPBAR_MT_help, bpy.types.VIEW3D_MT_add)
    drawn = [len(getattr(menu.draw, "_draw_funcs", "1")) for menu in menus]
    libraries = bpy.context.preferences.filepaths.asset_libraries.keys()
    known = len(list(bpy.utils.manual_map())), libraries, sum(count for _, count in keys), drawn
    return handlers, [set(dir(kind)) for kind in kinds], known


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
    """Return the reason why an operator cannot be called."""
    assert not operator.poll()
    with pytest.raises(RuntimeError) as refused:
        operator()
    return str(refused.value)


def test_every_refusal_says_what_to_do(settings, run_folder, scene_file):
    assert "Open a run" in refusal(bpy.ops.firetwin.build)
    assert "Open a run" in refusal(bpy.ops.firetwin.inspect)
    assert "Build the scene first" in refusal(bpy.ops.firetwin.view)
    assert "Build the scene first" in refusal(bpy.ops.firetwin.jump)
    assert "Select a camera" in refusal(bpy.ops.firetwin.camera_remove)
    assert "No task is running" in refusal(bpy.ops.firetwin.stop)
    settings.run = str(run_folder)
    assert bpy.ops.firetwin.build.poll()  # the smoke is in a folder of Firetwin until the .blend is saved
    assert "Save the .blend file" in refusal(bpy.ops.firetwin.render)
    assert "has built nothing" in refusal(bpy.ops.firetwin.remove)
    settings.output = str(run_folder.parent / "out")
    assert bpy.ops.firetwin.render.poll()
    job.Job.current = job.Job("Build scene", iter(()))
    try:
        assert "Build scene is not finished" in refusal(bpy.ops.firetwin.render)
        assert bpy.ops.firetwin.stop.poll()
    finally:
        job.Job.current = None


def test_a_run_is_known_as_soon_as_it_is_chosen(settings, run_folder):
    settings.run = str(run_folder)
    facts = run.parse_facts(settings.facts)
    rows = dict(facts["rows"])
    assert rows["Grid"].startswith("24 x 24 cells of 3")
    assert rows["First"] == "17 Sep 2014 13:00 -08"  # by its longitude: nobody said which fire it is
    assert rows["Burned"].endswith("acres")
    assert settings.cameras.keys() == ["overview", "chase", "flank", "satellite"]
    assert [words for _, words in facts["moments"]] == ["the run begins", "the run ends"]
    kept = maps._kept[settings.run]  # without a window they have no icons
    assert kept["fuel"].image_size[:] == kept["intensity"].image_size[:] == (192, 192)
    assert [item[0] for item in render.camera_items(settings, None)] == [
        "*",
        "overview",
        "chase",
        "flank",
        "satellite",
    ]


def test_a_scene_file_fills_the_panel(settings, scene_file, run_folder):
    settings.run = "elsewhere"
    settings.scene_file = str(scene_file)
    assert settings.run == str(run_folder)
    assert settings.cameras.keys() == ["drone"]
    assert settings.render.resolution[:] == (64, 36)
    assert not settings.problem
    assert scene_settings.shot_source(settings).settings().cameras == file.read(scene_file).cameras
    settings.run = "elsewhere"
    assert settings.problem
    assert settings.cameras.keys() == ["drone"]


def test_cameras_that_nobody_chose_follow_the_run(settings, run_folder, tmp_path):
    settings.run = str(run_folder)
    assert settings.cameras.keys() == ["overview", "chase", "flank", "satellite"]
    shutil.copytree(run_folder, tmp_path / "other")
    latitude = np.load(tmp_path / "other" / "latitude.npy")
    np.save(tmp_path / "other" / "latitude.npy", latitude + 1.0)
    fine = np.load(tmp_path / "other" / "fuel_latitude.npy")
    np.save(tmp_path / "other" / "fuel_latitude.npy", fine + 1.0)
    before = camera_list.get(settings.cameras[0])
    settings.run = str(tmp_path / "other")
    after = camera_list.get(settings.cameras[0])
    # Another sun and other smoke may choose another of the places around the fire.
    assert after.rig.keys[0].latitude == pytest.approx(before.rig.keys[0].latitude + 1.0, abs=0.1)
    settings.cameras[0].name = "mine"
    settings.run = str(run_folder)
    assert camera_list.get(settings.cameras[0]).rig == after.rig
    assert "km from the middle of the run" in settings.problem or not settings.problem


def test_the_window_that_nobody_chose_follows_the_run(settings, run_folder, tmp_path):
    framing._frame_folder.cache_clear()  # of a shared scene, which was framed with all candidates
    settings.run = str(run_folder)
    fits = file.read(_new(run_folder, tmp_path / "scene.toml"))
    shown = scene_settings.read_settings(bpy.context.scene)
    assert (shown.time, shown.cameras) == (fits.time, fits.cameras)
    settings.time.frames, settings.time.start = 7, "2014-09-17 21:10"
    bpy.ops.firetwin.inspect()
    assert (settings.time.frames, settings.time.start) == (7, "2014-09-17 21:10")
    assert settings.time.fps == fits.time.fps


def test_cameras_that_nobody_chose_are_placed_for_the_window_that_somebody_chose(
    settings, run_folder, monkeypatch
):
    settings.run = str(run_folder)
    before = camera_list.cameras(settings)
    settings.time.start, settings.time.end = "2014-09-17 21:40", "2014-09-17 21:58"
    bpy.ops.firetwin.inspect()
    placed = camera_list.cameras(settings)
    assert [each.name for each in placed] == [each.name for each in before]
    assert placed != before
    assert settings.time.start == "2014-09-17 21:40"
    bpy.ops.firetwin.inspect()
    assert camera_list.cameras(settings) == placed
    settings.time.start = "2014-09-17 21:00"
    settings.cameras[0].name = "mine"
    chosen = camera_list.cameras(settings)
    bpy.ops.firetwin.inspect()
    assert camera_list.cameras(settings) == chosen


def _new(folder, path):
    """The scene file that the command line would write."""
    path.write_text(auto_framing.fit_folder(folder, path, path.parent / "cache").text)
    return path


def test_solved_smoke_is_a_button_that_names_its_cost(settings, run_folder, monkeypatch):
    """The panel of a preview shows the cost of a flow before it is solved."""
    settings.run = str(run_folder)
    assert settings.smoke.method == "preview"
    assert "about " in settings.smoke_cost
    asked = sources.select(replace(scene_settings.shot_source(settings), smoke="flow").shot()).cost()
    assert settings.smoke_cost == asked.brief()
    layout = MagicMock()
    solve.draw(layout, settings)
    assert layout.operator.call_args.kwargs["text"] == f"Solve smoke ({settings.smoke_cost})"
    built = []

    def steps(context, part):
        built.append(part)
        yield "building"
        return ""

    monkeypatch.setattr(build, "steps", steps)
    assert bpy.ops.firetwin.solve() == {"FINISHED"}
    assert (settings.smoke.method, settings.bake_smoke, built) == ("flow", True, ["all"])
    assert scene_settings.shot_source(settings).shot().settings.smoke.method == "flow"
    layout = MagicMock()
    solve.draw(layout, settings)
    assert not layout.operator.called
    assert "already solved" in refusal(bpy.ops.firetwin.solve)


def test_properties_say_what_the_schema_says(settings):
    for section in sections.sections():
        shown = getattr(settings, section.name).bl_rna.properties
        for part in fields(section.table):
            prop = shown[part.name]
            assert prop.description == keys.sentence(part.key.described())
            if part.key.choices is not None:
                assert [item.identifier for item in prop.enum_items] == list(part.key.names())
                for item in prop.enum_items:
                    assert item.description == keys.sentence(part.key.names()[item.identifier])
    own = preferences.FIRETWIN_AP_preferences.bl_rna.properties
    assert [item.identifier for item in own["device"].enum_items] == ["scene", "auto", "cpu", "gpu"]
    shown = settings.render.bl_rna.properties["passes"].enum_items
    assert {"RGB", "Depth", "Thermal"} <= {item.name for item in shown}


def test_the_preferences_say_what_renders_on(settings, monkeypatch):
    assert preferences.device() == ""
    chosen = SimpleNamespace(
        preferences=SimpleNamespace(device="gpu", cache="", cache_limit=0.0, area_unit="acres", library="")
    )
    known = SimpleNamespace(preferences=SimpleNamespace(addons={"firetwin": chosen}))
    settings.run = "somewhere"
    monkeypatch.setattr(preferences, "bpy", SimpleNamespace(context=known))
    assert scene_settings.shot_source(settings).device == "gpu"
    chosen.preferences.device = "scene"
    assert scene_settings.shot_source(settings).device == ""


def test_the_preferences_say_where_smoke_is_cached_and_how_much(settings, tmp_path, monkeypatch):
    kept = SimpleNamespace(
        device="scene", cache=str(tmp_path), cache_limit=1.0e-6, area_unit="ha", library=""
    )
    addons = {"firetwin": SimpleNamespace(preferences=kept)}
    known = SimpleNamespace(preferences=SimpleNamespace(addons=addons))
    settings.run = "somewhere"
    monkeypatch.setattr(preferences, "bpy", SimpleNamespace(context=known))
    assert scene_settings.read_settings(bpy.context.scene).cache == tmp_path
    settings.cache = str(tmp_path / "own")
    assert scene_settings.read_settings(bpy.context.scene).cache == tmp_path / "own"
    for number, name in enumerate(("0" * 16, "1" * 16)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "smoke_000001.vdb").write_bytes(bytes(800))
        os.utime(tmp_path / name, (1.0e9 + number,) * 2)
    build._limit_cache()  # 1000 bytes
    assert [path.name for path in tmp_path.iterdir()] == ["1" * 16]
    kept.cache_limit = 0.0
    assert preferences.cache_limit() is None


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
    assert owned.is_ours(bpy.context.scene)
    assert len(bpy.data.scenes) == 1
    assert {"Firetwin Ground", "Firetwin Camera drone", "Firetwin Sun"} <= names
    assert bpy.context.scene.world.name == "Firetwin Sky"
    rendered = {name for name, each in passes.known().items() if isinstance(each, passes.RenderedPass)}
    assert rendered == {layer.name for layer in bpy.context.scene.view_layers}
    assert not {"Cube", "Light", "Camera"} & names
    assert settings.frames == 3
    assert settings.extent == pytest.approx(24 * 370, rel=0.05)


@pytest.mark.parametrize("somebody", ["moved the cube", "coloured the world", "animated the scene"])
def test_build_leaves_a_scene_that_somebody_uses_and_remove_takes_our_own(settings, scene_file, somebody):
    before = bpy.context.scene
    if somebody == "moved the cube":
        bpy.data.objects["Cube"].location.x = 1.0
        bpy.context.view_layer.update()
    elif somebody == "coloured the world":
        before.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1.0, 0.0, 0.0, 1.0)
    else:
        before.keyframe_insert("gravity")
    settings.scene_file, settings.which = str(scene_file), "all"
    bpy.ops.firetwin.build()
    assert {thing.name for thing in before.objects} == {"Cube", "Light", "Camera"}
    assert before.world.name == "World"
    after = bpy.context.window.scene
    assert after.name == "Firetwin"
    assert owned.is_ours(after)
    assert not owned.has_data(before)
    assert "Firetwin Ground" in after.objects
    assert (after.firetwin.scene_file, after.firetwin.which) == (str(scene_file), "all")
    assert scene_settings.read_settings(after) == scene_settings.read_settings(before)
    assert after.firetwin.frames == 3
    assert before.firetwin.frames == 0
    assert "Scene is unchanged" in working.last_messages(build.FIRETWIN_OT_build)[-1].text
    added = somebody == "animated the scene"
    if added:
        after.collection.objects.link(bpy.data.objects.new("Mine", None))
    bpy.ops.firetwin.remove()
    assert bpy.data.scenes.keys() == (["Firetwin", "Scene"] if added else ["Scene"])
    if added:
        assert after.objects.keys() == ["Mine"]
        assert not owned.has_data(after)


def test_the_asset_library_is_written_beside_the_pictures(settings, scene_file, tmp_path, monkeypatch):
    written = []
    monkeypatch.setattr(assets, "run", lambda choice, out, **_: written.append(out) or 3)
    settings.scene_file = str(scene_file)
    with pytest.raises(RuntimeError, match="choose an output folder"):
        bpy.ops.firetwin.assets()
    settings.output = str(tmp_path / "out")
    assert bpy.ops.firetwin.assets() == {"FINISHED"}
    assert bpy.ops.firetwin.assets(directory=str(tmp_path / "mine")) == {"FINISHED"}
    assert written == [tmp_path / "out" / "assets", tmp_path / "mine"]


def left_out(scene):
    """Our collections that depth does not see."""
    children = scene.view_layers["depth"].layer_collection.children["Firetwin"].children
    return {child.name for child in children if child.exclude}


def test_parts_one_by_one_make_the_whole(settings, scene_file):
    settings.scene_file = str(scene_file)
    for part in build.PARTS:
        bpy.ops.firetwin.build(part=part)
    scene = bpy.context.scene
    one_by_one, without = sorted(scene.objects.keys()), left_out(scene)
    bpy.ops.firetwin.build()
    assert sorted(scene.objects.keys()) == one_by_one
    assert left_out(scene) == without
    assert "Firetwin Fire" in without
    assert "Firetwin Terrain" not in without


def test_remove_takes_away_all_of_ours(settings, scene_file):
    settings.scene_file = str(scene_file)
    bpy.ops.firetwin.build()
    assert bpy.ops.firetwin.remove() == {"FINISHED"}
    scene = bpy.context.scene
    assert not scene.objects
    assert not owned.has_data(scene)
    assert len(scene.view_layers) == 1
    assert settings.first_time == ""
    assert "Build the scene first" in refusal(bpy.ops.firetwin.view)
    assert not [block.name for block in owned._blocks() if owned.is_ours(block)]
    bpy.ops.firetwin.build()
    assert "Firetwin Ground" in scene.objects


def space(start=0.01, end=1000.0):
    shading = SimpleNamespace(color_type="MATERIAL")
    return SimpleNamespace(clip_start=start, clip_end=end, region_3d=SimpleNamespace(), shading=shading)


def test_views_reach_as_far_as_the_world(settings, scene_file, monkeypatch):
    usual, own = space(), space(0.5, 2000.0)
    monkeypatch.setattr(view, "scene_views", lambda scene: [usual, own])
    settings.scene_file = str(scene_file)
    bpy.ops.firetwin.build()
    assert usual.clip_end > 200_000
    assert (own.clip_start, own.clip_end) == (0.5, 2000.0)
    assert usual.region_3d.view_perspective == "CAMERA"
    bpy.ops.firetwin.view(whole=True)
    assert usual.region_3d.view_perspective == "PERSP"
    assert usual.region_3d.view_distance > settings.extent
    bpy.ops.firetwin.build(part="light")
    assert usual.region_3d.view_perspective == "PERSP"
    bpy.ops.firetwin.remove()
    assert (usual.clip_start, usual.clip_end) == pytest.approx((0.01, 1000.0))
    assert (own.clip_start, own.clip_end) == (0.5, 2000.0)


def test_only_views_of_windows_that_show_the_scene_are_ours_to_set(monkeypatch):
    shown, other = bpy.context.scene, bpy.data.scenes.new("Other")
    here, elsewhere = (
        SimpleNamespace(type="VIEW_3D", spaces=SimpleNamespace(active=space())) for _ in range(2)
    )
    windows = [
        SimpleNamespace(scene=shown, screen=SimpleNamespace(areas=[here, SimpleNamespace(type="INFO")])),
        SimpleNamespace(scene=other, screen=SimpleNamespace(areas=[elsewhere])),
    ]
    manager = SimpleNamespace(window_manager=SimpleNamespace(windows=windows))
    monkeypatch.setattr(view, "bpy", SimpleNamespace(context=manager, types=bpy.types))
    view.extend_clipping(shown)
    assert here.spaces.active.clip_end == viewport.FAR
    assert elsewhere.spaces.active.clip_end == 1000.0


def test_model_time_and_frame_are_one(settings, scene_file):
    settings.scene_file = str(scene_file)
    bpy.ops.firetwin.build()
    scene = bpy.context.scene
    settings.model_time = 0.5
    assert scene.frame_current == 2
    assert model_time.shown_time(settings).strftime("%H:%M %Z") == "21:30 UTC"
    scene.frame_set(3)
    assert settings.model_time == 1.0
    scene.frame_set(50)
    assert settings.model_time == 1.0


def test_work_in_the_window_goes_step_by_step():
    taken = []

    def steps():
        got = yield job.InThread(
            "counting", lambda progress, tell, stop: progress(2, 4, "apples") or tell("it counts") or 7
        )
        taken.append(got)
        yield job.Message("it draws", "WARNING")
        yield "drawing"
        taken.append("drawn")
        return "all done"

    work = job.Job("Test", steps())
    assert not work.advance()
    assert work.what == "Test"  # shown before anything is done
    while not work.advance():
        time.sleep(0.01)
    assert taken == [7, "drawn"]
    assert work.result == "all done"
    assert work.messages == [job.Message("it counts"), job.Message("it draws", "WARNING")]


def test_the_progress_of_work_says_how_far_it_is():
    work = job.Job("Test", iter(()))
    work.progress(3, 12, "smoke", "last: out/a.png")
    assert work.text.startswith("Smoke 3 of 12, ")
    assert work.text.endswith(" left")
    assert work.factor == 0.25
    work.progress(12, 12, "smoke")
    assert work.text == "Smoke 12 of 12"


def test_errors_of_a_thread_arrive_where_the_work_is():
    def fail(progress, tell, stop):
        raise input_error("a.txt", "is wrong; write it otherwise", line=3, column=4)

    def steps():
        yield job.InThread("failing", fail)

    with pytest.raises(InputError) as failed:
        job.Job("Test", steps()).run()
    assert job.describe_error(failed.value) == "a.txt:3:4: is wrong; write it otherwise"


class Window:
    """A window whose only 3D view has its sidebar at 800 to 1000 across and 100 to 700 up."""

    def __init__(self):
        sidebar = SimpleNamespace(type="UI", x=800, y=100, width=200, height=600)
        picture = SimpleNamespace(type="WINDOW", x=0, y=100, width=1000, height=600)
        area = SimpleNamespace(type="VIEW_3D", regions=[picture, sidebar])
        self.screen = SimpleNamespace(areas=[area, SimpleNamespace(type="OUTLINER", regions=[sidebar])])
        manager = SimpleNamespace(
            event_timer_add=lambda *_, **__: "timer",
            event_timer_remove=lambda timer: None,
            modal_handler_add=lambda operator: None,
        )
        self.context = SimpleNamespace(
            window=self, window_manager=manager, workspace=None, scene=bpy.context.scene
        )


def event(kind="TIMER", x=100, y=300, value="PRESS"):
    return SimpleNamespace(type=kind, value=value, mouse_x=x, mouse_y=y)


class Operator(working.Working):
    """Work in the window, without one."""

    bl_label = "Test"

    def __init__(self, steps):
        self.steps, self.reports = lambda context: steps, []
        self.window = Window()
        assert self.begin(self.window.context) == {"RUNNING_MODAL"}

    def report(self, level, text):
        self.reports.append((*level, text))

    def happens(self, *arguments, **options):
        return self.modal(self.window.context, event(*arguments, **options))

    def goes_on(self):
        """Timer after timer until the work is over, or a step in Blender is about to be taken."""
        for _ in range(500):
            if (done := self.happens()) != {"PASS_THROUGH"}:
                return done
            time.sleep(0.01)
        raise TimeoutError


def wait(progress, tell, stop):
    while not stop.asked:
        time.sleep(0.01)


@pytest.fixture
def waiting():
    def steps():
        yield job.InThread("waiting", wait)
        return "done"

    work = Operator(steps())
    for _ in range(3):
        work.happens()
    yield work
    work.job.stop.now()
    working.cancel_task()


def test_esc_stops_work_only_with_the_pointer_over_the_sidebar(waiting):
    assert waiting.happens("ESC") == {"PASS_THROUGH"}
    assert waiting.happens("ESC", x=799) == {"PASS_THROUGH"}
    assert waiting.happens("ESC", x=900, y=50) == {"PASS_THROUGH"}
    assert waiting.happens("ESC", x=900, value="RELEASE") == {"PASS_THROUGH"}
    assert not waiting.job.stop.asked
    assert waiting.happens("ESC", x=900) == {"RUNNING_MODAL"}
    assert waiting.job.stop.asked
    assert waiting.goes_on() == {"CANCELLED"}
    assert waiting.reports == [("WARNING", "Test: stopped; finished work remains")]
    assert job.Job.current is None


def test_while_it_waits_the_window_can_be_used(waiting):
    assert waiting.happens("LEFTMOUSE") == waiting.happens("A") == {"PASS_THROUGH"}


def test_while_steps_are_taken_only_the_sidebar_and_the_view_can_be_used():
    def steps():
        yield "one"
        yield "two"
        return "done"

    work = Operator(steps())
    for _ in range(3):
        work.happens()
    assert work.job.touched
    assert work.happens("LEFTMOUSE", x=900) == {"PASS_THROUGH"}  # Stop is there
    assert work.happens("ESC") == work.happens("MIDDLEMOUSE") == {"PASS_THROUGH"}
    assert work.happens("LEFTMOUSE") == work.happens("Z", x=900) == {"RUNNING_MODAL"}
    work.job.stop.now()
    assert work.goes_on() == {"FINISHED"}
    assert work.reports == [("WARNING", "Test: stopped; undo restores the scene")]


def test_what_is_told_is_reported_and_stays_in_the_panel():
    def steps():
        yield job.InThread("counting", lambda progress, tell, stop: tell("it counts"))
        yield job.InThread("looking", lambda progress, tell, stop: tell("it is dark"))
        yield job.Message("it is dark", "WARNING")  # told once, as loudly as it was at last
        return "done"

    work = Operator(steps())
    assert work.goes_on() == {"FINISHED"}
    assert work.reports == [("INFO", "it counts"), ("WARNING", "it is dark"), ("INFO", "done")]
    assert [each.text for each in working.last_messages(Operator)] == ["it counts", "it is dark", "done"]


def test_undo_in_the_middle_of_building_ends_it_with_one_report():
    bpy.ops.ed.undo_push(message="before")

    def steps():
        yield "one"
        bpy.data.objects.new("Half", None)
        yield "two"
        raise AssertionError("never comes here")

    work = Operator(steps())
    for _ in range(5):
        work.happens()
    assert work.job.what == "two"
    bpy.ops.ed.undo_push(message="other")
    bpy.ops.ed.undo()
    assert work.goes_on() == {"FINISHED"}
    assert [level for level, _ in work.reports] == ["ERROR"]
    assert "undo was used" in work.reports[0][1]
    assert working._note_undo not in bpy.app.handlers.undo_post


def test_undo_while_it_waits_does_no_harm(waiting):
    bpy.ops.ed.undo_push(message="one")
    bpy.ops.ed.undo_push(message="two")
    bpy.ops.ed.undo()
    assert not waiting.job.undone


def test_another_file_ends_work_with_one_message(waiting):
    waiting.cancel(waiting.window.context)
    bpy.ops.wm.read_homefile(use_empty=True)
    assert job.Job.current is None
    assert waiting.job.stop.asked
    assert [each.text for each in working.last_messages(Operator)] == [
        "Test stopped because another file was opened"
    ]


def real(settings, **options):
    """The steps of Build as the window takes them."""
    operator = SimpleNamespace(part="all", **options)
    return Operator(build.FIRETWIN_OT_build.steps(operator, bpy.context))


@pytest.mark.parametrize("when", ["reading the run", "planting the forest"])
def test_a_scene_deleted_during_a_build_ends_it_with_one_report(settings, scene_file, when):
    settings.scene_file = str(scene_file)
    work = real(settings)
    while work.job.what != when:
        work.happens()
        time.sleep(0.01)
    bpy.data.scenes.new("Other")
    bpy.data.scenes.remove(bpy.context.scene)
    assert work.goes_on() in ({"CANCELLED"}, {"FINISHED"})
    assert [level for level, _ in work.reports] == ["ERROR"]
    assert "the scene is gone" in work.reports[0][1]


def test_edit_mode_entered_during_the_wait_ends_it_before_anything_is_touched(settings, scene_file):
    settings.scene_file = str(scene_file)
    work = real(settings)
    while work.job.what != "removing the previous build":
        work.happens()
        time.sleep(0.01)
    bpy.ops.object.mode_set(mode="EDIT")
    work.goes_on()
    assert work.reports == [("ERROR", "leave the edit mode, then build again")]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert set(bpy.context.scene.objects.keys()) == {"Cube", "Light", "Camera"}


def test_a_build_in_the_window_outlives_renames_and_undo_before_it_begins(settings, scene_file):
    settings.scene_file = str(scene_file)
    bpy.ops.ed.undo_push(message="chosen")
    work = real(settings)
    bpy.context.scene.name = "Renamed"
    bpy.ops.ed.undo_push(message="renamed")
    bpy.ops.ed.undo()
    assert work.goes_on() == {"FINISHED"}
    assert work.reports[-1][0] == "INFO"
    assert "Firetwin Ground" in bpy.context.scene.objects


def drawn(kind, scene):
    """All texts that a panel or menu gives its layout; it must not fail."""
    layout = MagicMock()
    kind.draw(SimpleNamespace(layout=layout), views.context(scene))
    return str(layout.mock_calls)


def test_every_panel_can_be_drawn_at_any_time(settings, scene_file):
    kinds = [cls for cls in firetwin.ui.classes if issubclass(cls, bpy.types.Panel | bpy.types.Menu)]
    panels = [cls for cls in kinds if not hasattr(cls, "poll")]
    assert {"Terrain", "Forest", "Fire", "Smoke", "Light", "Sensors"} <= {cls.bl_label for cls in panels}
    for panel in panels:
        drawn(panel, bpy.context.scene)
    settings.scene_file = str(scene_file)
    bpy.ops.firetwin.build()
    assert "Built 3 frames of Test" in drawn(build.FIRETWIN_PT_build, bpy.context.scene)
    assert "1,800 s per frame" in drawn(model_time.FIRETWIN_PT_time, bpy.context.scene)
    for kind in kinds:
        drawn(kind, bpy.context.scene)
    job.Job.current = job.Job("Build scene", iter(()))
    try:
        assert "Press Stop, or Esc with the pointer" in drawn(build.FIRETWIN_PT_build, bpy.context.scene)
    finally:
        job.Job.current = None


def test_unregister_ends_what_goes_on(settings):
    work = job.Job.current = job.Job("Render", iter(()))
    firetwin.unregister()
    assert work.stop.asked
    assert job.Job.current is None
