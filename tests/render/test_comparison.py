"""Several runs rendered: files of one call, equal cameras in all runs, and fronts."""

import shutil
from dataclasses import replace
from datetime import UTC, datetime

import bpy
import numpy as np
import pytest
import rendered
from firetwin.blender import owned
from firetwin.forecasts.ensemble import write
from firetwin.forecasts.ensemble.manifest import Manifest, Member
from firetwin.render.store import Store
from firetwin.scene.fire import build as fire
from firetwin.shot.settings import OtherRun
from firetwin.shot.shot import Shot
from firetwin_core import sensor
from scene_text import TINY

SCENE = (
    'run = "{run}"\n[time]\nstart = 2014-09-17T21:30:00Z\nframes = 1\n'
    + '[terrain]\nnear_radius = 0.0\napron = 0.0\n[forest]\ntrees = false\ngrass = false\nunderstorey = 0\n'
    + '[smoke]\nenabled = false\n[forecast]\nensemble = "{ensemble}"\nmember = "01"\n'
    + '[fire]\nfronts = true\nflames = false\n'
    + TINY
    + 'passes = ["comp", "depth", "split", "difference", "outcomes", "forecast_split"]\n'
    '[[runs]]\nname = "late"\npath = "{late}"\n[[cameras]]\n'
    'name = "drone"\nkeys = [{{latitude = 38.81, longitude = -120.57, height = 3000, target = "fire"}}]\n'
)  # fmt: skip


@pytest.fixture(scope="module")
def late_folder(run_folder, tmp_path_factory):
    """The same land on fewer cells, from half an hour earlier on, and a fire that comes ten minutes later."""
    folder = shutil.copytree(run_folder, tmp_path_factory.mktemp("late") / "late")
    toml = (folder / "run.toml").read_text().replace("21:00", "20:30").replace("360.0", "540.0")
    (folder / "run.toml").write_text(toml.replace('"Test"', '"Late"'))
    for file, cut in (
        ("latitude", np.s_[2:]), ("elevation", np.s_[2:]), ("heat_flux", np.s_[:, 2:]),
        ("fuel_latitude", np.s_[10:]), ("fuel_elevation", np.s_[10:]), ("canopy_fuel", np.s_[10:]),
        ("surface_fuel", np.s_[10:]), ("fuel_arrival_time", np.s_[10:]),
    ):  # fmt: skip
        values = np.load(folder / f"{file}.npy")[cut]
        np.save(folder / f"{file}.npy", values + np.float32(2400.0 * (file == "fuel_arrival_time")))
    return folder


@pytest.fixture(scope="module")
def ensemble_folder(run_folder, tmp_path_factory):
    """A forecast whose members are the late run, this run, and one that burns all."""
    folder = tmp_path_factory.mktemp("ensemble") / "ensemble"
    latitude, longitude, arrival = (
        np.load(run_folder / f"fuel_{name}.npy") for name in ("latitude", "longitude", "arrival_time")
    )
    mine = np.where(np.isfinite(arrival), arrival, np.inf)
    late = mine + 600.0
    late[:10] = np.nan  # south of its grid
    every = (late, mine, np.zeros_like(mine))
    members = [(Member(f"{i:02}"), each) for i, each in enumerate(every)]
    head = Manifest("test", "made up", datetime(2014, 9, 17, 21, tzinfo=UTC), 3600.0, ())
    write.write(folder, head, latitude, longitude, members)
    return folder


@pytest.fixture(scope="module")
def film(run_folder, late_folder, ensemble_folder, tmp_path_factory):
    """One frame of everything, as the worker process makes it."""
    text = SCENE.format(run=run_folder, late=late_folder, ensemble=ensemble_folder)
    return rendered.everything(tmp_path_factory.mktemp("film"), text)


def _read(out, camera, name, suffix):
    return np.asarray(sensor.read_image(out / f"{camera}/{name}/{camera}_{name}_000001.{suffix}"))


