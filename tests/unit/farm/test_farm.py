"""Farm jobs: chunks, tasks, entries, engines' texts and what counts as done, without any engine."""

import errno
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from firetwin import cli, limits
from firetwin.errors import (
    Error,
    FullDiskError,
    InputError,
    TryAgainError,
    UsageError,
    full_disk_error,
    input_error,
)
from firetwin.farm import assemble, assets, entries, lost, plan, private, status, task
from firetwin.farm.engines import Batch, deadline, known, openjd
from firetwin.farm.engines.slurm import split_arrays
from firetwin.farm.entries import Entry
from firetwin.farm.plan import Job, Task
from firetwin.farm.private import PrivateFolder, verified_entries
from firetwin.render import fingerprint, manifest
from firetwin.render.picture import Picture
from firetwin.render.store import Store, describe
from firetwin.run import content
from firetwin.run import opening as runs
from firetwin.shot.frames import part_of
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.smoke.sources.flow import FlowSource
from hypothesis import given
from hypothesis import strategies as st

NOW = "2014-09-17T23:12:00+00:00"
VERSIONS = {"firetwin": "0", "blender": "4.5.15"}
CAMERA = """\
[[cameras]]
name = "{name}"
frames = "{frames}"
keys = [{{latitude = 38.904, longitude = -120.592, height = 300, target = "fire"}}]
"""


def job(tasks, camera_frames=None, passes=("rgb",), count=100, **more):
    camera_frames = camera_frames or {"drone": ""}
    every = {name: tuple(passes) for name in camera_frames}
    about = {"scene": "/scene.toml", "scene_sha256": "", "versions": VERSIONS, "assets": ()} | more
    return Job(count=count, camera_frames=camera_frames, passes=every, tasks=tuple(tasks), **about)


@pytest.fixture
def make_shot(make_run, tmp_path):
    """A shot of the small run: make(frames, cameras={name: frames}, chunk=..., smoke=..., more=...)."""
    run = make_run()

    def make(frames=10, cameras=None, chunk=480, smoke="enabled = false", more=""):
        path = tmp_path / "scene.toml"
        text = f'run = "run"\n[time]\nframes = {frames}\nshutter = 0.0\n[smoke]\n{smoke}\n'
        text += f"[render]\nchunk = {chunk}\n{more}\n"
        listed = cameras or {"drone": ""}
        path.write_text(text + "".join(CAMERA.format(name=n, frames=f) for n, f in listed.items()))
        return Shot(scene_file.read(path), runs.open(run))

    return make


