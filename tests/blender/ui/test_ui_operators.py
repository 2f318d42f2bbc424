"""All operators: their texts, no traceback on failure, and undo."""

import copy
import shutil
import webbrowser

import bpy
import comp_film
import exercise_stations
import firetwin
import numpy as np
import panel_scene
import pytest
from bl_operators.presets import AddPresetBase
from bpy_extras.io_utils import ExportHelper, ImportHelper
from firetwin.allocation import job as allocation_job
from firetwin.export import job as export_job
from firetwin.farm import submission
from firetwin.jobs import assets, convert, render, render_blend, sample
from firetwin.jobs.tiles import bounding_boxes
from firetwin.story.film import Film
from firetwin.ui import navigation, quality, smoke_volumes, stations_panel, working
from mathutils import Euler, Matrix
from panel_scene import state

EYE = Matrix.Translation((-500.0, -2500.0, 2400.0)) @ Euler((1.2, 0.0, -0.2)).to_matrix().to_4x4()
OPERATORS = {
    cls.bl_idname.partition(".")[2]: cls for cls in firetwin.ui.classes if issubclass(cls, bpy.types.Operator)
}
ALWAYS = {"copy"}  # operators without needs can be called at any time
HELPERS = ImportHelper, ExportHelper, AddPresetBase, working.Working, object


@pytest.fixture(scope="module")
def blend(panel_blend, run_folder, tmp_path_factory):
    """A scene that the panel built, as a file, next to a copy of its run."""
    folder = tmp_path_factory.mktemp("operators")
    shutil.copytree(run_folder, folder / "other")
    return panel_scene.copied(panel_blend, folder)


@pytest.fixture
def panel(blend, plain_looks, monkeypatch):
    """A built scene of the panel, and a view that looks from EYE."""
    monkeypatch.setattr(navigation, "camera_from_view", lambda context: (EYE.copy(), 30.0, 36.0))
    yield from panel_scene.opened(blend)


def test_operators_say_what_they_do_and_when_they_can_be_used():
    for name, cls in OPERATORS.items():
        own = [each for each in cls.__mro__ if each not in HELPERS and not each.__module__.startswith("bpy")]
        text = getattr(cls, "bl_description", "") or cls.__doc__
        assert len(text.split()) >= 3, name
        assert not text.rstrip().endswith("."), name  # Blender adds it
        assert any("poll" in vars(each) for each in own) or name in ALWAYS, name


class Broken:
    """A context of which nothing can be had."""

    def __getattr__(self, name):
        raise ValueError(f"no {name}")


class Reports(list):
    """In place of an operator: keeps its reports."""

    def report(self, level, text):
        self.append((*level, text))

    def __getattr__(self, name):
        raise ValueError(f"no {name}")


def test_what_nobody_foresaw_is_a_report():
    for name, cls in OPERATORS.items():
        execute = vars(cls).get("execute")
        if execute is None:  # of Blender, or an operator that only listens, or a work
            assert issubclass(cls, working.Working | AddPresetBase) or "modal" in vars(cls), name
            continue
        if name == "stop":  # asks nothing of the context
            continue
        reports = Reports()
        assert execute(reports, Broken()) == {"CANCELLED"}, name
        ((level, text),) = reports
        assert level == "ERROR"
        assert text.startswith("Unexpected "), name


CHANGES = {
    "inspect": {},
    "open": {"filepath": "{folder}/other/run.toml"},
    "sample": {"folder": "{folder}/king"},
    "convert": {"filepath": "{folder}/other"},
    "quality": {"level": "final"},
    "window": {"key": "start", "moment": "2014-09-17T21:10:00Z"},
    "reset": {"section": "time", "key": "frames"},
    "build": {"part": "light"},
    "solve": {},
    "live": {},
    "show_live": {},
    "remove": {},
    "camera_add": {"kind": "poses"},
    "camera_copy": {},
    "camera_remove": {},
    "camera_key": {},
    "camera_lens": {"preset": "thermal_hand"},
    "output_preset": {"preset": "editorial"},
    "camera_aim": {"target": "point"},
    "camera_path": {},
    "f12_files": {},
    "regrade": {"filepath": "{folder}/drone_comp_000001.exr"},
    "allocate": {},  # before a run is added whose folder does not exist
    "run_add": {},
    "run_remove": {},
    "vr_landmarks": {},
    "station_map": {},
    "tiles_preview": {"boxes": True},
    "tiles_clear": {},
}
KEEPS = {
    "copy": {"message": "this"},
    "export": {"filepath": "{folder}/out.toml"},
    "preset": {"name": "Mine"},
    "view": {"whole": True},
    "jump": {"moment": "2014-09-17T21:30:00Z"},
    "smoke_volumes": {"which": "range"},
    "go": {"text": "38.84 -120.55"},
    "export_to": {"to": "czml"},
    "render": {},
    "render_background": {},
    "queue": {"what": "pause"},
    "assets": {},
    "farm_write": {},
    "farm_submit": {},
    "farm_status": {},
    "farm_resume": {},
    "farm_cancel": {},
    "story_make": {},
    "story_move": {"by": 1},
    "story_edit": {"seconds": 2.0},
    "story_render": {},
    "help": {"page": "farm"},
    "vr_start_at": {"name": "Ignition"},
    "viewport_measure": {},
}
BOX = {"name": "set", "tiles": 1, "credits": [], "corners": np.arange(24.0).tolist()}
ALLOCATION = {"divisions": [], "reasons": [], "left_out": [], "map": {"features": []}}
LISTENS = {"queue_esc", "station_pick", "stop", "fly"}  # for Esc or a click, and while something goes on
OPENS = {"story_open"}  # another file
IN_VR = {"vr_session", "vr_play", "vr_time", "vr_landmark", "vr_turn", "vr_teleport"}  # need a headset


