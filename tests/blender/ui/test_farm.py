"""The panel On a farm: the same job as on the command line; submission, status and cancellation."""

import json
import os
import time
from types import SimpleNamespace

import bpy
import panel_scene
import pytest
from firetwin import cli
from firetwin.farm import panel as farm
from firetwin.farm import plan, submission
from firetwin.jobs.worker import StoppedError
from firetwin.ui import folder_watch, job, working

SHELL = pytest.mark.posix("shell, in which schedulers run tasks")


@pytest.fixture(scope="module")
def blend(panel_blend, tmp_path_factory):
    """A scene that the panel built, as a file."""
    return panel_scene.copied(panel_blend, tmp_path_factory.mktemp("farm"))


@pytest.fixture
def panel(blend, tmp_path):
    """A built scene of the panel, with a separate output folder for the farm."""
    for settings in panel_scene.opened(blend):
        settings.farm_output = str(tmp_path / "farm out")
        yield settings


@pytest.fixture
def slurm(tmp_path, monkeypatch):
    """Commands in place of Slurm's: each writes its arguments into a file, and prints a number."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in ("sbatch", "scancel", "scontrol"):
        path = folder / name
        path.write_text(f'#!/bin/bash\necho "{name} $*" >>{tmp_path}/calls\necho 71\n')
        path.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    return lambda: [line.split()[0] for line in (tmp_path / "calls").read_text().splitlines()]


def told(operator):
    """Messages of an operator's last task."""
    return [each.text for each in working.last_messages(operator)]


def made(panel):
    """The job as its file has it."""
    return json.loads((farm._output_folder(panel) / "farm/job.json").read_text())


@SHELL
def test_a_job_of_the_panel_is_that_of_the_command_line(panel, blend, tmp_path, capsys):
    panel.farm_chunk, panel.render.chunk = 2, 1
    assert bpy.ops.firetwin.farm_write() == {"FINISHED"}
    own = made(panel)
    assert os.path.dirname(own["scene"]) == str(blend.parent)
    cli.main(["farm", own["scene"], "--engine", "slurm", "--chunk", "2", "--out", str(tmp_path / "same")])
    assert (tmp_path / "same/farm/job.json").read_bytes() == (
        tmp_path / "farm out/farm/job.json"
    ).read_bytes()
    first = str(tmp_path / "exported.toml")
    bpy.ops.firetwin.export(filepath=first)
    cli.main(["farm", first, "--engine", "slurm", "--chunk", "2", "--out", str(tmp_path / "other")])
    other = json.loads((tmp_path / "other/farm/job.json").read_text())
    for found in (own, other):
        found["assets"].remove(found.pop("scene"))
        del found["scene_sha256"]
    assert own == other
    assert [each["frames"] for each in own["tasks"]] == ["1-2", "3"]
    words = capsys.readouterr()
    assert told(farm.FIRETWIN_OT_farm_write)[-1].endswith("/farm/slurm/submit.sh'")
    assert str(tmp_path / "same/farm/slurm/submit.sh") in words.out


def test_a_job_of_changed_settings_needs_another_folder_and_leaves_no_file(panel, blend):
    bpy.ops.firetwin.farm_write()
    before, panel.light.haze = sorted(blend.parent.iterdir()), 0.7
    with pytest.raises(RuntimeError, match="choose another output folder"):
        bpy.ops.firetwin.farm_write()
    assert sorted(blend.parent.iterdir()) == before
    panel.farm_output += " 2"
    assert bpy.ops.firetwin.farm_write() == {"FINISHED"}
    assert len(list(blend.parent.iterdir())) == len(before) + 1


def test_a_scene_file_of_others_is_not_the_jobs(panel, blend):
    panel.light.haze = 0.3
    bpy.ops.firetwin.farm_write()
    path = max(blend.parent.glob("scene_farm_*.toml"), key=lambda each: each.stat().st_mtime_ns)
    before = path.read_bytes()
    path.write_bytes(before + b"seed = 7\n")
    with pytest.raises(RuntimeError, match="has changed since Firetwin wrote it; choose another name"):
        bpy.ops.firetwin.farm_write()
    assert path.read_bytes() == before + b"seed = 7\n"


@SHELL
def test_what_is_submitted_is_followed_resumed_and_cancelled(panel, tmp_path, slurm):
    panel.farm_options, panel.render.chunk, panel.farm_chunk = "--partition=gpu --comment='two words'", 1, 1
    assert bpy.ops.firetwin.farm_submit() == {"FINISHED"}
    assert any(text.startswith("submitted Slurm jobs 71") for text in told(farm.FIRETWIN_OT_farm_submit))
    assert submission.last_submission(farm._output_folder(panel)).options == (
        "--partition=gpu",
        "--comment=two words",
    )
    tasks = len(plan.read(farm._output_folder(panel)).tasks)
    assert slurm().count("sbatch") == 2  # render and assemble
    assert farm.status_watch.states[farm._output_folder(panel)].waiting == list(range(1, tasks + 1))
    assert bpy.ops.firetwin.farm_status() == {"FINISHED"}
    assert told(farm.FIRETWIN_OT_farm_status)[0].startswith(
        f"0 done, 0 running, 0 failed, {tasks} waiting, of {tasks}"
    )
    panel.farm_engine, panel.farm_options = "openjd", "--other"  # not of the previous scheduler
    assert bpy.ops.firetwin.farm_resume() == {"FINISHED"}
    assert submission.last_submission(farm._output_folder(panel)).engine == "slurm"
    assert submission.last_submission(farm._output_folder(panel)).options == (
        "--partition=gpu",
        "--comment=two words",
    )
    assert any(
        text.endswith(f"missing: {tasks} tasks to submit") for text in told(farm.FIRETWIN_OT_farm_resume)
    )
    assert bpy.ops.firetwin.farm_cancel() == {"FINISHED"}
    assert slurm()[-1] == "scancel"