@pytest.mark.parametrize("built", range(8))
@given(st.integers(1, 20), st.sets(st.integers(2, 20), max_size=6), st.integers(1, 6))
def test_chunks_have_every_frame_once_and_build_as_little_as_can_be(built, count, left_out, size):
    listed = sorted({*range(1, count + 1)} - left_out)
    chunks = plan.split_frames(listed, size, built)
    assert [frame for part in chunks for frame in part] == listed
    assert max(map(len, chunks)) <= size
    parts = [sorted({part_of(frame, built) for frame in part}) for part in chunks]
    for part, of in zip(chunks, parts, strict=True):
        whole = [frame for frame in listed if part_of(frame, built) in of]
        assert len(of) == 1 or part == whole  # no part is built by two tasks where one could
    for of in {of[0] for of in parts if len(of) == 1}:
        own = [len(part) for part in chunks if part_of(part[0], built) == of]
        assert max(own) - min(own) <= 1
        assert len(own) == -(-sum(own) // size)


def test_tasks_are_cameras_by_chunks_and_pictures_each_once(make_shot):
    shot = make_shot(10, {"drone": "", "other": "2-9:2"}, chunk=3, more='passes = ["rgb", "depth"]')
    farm_job = plan.make_job(shot, shot.settings.path, 4)
    assert [(each.cameras, each.frames) for each in farm_job.tasks] == [
        (("drone",), "1-3"),
        (("drone",), "4-6"),
        (("drone",), "7-10"),
        (("other",), "2,4,6,8"),
    ]
    pictures = [picture for each in farm_job.tasks for picture in farm_job.pictures(each)]
    assert len(pictures) == len(set(pictures)) == 2 * (10 + 4)


def test_cameras_that_give_each_other_pictures_share_tasks(make_shot):
    mounted = '\n[[cameras]]\nname = "sensor"\nkind = "mounted"\nfollows = "drone"\npasses = ["thermal"]\n'
    shot = make_shot(3, more='passes = ["rgb"]')
    text = shot.settings.path.read_text()
    shot.settings.path.write_text(text + 'passes = ["fused"]\n' + mounted)
    made = plan.make_job(Shot(scene_file.read(shot.settings.path), shot.run), shot.settings.path)
    assert [each.cameras for each in made.tasks] == [("drone", "sensor")]


def test_a_flow_is_solved_once_for_all_cameras_that_share_it(make_shot, monkeypatch):
    cameras = {"drone": "", "other": "1"}
    for smoke, bakes in (('method = "flow"', 1), ('method = "preview"', 1), ("enabled = false", 0)):
        shot = make_shot(2, cameras, smoke=smoke)
        made = plan.make_job(shot, shot.settings.path)
        assert len(made.numbers("bake")) == bakes
        assert made.numbers("render") == [bakes + 1, bakes + 2]
    flows = {"wide": {"whole"}, "near": {"whole", "nest"}, "far": {"whole", "another"}, "late": {"whole"}}
    monkeypatch.setattr(FlowSource, "solutions", lambda self: flows[self.shot.settings.cameras[0].name])
    listed = {"wide": "1-2", "near": "3", "far": "5", "late": "6"}
    shot = make_shot(6, listed, smoke='method = "flow"')
    bakes = [each for each in plan.make_job(shot, shot.settings.path).tasks if each.stage == "bake"]
    assert [(*each.cameras, each.frames) for each in bakes] == [("near", "1-3,6"), ("far", "5")]


def test_a_long_film_of_many_cameras_is_planned_in_few_steps(make_shot):
    """10,000 frames of 4 cameras: steps, not seconds, are counted, and the texts of all engines measured."""
    shot = make_shot(10_000, {f"camera{k}": "" for k in range(4)}, chunk=48, smoke='method = "flow"')
    calls = 0

    def count(frame, event, argument):
        nonlocal calls
        calls += event == "call"

    sys.setprofile(count)
    try:
        farm_job = plan.make_job(shot, shot.settings.path)
    finally:
        sys.setprofile(None)
    assert calls < 400_000  # most of them for the cameras' paths
    assert len(farm_job.tasks) == 1 + 4 * 417
    out = shot.settings.path.parent / "out"
    plan.write(farm_job, out)
    assert plan.read(out) == farm_job
    batch = Batch(farm_job, out, tuple(range(1, len(farm_job.tasks) + 1)))
    for engine in known().values():
        engine().write(batch)
    sizes = {path: path.stat().st_size for path in (out / "farm").rglob("*") if path.is_file()}
    assert len(sizes) >= 9
    assert not {path: size for path, size in sizes.items() if size > 150_000}


def test_a_bundle_lists_every_asset_and_bakes_before_it_renders(make_shot, tmp_path):
    shot = make_shot(4, {"drone": "", "other": ""}, chunk=2, smoke='method = "flow"')
    farm_job, out = plan.make_job(shot, shot.settings.path, 2), tmp_path / "out"
    batch = Batch(farm_job, out, tuple(range(1, len(farm_job.tasks) + 1)))
    command = deadline.Deadline().write(batch)
    template, values, references = (
        json.loads((Path(command[-1]) / f"{name}.json").read_text())
        for name in ("template", "parameter_values", "asset_references")
    )
    steps = {
        each["name"]: [d["dependsOn"] for d in each.get("dependencies", ())] for each in template["steps"]
    }
    assert steps == {"Bake": [], "Render": ["Bake"], "Assemble": ["Bake", "Render"]}
    valued = {each["name"] for each in values["parameterValues"]}
    assert {each["name"] for each in template["parameterDefinitions"]} <= valued
    inputs = references["assetReferences"]["inputs"]["filenames"]
    assert {*farm_job.assets, str(out / "farm" / "job.json")} <= set(inputs)
    partial = Batch(farm_job, out, tuple(farm_job.numbers("render")[:1]))
    assert [each["name"] for each in openjd.template(partial)["steps"]] == ["Render", "Assemble"]


def test_what_is_needed_is_listed_and_must_be_there(make_shot, tmp_path):
    shot = make_shot(more='\n[fire]\nobserved = "seen.shp"\n')
    fields = {path.absolute() for path in (tmp_path / "run").iterdir() if path.name[0] != "."}
    with pytest.raises(InputError, match=r"seen\.shp: is missing"):
        assets.list_assets(shot)
    parts = [tmp_path / f"seen.{end}" for end in ("shp", "dbf", "shx")]
    for part in parts:
        part.touch()
    assert set(assets.list_assets(shot)) == fields | {shot.settings.path, *parts}
    assert assets.outside_of(parts, tmp_path) == []
    assert assets.outside_of(parts, tmp_path / "run") == parts


def test_tilesets_of_this_machine_are_needed_too(make_shot, tmp_path):
    for name in ("set/tileset.json", "set/1/a.glb", "other/tileset.json", "other/b.glb", "city.3tz"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    places = ["set", "other/tileset.json", "city.3tz", "https://tiles.example/tileset.json"]
    shot = make_shot(more=f"\n[tiles]\nsources = {places}\n")
    names = {path.relative_to(tmp_path).as_posix() for path in assets.list_assets(shot)}
    assert {"set/tileset.json", "set/1/a.glb", "other/tileset.json", "other/b.glb", "city.3tz"} < names
    assert not any("example" in name for name in names)


def test_files_above_a_tileset_are_needed_if_it_refers_to_them(make_shot, tmp_path, monkeypatch):
    """Of the folder `root`, which may be a drive, the folders that are named."""
    texts = {
        "all/set/tileset.json": '{"uri": "../glb/a.glb", "url": "..\\/more/tileset.json"}',
        "all/set/b.glb": "",
        "all/glb/a.glb": "",
        "all/glb/a.png": "",
        "all/glb/deep/no.glb": "",
        "all/more/tileset.json": '{"content": {"uri": "../tiles/{level}/{x}.glb"}, '
        '"a": {"uri": "../../no.glb"}}',
        "all/tiles/1/2.glb": "",
        "all/other/no.glb": "",
        "no.glb": "",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    shot = make_shot(more='\n[tiles]\nsources = ["all/set"]\nroot = "all"\n')
    wanted = {name for name in texts if "no.glb" not in name}
    assert {path.relative_to(tmp_path).as_posix() for path in assets.list_assets(shot)} & set(texts) == wanted
    own = make_shot(more='\n[tiles]\nsources = ["all/set"]\n')
    listed = {path.relative_to(tmp_path).as_posix() for path in assets.list_assets(own)}
    assert listed & set(texts) == {"all/set/tileset.json", "all/set/b.glb"}
    monkeypatch.setattr(limits, "FARM_FILES", 5)
    with pytest.raises(
        InputError, match=r"set: has or needs more than 5 files; pack the tileset into a \.3tz"
    ):
        assets.list_assets(shot)
    assert assets.list_assets(own)


def test_files_of_stations_are_needed_where_stations_are_on(make_shot, tmp_path):
    names = 'file = "a.gpkg"\nfootprints = "b.geojson"\nroutes_file = "c.geojson"\n'
    wanted = {tmp_path / name for name in ("a.gpkg", "b.geojson", "c.geojson")}
    for path in wanted:
        path.touch()
    for enabled in ("true", "false"):
        needed = set(assets.list_assets(make_shot(more=f"\n[stations]\nenabled = {enabled}\n{names}")))
        assert needed & wanted == (wanted if enabled == "true" else set())


def test_another_job_is_not_overwritten(tmp_path):
    first = job([Task("render", ("drone",), "1-3")])
    plan.write(first, tmp_path)
    plan.write(first, tmp_path)
    with pytest.raises(InputError, match="a different job"):
        plan.write(replace(first, count=7), tmp_path)
    assert plan.read(tmp_path) == first
    (tmp_path / "farm" / "job.json").write_text("{}")
    with pytest.raises(InputError, match="not a farm job"):
        plan.read(tmp_path)
    with pytest.raises(InputError, match="firetwin farm SCENE"):
        plan.read(tmp_path / "nothing")


entry = st.builds(
    Entry,
    *(st.text(), st.integers(0, 10**12), st.text("0123456789abcdef", min_size=64, max_size=64), st.text()),
    *(st.text(), st.text(), st.integers(1, 10**6), st.text()),
    st.dictionaries(st.text(), st.floats(allow_nan=False) | st.lists(st.text())),
)


@given(st.lists(entry, max_size=5), st.integers(1, 30))
def test_entries_come_back_and_a_line_that_is_cut_off_counts_for_nothing(tmp_path_factory, written, cut):
    out = tmp_path_factory.mktemp("out")
    with entries.attempt(out, 12) as log:
        log.write(*written)
        log.end(0)
    (read,) = entries.attempts(out, 12)
    assert (read.number, read.ended, read.entries) == (12, 0, written)
    assert entries.attempts(out, 13) == []
    text = log.path.read_bytes()
    log.path.write_bytes(text[:-cut])
    (read,) = entries.attempts(out)
    assert (read.ended, read.entries) == (None, written)


@pytest.fixture
def film(tmp_path):
    """A folder with a job of two tasks of two frames, made with settings that are only names."""
    made_with = {("drone", "rgb"): {"settings": "these"}}
    plan.write(job([Task("render", ("drone",), "1-2"), Task("render", ("drone",), "3-4")]), tmp_path)
    return tmp_path, made_with


def render(out, made_with, number, frames, ended: int | None = 0, content_of=b"picture %d"):
    """Files of a task that has rendered frames."""
    key = content.fingerprint(made_with["drone", "rgb"])
    with entries.attempt(out, number) as log:
        for frame in frames:
            for path in Picture("drone", frame, "rgb").files():
                file = out / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(content_of % frame)
                about = describe(file)
                log.write(Entry(path, about["bytes"], about["sha256"], key, "drone", "rgb", frame, NOW, {}))
        if ended is not None:
            log.end(ended, "" if ended == 0 else "no luck")


def test_a_film_of_a_farm_has_the_entries_of_its_tasks(film):
    out, made_with = film
    render(out, made_with, 1, [1, 2])
    render(out, made_with, 2, [4])
    own, paths = out / "own", Picture("drone", 3, "rgb").files()
    rows = {}
    with Store(own, create=True) as store:
        for path in paths:
            (own / path).parent.mkdir(parents=True, exist_ok=True)
            (own / path).write_bytes(b"picture")
            about = {"camera": "drone", "pass": "rgb", "frame": 3, "time": NOW} | describe(own / path)
            credits = {"credits": ["Data A"], "services": ["Logo B"], "missing_tiles": ["t.glb"]}
            rows[path] = about | credits | {"exposure": 3.25, "clock": "24 UTC"}
        store.add(made_with["drone", "rgb"], rows)
    with entries.attempt(out, 2) as log:
        PrivateFolder(own, out, log).publish()
    intact, missing = assemble.check_pictures(plan.read(out), out, made_with)
    with Store(out, create=True) as store:
        assemble.add_to_store(store, intact, made_with)
        store.export()
    found = manifest.read(out)["files"]
    key = content.fingerprint(made_with["drone", "rgb"])
    assert not missing
    assert {path: found[path] for path in paths} == {
        path: row | {"settings": key} for path, row in rows.items()
    }


def test_assemble_names_what_is_missing_and_refuses_what_is_damaged(film):
    out, made_with = film
    farm_job = plan.read(out)
    render(out, made_with, 1, [1, 2])
    render(out, made_with | {("drone", "rgb"): {"settings": "others"}}, 2, [3])
    (out / Picture("drone", 2, "rgb").files()[0]).write_bytes(b"pictUre 2")
    whole, lost = assemble.check_pictures(farm_job, out, made_with)
    assert [found[0].frame for found in whole] == [1]
    assert list(assemble.format_missing(lost)) == [
        f"drone rgb 2: {assemble.DAMAGED}",
        f"drone rgb 3: {assemble.OTHER}",
        f"drone rgb 4: {assemble.NOT_MADE}",
    ]
    assert assemble.tasks_of_pictures(farm_job, lost) == [1, 2]
    assert assemble.tasks_of_pictures(farm_job, [Picture("drone", 4, "rgb")]) == [2]
    render(out, made_with, 1, [2])
    render(out, made_with, 2, [3, 4])
    whole, lost = assemble.check_pictures(farm_job, out, made_with)
    assert lost == {}
    with Store(out, create=True) as store:
        assemble.add_to_store(store, whole, made_with)
        number = store.latest_number()
        assemble.add_to_store(store, whole, made_with)
        assert store.latest_number() == number  # twice is once
        key = content.fingerprint(made_with["drone", "rgb"])
        assert sorted(store.pictures("drone", "rgb", key, ".png")) == [1, 2, 3, 4]


def test_a_bundle_that_is_submitted_again_carries_what_was_made(film):
    out, made_with = film
    bundle = deadline.Deadline()

    def folders(number):
        bundle.write(Batch(plan.read(out), out, (number,)))
        text = (out / "farm" / "deadline" / "asset_references.json").read_text()
        return json.loads(text)["assetReferences"]["inputs"]["directories"]

    assert folders(1) == []
    render(out, made_with, 1, [1, 2])
    (out / "farm" / "cache").mkdir()
    assert folders(2) == [str(out / place) for place in ("farm/entries", "farm/cache", "drone")]


def test_of_attempts_at_once_either_file_counts(film):
    out, made_with = film
    render(out, made_with, 1, [1], content_of=b"other bytes %d")
    render(out, made_with, 1, [1])
    assert len(assemble.check_pictures(plan.read(out), out, made_with)[0]) == 1
    known = [each for found in entries.attempts(out, 1) for each in found.entries]
    assert len(verified_entries(known, out, made_with)) == len(Picture("drone", 1, "rgb").files())


def test_a_task_publishes_what_it_made_and_keeps_what_was_whole(film, tmp_path_factory):
    out, made_with = film
    render(out, made_with, 1, [1], ended=None)
    place = tmp_path_factory.mktemp("private")
    known = [each for found in entries.attempts(out, 1) for each in found.entries]
    with entries.attempt(out, 1) as log:
        private = PrivateFolder(place, out, log)
        private.seed(verified_entries(known, out, made_with), made_with)
        private.publish()
        assert len(log.path.read_text().splitlines()) == 1  # nothing new
        with Store(place) as store:
            paths = Picture("drone", 2, "rgb").files()
            made = {}
            for path in paths:
                (place / path).write_bytes(b"new")
                about = {"camera": "drone", "pass": "rgb", "frame": 2, "time": "now"}
                made[path] = describe(place / path) | about
            store.add(made_with["drone", "rgb"], made)
        private.publish()
        private.publish()
    assert [each.path for each in entries.attempts(out, 1)[-1].entries] == list(paths)
    assert (out / paths[0]).read_bytes() == b"new"
    assert len(assemble.check_pictures(plan.read(out), out, made_with)[0]) == 2


def test_a_full_disk_of_a_node_is_named_with_its_file(film, tmp_path, monkeypatch):
    out, made_with = film
    render(out, made_with, 1, [1])
    logged = [entry for each in entries.attempts(out, 1) for entry in each.entries]
    assert logged

    def full(source, target):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(private, "_link_or_copy", full)
    with entries.attempt(out, 1) as log, pytest.raises(FullDiskError) as caught:
        PrivateFolder(tmp_path, out, log).seed(logged, made_with)
    assert str(tmp_path / logged[0].path) in str(caught.value)
    assert task.exit_status(caught.value) == 75


def test_status_is_read_from_files(film):
    out, made_with = film
    assert status.gather(out).waiting == [1, 2]
    assert status.gather(out).seconds_left is None
    render(out, made_with, 1, [1], ended=None)
    state = status.gather(out)
    assert (state.running, state.waiting, state.finished, state.pictures) == ([1], [2], 1, 4)
    late = status.gather(out, now=found_time(out) + 2 * status.PATIENCE)
    assert late.failed == [1]
    assert "heartbeat stopped" in late.errors[1]
    render(out, made_with, 1, [2])
    render(out, made_with, 2, [3], ended=75)
    state = status.gather(out)
    assert (state.done, state.failed, state.errors) == ([1], [2], {2: "no luck"})
    assert "task 2 failed: no luck" in status.format_text(state)
    json.dumps(state.as_json())
    (out / Picture("drone", 1, "rgb").files()[0]).unlink()
    assert status.gather(out).waiting == [1]


@pytest.mark.posix("signals that ask whether a process runs")
def test_a_killed_task_is_shown_after_45_seconds(film, monkeypatch):
    out, made_with = film
    killed = subprocess.Popen([sys.executable, "-c", ""])
    killed.wait()
    monkeypatch.setattr(entries.os, "getpid", lambda: killed.pid)
    render(out, made_with, 1, [1], ended=None)
    assert status.gather(out, now=found_time(out) + lost.STALE - 1.0).running == [1]
    found = status.gather(out, now=found_time(out) + lost.STALE + 1.0)
    assert found.failed == [1]
    assert "was killed" in found.errors[1]
    monkeypatch.undo()
    render(out, made_with, 1, [1], ended=None)  # this process lives
    assert status.gather(out, now=found_time(out) + lost.STALE + 1.0).running == [1]


@pytest.mark.parametrize(
    ("listed", "reason"), [({"7"}, ""), (set(), "slurm no longer runs job 7"), (None, "")]
)
def test_the_scheduler_is_asked_once_about_stale_tasks(monkeypatch, film, listed, reason):
    out, made_with = film
    monkeypatch.setenv("SLURM_JOB_ID", "7")
    render(out, made_with, 1, [1], ended=None)
    (attempt,) = entries.attempts(out)
    assert attempt.scheduled == "slurm 7"
    asked = []
    known = lost.Lost(attempt.last + 60.0, lambda name: asked.append(name) or listed)
    assert [known.reason(attempt) for _ in range(2)] == [reason] * 2
    assert asked == ["slurm"]


def test_htcondor_says_its_job(monkeypatch, tmp_path):
    (tmp_path / "ad").write_text("ProcId = 0\nClusterId = 12\n")
    monkeypatch.delenv("SLURM_JOB_ID", raising=False)
    monkeypatch.setenv("_CONDOR_JOB_AD", str(tmp_path / "ad"))
    assert entries.scheduler_job() == "htcondor 12.0"
    monkeypatch.setenv("PATH", str(tmp_path))
    assert lost.list_running("slurm") is None


def found_time(out):
    return max(each.last for each in entries.attempts(out))


def test_the_exit_status_says_whether_to_try_again():
    assert task.exit_status(UsageError("no such task")) == 2
    assert task.exit_status(input_error("scene.toml", "wrong", line=1, column=1)) == 2
    assert task.exit_status(full_disk_error("x")) == 75
    assert task.exit_status(OSError(28, "No space left on device")) == 75
    assert task.exit_status(TryAgainError("no GPU")) == 75
    assert task.exit_status(Error("Blender stopped")) == 1
    assert task.exit_status(SystemExit(143)) == 143


def test_a_task_refuses_other_versions_and_a_changed_scene(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text("")
    here = job([], scene=str(scene), scene_sha256=content.sha256(scene), versions=fingerprint.versions())
    choice = task.job_source(here, tmp_path)
    assert choice.cache == str(tmp_path / "farm" / "cache")
    with pytest.raises(UsageError, match="Firetwin 0 with Blender"):
        task.job_source(replace(here, versions=VERSIONS), tmp_path)
    scene.write_text("seed = 2")
    with pytest.raises(UsageError, match="has changed"):
        task.job_source(here, tmp_path)


@given(st.sets(st.integers(1, 5000), min_size=1), st.integers(1, 1001))
def test_arrays_have_every_task_once_and_small_indices(numbers, most):
    found = []
    for base, listed in split_arrays(sorted(numbers), most):
        indices = [n for part in listed.split(",") for n in _span(part)]
        assert 0 <= min(indices) <= max(indices) < most
        found += [base + index for index in indices]
    assert found == sorted(numbers)


def _span(part):
    low, _, high = part.partition("-")
    return range(int(low), int(high or low) + 1)


def test_the_command_line_takes_a_scene_or_a_verb():
    line = "farm scene.toml --engine slurm --out film -- --mem=1G -p x"
    parsed = cli.parse(line.split())
    assert (parsed.verb, str(parsed.scene), parsed.options) == ("plan", "scene.toml", ["--mem=1G", "-p", "x"])
    parsed = cli.parse(["farm", "status", "out"])
    assert (parsed.verb, parsed.options) == ("status", [])
    for name in known():
        assert cli.parse(["farm", "scene.toml", "--engine", name, "--out", "film"]).engine == name
    assert all(engine.name == name for name, engine in known().items())


def test_entries_logged_when_a_task_is_told_to_end_are_not_logged_again(tmp_path):
    class Log(list):
        def write(self, *lines):
            self.extend(lines)
            if len(self) == 1:
                raise SystemExit(143)  # SIGTERM arrives while the log is flushed to the disk

    log, place = Log(), tmp_path / "private"
    place.mkdir()
    (place / "a.png").write_bytes(b"a")
    entry = {"bytes": 1, "sha256": "0", "camera": "drone", "pass": "rgb", "frame": 1, "time": "2014"}
    with Store(place, create=True) as store:
        store.add({"samples": 1}, {"a.png": entry})
    folder = PrivateFolder(place, tmp_path / "out", log)
    with pytest.raises(SystemExit):
        folder.publish()
    folder.publish()  # as a task does at its end
    assert [each.path for each in log] == ["a.png"]
    assert (tmp_path / "out/a.png").read_bytes() == b"a"