def test_all_is_made_and_entered(film):
    _, out = film
    with Store(out) as store:
        assert store.names() == [
            "drone/comp/drone_comp_000001.exr",
            "drone/depth/drone_depth_000001.exr",
            "drone/difference/drone_difference_000001.png",
            "drone/forecast/drone_forecast_000001.png",
            "drone/forecast_split/drone_forecast_split_000001.png",
            "drone/outcomes/drone_outcomes_000001.png",
            "drone/rgb/drone_rgb_000001.exr",
            "drone/rgb/drone_rgb_000001.png",
            "drone/split/drone_split_000001.png",
            "drone_at_late/comp/drone_at_late_comp_000001.exr",
            "drone_at_late/depth/drone_at_late_depth_000001.exr",
            "drone_at_late/forecast/drone_at_late_forecast_000001.png",
            "drone_at_late/rgb/drone_at_late_rgb_000001.exr",
            "drone_at_late/rgb/drone_at_late_rgb_000001.png",
        ]
        stops = {path: store.entry(path).get("exposure") for path in store.names()}
    seen = stops["drone/rgb/drone_rgb_000001.png"]
    assert seen is not None
    assert {stops[f"drone/{name}/drone_{name}_000001.png"] for name in ("split", "difference")} == {seen}
    assert _read(out, "drone", "split", "png").shape[:2] == (36, 64)


def test_the_forecast_tints_ground_that_members_burned(film):
    _, out = film
    rgb, found = (_read(out, "drone", name, "png")[..., :3] for name in ("rgb", "forecast"))
    bluer = (found[..., 2] - found[..., 0]) - (rgb[..., 2] - rgb[..., 0])
    assert np.mean(bluer > 0.1) > 0.1
    below = np.s_[24:]  # of the counter
    assert np.abs(_read(out, "drone", "outcomes", "png")[..., :3] - found)[below].max() < 0.01


def test_the_same_pixels_show_the_same_ground_in_both_runs(film):
    _, out = film
    here, there = (_read(out, camera, "depth", "exr")[..., 0] for camera in ("drone", "drone_at_late"))
    both = (here < 2.0e4) & (there < 2.0e4)
    assert both.mean() > 0.5
    apart = np.abs(here / there - 1.0)[both]
    assert np.median(apart) < 0.005  # the mesh may be off by half of one of these pixels
    assert np.mean(apart < 0.02) > 0.9


def test_the_difference_shows_what_the_late_run_has_not_burned(film):
    _, out = film
    rgb = _read(out, "drone", "difference", "png")[..., :3]
    tint = np.ptp(rgb, axis=-1) > 0.2
    green = tint & (rgb[..., 1] > rgb[..., 0] + 0.05)
    amber = tint & (rgb[..., 0] > rgb[..., 1] + 0.05) & (rgb[..., 1] > rgb[..., 2])
    ratio = green[8:].sum() / amber[8:].sum()
    assert 0.6 < ratio < 1.1  # circles of 1/3 and 1/4: 0.78 on level ground


def test_a_front_is_drawn_at_its_moment_alone(run, settings, late_folder):
    whole = replace(
        settings,
        fire=replace(settings.fire, fronts=True, flames=False, observed_width=30.0),
        runs=(OtherRun("late", late_folder),),
    )
    shot = Shot(whole, run)
    scene = owned.adopt(bpy.context.scene).scene
    fire.build(shot, owned.stage(scene))
    thing = bpy.data.objects["Firetwin Front late"]
    counts = []
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        shape = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
        corners = np.array([corner.co[:] for corner in shape.data.vertices])
        counts.append(len(corners))
        if frame == 1:  # the other's fire comes ten minutes later
            continue
        latitude, longitude, _ = shot.local_frame.reverse(corners)
        radius = np.hypot((latitude - 38.84) / 0.04, (longitude + 120.55) / 0.05)
        assert np.median(radius) == pytest.approx(shot.frames.time(frame) / 7200.0, abs=0.01)
    assert sum(counts) == len(thing.data.vertices)
    assert counts[0] == 0 < counts[1] < counts[2]
    assert not thing.visible_shadow