@pytest.mark.parametrize("name", ["farm_status", "farm_resume", "farm_cancel"])
def test_a_folder_without_a_job_is_told(panel, name):
    with pytest.raises(RuntimeError, match="has no farm job; write one with Write farm job"):
        getattr(bpy.ops.firetwin, name)()


@SHELL
def test_what_fails_is_a_report(panel, monkeypatch, tmp_path):
    panel.farm_options = "--comment='open"
    with pytest.raises(RuntimeError, match="Options: no closing quotation"):
        bpy.ops.firetwin.farm_write()
    panel.farm_options = ""
    with pytest.raises(RuntimeError, match=r"exit status 127: .*sbatch: command not found"):
        bpy.ops.firetwin.farm_submit()
    panel.farm_engine = "openjd"
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(RuntimeError, match="openjd is not installed here; on a machine that has it, run"):
        bpy.ops.firetwin.farm_submit()
    with pytest.raises(RuntimeError, match="stop openjd run with Ctrl-C or SIGTERM"):
        bpy.ops.firetwin.farm_cancel()


def test_a_file_that_is_not_saved_has_no_job(run_folder, panel):
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    bpy.context.scene.firetwin.run = str(run_folder)
    for cls in (farm.FIRETWIN_OT_farm_write, farm.FIRETWIN_OT_farm_submit):
        with pytest.raises(RuntimeError, match=f"poll.. {farm.NOT_SAVED}"):
            getattr(bpy.ops.firetwin, cls.bl_idname.partition(".")[2])()


@SHELL
def test_a_submission_is_stopped_and_its_command_has_ended(panel, tmp_path, monkeypatch):
    script = (
        f"trap 'echo ended >{tmp_path}/ended; exit 1' TERM; echo begun >{tmp_path}/begun; sleep 60 & wait"
    )
    monkeypatch.setattr(submission, "prepare", lambda *_: ["bash", "-c", script])
    work = job.Job("Submit farm job", farm.FIRETWIN_OT_farm_submit.steps(SimpleNamespace(), bpy.context))
    while not (tmp_path / "begun").exists():
        assert not work.advance()  # Blender goes on
        time.sleep(0.02)
    work.stop.now()
    with pytest.raises(StoppedError):
        work.run()
    assert (tmp_path / "ended").exists()


def test_the_choices_are_saved_with_the_file(panel, tmp_path):
    panel.farm_engine, panel.farm_chunk, panel.farm_options = "deadline", 7, "--priority 80"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    kept = bpy.context.scene.firetwin
    assert (kept.farm_engine, kept.farm_chunk, kept.farm_options) == ("deadline", 7, "--priority 80")
    numbers = {item.identifier: item.value for item in kept.bl_rna.properties["farm_engine"].enum_items}
    assert numbers["deadline"] == farm.zlib.crc32(b"deadline") >> 1  # for any set of schedulers


def test_the_panel_reads_no_file(panel, monkeypatch):
    bpy.ops.firetwin.farm_write()
    bpy.ops.firetwin.farm_status()
    status = farm.status_watch.states[farm._output_folder(panel)]
    monkeypatch.setattr("firetwin.farm.status.gather", lambda *_: pytest.fail("the panel reads"))
    drawn = []

    class Layout:
        def __getattr__(self, name):
            def call(*arguments, **more):
                drawn.append((name, arguments, more))
                return self

            return call

        def __setattr__(self, name, value):
            pass

    monkeypatch.setattr(farm, "draw_paragraph", lambda *_: None)  # needs a window
    monkeypatch.setattr(working, "draw_messages", lambda *_: None)
    context = SimpleNamespace(scene=bpy.context.scene)
    farm.FIRETWIN_PT_farm.draw(SimpleNamespace(layout=Layout()), context)
    words = [more["text"] for _, _, more in drawn if "text" in more]
    assert f"0 done, 0 running, 0 failed, {len(status.waiting)} waiting, of {status.tasks}" in words


def test_the_watch_follows_a_job_until_it_is_done(panel, monkeypatch):
    bpy.ops.firetwin.farm_write()
    out = farm._output_folder(panel)
    monkeypatch.setattr(farm.status_watch, "folder", out)

    def looked():
        assert farm.status_watch.tick() == folder_watch.SHORT
        farm.status_watch.thread.join()
        return farm.status_watch.tick()

    assert looked() == farm._PERIOD
    assert farm.status_watch.states[out].waiting
    (out / "farm/job.json").write_text("{")
    assert looked() is None
    assert "not a farm job of this version" in farm.status_watch.states[out]
    farm.status_watch.clear()
    assert farm.status_watch.states == {}