def call(name, options, folder):
    filled = {
        key: value.format(folder=folder) if isinstance(value, str) else value
        for key, value in options.items()
    }
    return getattr(bpy.ops.firetwin, name)("EXEC_DEFAULT", True, **filled)


@pytest.mark.posix("manual in its wheel; the zip has one")
@pytest.mark.slow  # every operator, undone and redone
def test_undo_and_redo_go_round_every_operator(vr_viewer, panel, blend, tmp_path, monkeypatch):
    """Undo reverts the changes of an operator, and redo restores them; other operators change nothing."""
    assert {*CHANGES, *KEEPS, *LISTENS, *OPENS, *IN_VR} == set(OPERATORS)
    monkeypatch.setattr(convert, "default_output", lambda paths, *_, **__: (paths[0], True))
    monkeypatch.setattr(sample, "run", lambda folder, **_: shutil.copytree(blend.parent / "other", folder))
    monkeypatch.setattr(render, "run", lambda *_, **__: render.RenderResult(1))
    monkeypatch.setattr(assets, "run", lambda *_, **__: 1)
    monkeypatch.setattr(export_job, "run", lambda *_, **__: [])
    monkeypatch.setattr(webbrowser, "open", lambda url: True)
    monkeypatch.setattr(allocation_job, "suggest", lambda *_, **__: copy.deepcopy(ALLOCATION))
    monkeypatch.setattr(bounding_boxes, "run", lambda *_, **__: [BOX])
    monkeypatch.setattr(render_blend, "run", lambda *_, **__: 1)
    monkeypatch.setattr(submission, "run_command", lambda *_, **__: None)
    monkeypatch.setattr(submission, "cancel_command", lambda out: [])
    monkeypatch.setattr(Film, "make", lambda *_: [])
    monkeypatch.setattr(smoke_volumes, "_state", lambda scene: smoke_volumes._State(3, {1}))
    monkeypatch.setattr(bpy.utils, "user_resource", lambda *_, path="", **__: str(tmp_path / path))
    (tmp_path / "presets" / "firetwin").mkdir(parents=True)
    monkeypatch.setattr(quality.FIRETWIN_MT_presets, "bl_label", "Presets")  # becomes the preset's name
    comp_film.write(blend.parent)
    bpy.ops.ed.undo_push(message="opened")
    bpy.context.scene.firetwin.light.haze = 0.7
    for name, options in CHANGES.items():
        if name == "run_remove":
            bpy.context.scene.firetwin.runs.add().name = "other"
        if name == "solve":
            bpy.context.scene.firetwin.smoke.method = "preview"
        if name == "show_live":
            bpy.ops.firetwin.live()
        if name in ("station_map", "allocate"):
            bpy.context.scene.firetwin.stations.file = str(
                exercise_stations.write(tmp_path / "stations.gpkg")
            )
            stations_panel.sync()
        if name.startswith("tiles"):
            bpy.context.scene.firetwin.tiles.sources = '"set"'
        if name == "tiles_clear":
            bpy.ops.firetwin.tiles_preview(boxes=True)
        bpy.ops.ed.undo_push(message=f"before {name}")
        before = state()
        assert call(name, options, blend.parent) == {"FINISHED"}, name
        after = state()
        assert after != before or name in ("inspect", "show_live"), name
        bpy.ops.ed.undo()
        assert state() == before, name
        bpy.ops.ed.redo()
        assert state() == after, name
        bpy.ops.ed.undo()
    bpy.context.scene.firetwin.runs.clear()
    bpy.context.scene.firetwin.stations.file = ""
    bpy.context.scene.firetwin.tiles.sources = ""
    bpy.ops.firetwin.tiles_clear()
    bpy.ops.ed.undo_push(message="the rest")
    before = state()
    for name, options in KEEPS.items():
        assert call(name, options, tmp_path) == {"FINISHED"}, name
        bpy.context.scene.frame_set(1)
        assert state() == before, name
