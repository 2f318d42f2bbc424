"""A flow of smoke in runs of all kinds: each bakes, with finite values in the right places."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from firetwin.jobs import render, solve  # noqa: E402
from firetwin.progress import silent  # noqa: E402
from firetwin.run import readers  # noqa: E402
from firetwin.shot import run_checks  # noqa: E402
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone  # noqa: E402
from firetwin.shot.shot import Shot  # noqa: E402
from firetwin.shot.source import ShotSource  # noqa: E402
from firetwin.smoke import bake, domains, flow_frames, snapshots, sources  # noqa: E402
from firetwin.smoke.flow import Flow  # noqa: E402

START = datetime(2014, 9, 17, 21, 0, tzinfo=UTC)
CELL = 370.0  # m
SPLIT = 4  # fuel cells along one of the model's


@pytest.fixture(autouse=True)
def short_plumes(few_cells, monkeypatch):
    """Large cells, and few of them."""
    monkeypatch.setattr(domains, "_DOWNWIND", (0.0, 2000.0))


@pytest.fixture
def make(tmp_path):
    """Write a run: a fire that spreads in a circle from a cell, on a slope, an hour long unless said.

    Further fields stand in place of these; None leaves one out.
    """

    def write(cells=(20, 20), fire=(0.5, 0.5), speed=1.0, interval=300.0, count=13, **fields):
        (ny, nx), folder = cells, tmp_path / "run"
        folder.mkdir(exist_ok=True)
        fine = (ny * SPLIT, nx * SPLIT)
        y, x = (((np.arange(n) + 0.5) / n - at) * n * CELL / SPLIT for n, at in zip(fine, fire, strict=True))
        distance = np.hypot(*np.meshgrid(y, x, indexing="ij"))
        arrival = np.where(distance < 3000.0, distance / speed, np.nan)
        blocks = arrival.reshape(ny, SPLIT, nx, SPLIT)
        times = np.arange(count) * interval
        burning = [((blocks <= t) & (blocks > t - 900.0)).mean((1, 3)) for t in times]
        degree = CELL / 111_000.0
        latitude, longitude = 38.8 + degree * np.arange(ny), -120.6 + degree / 0.78 * np.arange(nx)
        inner = (np.arange(SPLIT) + 0.5) / SPLIT - 0.5
        given = {
            "latitude": latitude,
            "longitude": longitude,
            "elevation": 800.0 + 40.0 * np.arange(ny)[:, None] + np.zeros(cells),
            "fuel_latitude": (latitude[:, None] + degree * inner).ravel(),
            "fuel_longitude": (longitude[:, None] + degree / 0.78 * inner).ravel(),
            "canopy_fuel": np.full(fine, 1.5),
            "surface_fuel": np.full(fine, 0.8),
            "fuel_arrival_time": arrival,
            "heat_flux": 6.0e4 * np.array(burning),
            "wind_east": np.full((count, ny, nx), 6.0),
            "wind_north": np.full((count, ny, nx), 3.0),
        } | fields
        given = {name: values for name, values in given.items() if values is not None}
        units = {"elevation": "m", "heat_flux": "W/m2", "surface_fuel": "kg/m2", "canopy_fuel": "kg/m2"}
        units |= {"fuel_arrival_time": "s", "wind_east": "m/s", "wind_north": "m/s"}
        for name, values in given.items():
            np.save(folder / f"{name}.npy", values.astype(np.float64 if "itude" in name else np.float32))
        (folder / "run.toml").write_text(
            f'name = "Foreign"\nstart = {START:%Y-%m-%dT%H:%M:%SZ}\ninterval_s = {interval}\n'
            'vertical = "orthometric"\n[units]\n'
            + "".join(f'{name} = "{unit}"\n' for name, unit in units.items() if name in given)
        )
        return folder

    return write


@pytest.fixture
def shoot_flow(settings):
    """The shot of a run: two frames half an hour after its beginning; seen from near."""

    def shot(folder):
        run = readers.open(folder)
        middle = [float(np.mean(axis)) for axis in (run.latitude, run.longitude)]
        key = CameraKey(0.0, middle[0] - 0.03, middle[1], 900.0, "point", *middle, 0.0)
        begin = START + timedelta(minutes=30)
        changed = replace(
            settings,
            run=folder,
            time=replace(settings.time, start=begin, end=begin + timedelta(seconds=30), frames=2),
            smoke=replace(settings.smoke, enabled=True, method="flow", spin_up=120.0, voxel_size=200.0),
            cameras=(replace(settings.cameras[0], rig=Drone(keys=(key,)), frames="2"),),
        )
        run_checks.check(changed, run)
        return Shot(changed, run)

    return shot


def baked(shot):
    """Check the content of all files of frame 2 and return their grids."""
    bpy.utils.expose_bundled_modules()
    import openvdb

    place = bake.bake(shot)
    grids = []
    for path in sorted(place.glob("*_000002.vdb")):
        for grid in openvdb.readAll(str(path))[0]:
            corners = grid.evalActiveVoxelBoundingBox()  # the lowest may be the largest number of 32 bits
            low, high = (np.array(corner, np.int64) for corner in corners)
            values = np.zeros(np.maximum(high - low + 1, 0), np.float32)
            if values.size:
                grid.copyToArray(values, ijk=tuple(int(v) for v in low))
                assert grid.transform.indexToWorld(tuple(high))[2] < 8000.0
            assert np.isfinite(values).all()
            assert values.min(initial=0.0) >= 0.0
            if grid.name == "density":
                assert values.max(initial=0.0) <= flow_frames.max_extinction(shot.scale) * 1.01
                grids.append(values)
    for domain in Flow(shot).domains:
        assert np.isfinite(domain.heights()).all()
        mass = snapshots.load(domain.snapshot_path(2)).mass
        assert all(np.isfinite(value) for value in mass.values())
        assert mass["airborne"] + mass["left"] == pytest.approx(
            mass["initial"] + mass["emitted"] + mass["entered"] + mass["rounding"], rel=1e-6
        )
    assert grids
    return grids


def thick(found):
    """Voxels that occlude all smoke behind a few of them."""
    return sum(int((values > 1e-3).sum()) for values in found)


def without(*names):
    return dict.fromkeys(names)


SLOPE = 800.0 + 40.0 * np.arange(20.0)[:, None] + np.zeros((20, 20))
SEA = np.where(np.arange(20)[:, None] < 10, 0.0, SLOPE)
LAND_ONLY = np.where(np.arange(80)[:, None] < 40, 0.0, 1.0) * np.ones((80, 80))


@pytest.mark.parametrize(
    "run",
    [
        pytest.param(without("wind_east", "wind_north"), id="no wind"),
        pytest.param(without("fuel_arrival_time"), id="no arrival time"),
        pytest.param(without("fuel_arrival_time", "wind_east", "wind_north"), id="neither"),
        pytest.param({"interval": 900.0, "count": 5}, id="a quarter of an hour"),
        pytest.param(
            {"interval": 900.0, "count": 5} | without("fuel_arrival_time"), id="the same, no arrival time"
        ),
        pytest.param({"elevation": 0.0 * SEA}, id="all at sea level"),
        pytest.param(
            {"elevation": SEA, "canopy_fuel": 1.5 * LAND_ONLY, "surface_fuel": 0.8 * LAND_ONLY}, id="a coast"
        ),
        pytest.param({"elevation": np.where(SEA > 0.0, SEA, np.nan)}, id="no height of the sea"),
        pytest.param({"elevation": 0.0 * SEA - 400.0}, id="below the sea"),
        pytest.param({"fire": (0.0, 0.5)}, id="at an edge"),
        pytest.param({"fire": (1.0, 1.0)}, id="in a corner"),
        pytest.param({"cells": (2, 2), "speed": 0.2}, id="four cells"),
        pytest.param({"cells": (2, 2), "speed": 0.2} | without("fuel_arrival_time"), id="four, none arrives"),
        pytest.param({"cells": (1, 1), "speed": 0.1}, id="one cell"),
        pytest.param({"cells": (1, 1), "speed": 0.1} | without("fuel_arrival_time"), id="one, none arrives"),
        pytest.param({"cells": (1, 30)}, id="a row"),
        pytest.param({"cells": (3, 40)}, id="a strip"),
        pytest.param({"fuel_arrival_time": np.full((80, 80), np.nan)}, id="heat where nothing arrives"),
        pytest.param({"canopy_fuel": np.zeros((80, 80)), "surface_fuel": np.zeros((80, 80))}, id="no fuel"),
        pytest.param({"wind_east": np.full((13, 20, 20), 45.0)}, id="a storm"),
        pytest.param({"heat_flux": 40.0 * np.full((13, 20, 20), 6.0e4)}, id="impossible heat"),
    ],
)
def test_a_run_of_any_kind_has_smoke(make, shoot_flow, run):
    found = baked(shoot_flow(make(**run)))
    assert thick(found) > 5


@pytest.mark.parametrize(
    "run",
    [
        pytest.param({"heat_flux": np.zeros((13, 20, 20))}, id="no heat"),
        pytest.param({"heat_flux": np.zeros((13, 20, 20))} | without("fuel_arrival_time"), id="no fire"),
        pytest.param({"fire": (-2.0, -2.0)}, id="outside of the run"),
    ],
)
def test_where_nothing_burns_there_is_no_smoke(make, shoot_flow, run):
    assert thick(baked(shoot_flow(make(**run)))) == 0


def test_what_solving_takes_is_said_before_it_and_not_after(make, shoot_flow, monkeypatch):
    monkeypatch.setattr(solve, "in_parallel", lambda *_: nullcontext())
    shot = shoot_flow(make())
    told, said = [], sources.select(shot).cost().describe()
    assert said.startswith("the air over 2 min 30 s of the fire is solved once")
    assert "s before the first picture)" in said
    assert str(shot.settings.cache) in said
    with render._solving(ShotSource(), shot, [1], silent, told.append):
        assert told == [said]
    bake.bake(shot)
    assert sources.select(shot).cost() is None
