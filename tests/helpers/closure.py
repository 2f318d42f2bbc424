"""Small fires over small terrain, solved as smoke in few cells, and sums over their snapshots."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from pathlib import Path
from threading import Event

import numpy as np
import whole_run
from firetwin.run import burning
from firetwin.run import opening as runs
from firetwin.shot.fire.smoke_scale import Scale
from firetwin.shot.sections import Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from firetwin.smoke import integrator, snapshots
from firetwin.smoke.domains import Box, Domain
from firetwin.smoke.integrator import Integrator

CELL, SPIN_UP, SPAN = 50.0, 200.0, 80.0  # m; s before the first frame; s from the first frame to the second
TERRAIN = {
    "flat": None,
    "slope": lambda x, y: 900.0 + 0.15 * x - 0.05 * y,
    "hills": lambda x, y: 400.0 + 90.0 * np.sin(x / 300.0) * np.cos(y / 240.0),
}


def spots(rows: slice, columns: slice, watts: float, first: int = 1, last: int | None = None):
    """Return a function that sets cells (rows, columns) of a flux, W/m2, at model times."""

    def put(flux):
        flux[:] = 0.0
        flux[first:last, rows, columns] = watts

    return put


MIDDLE = slice(31, 32), slice(31, 32)
FIRES = {
    "front in wind": {},
    "calm": {"wind": None},
    "strong wind": {"wind": (14.0, 5.0)},
    "crowns": {"canopy": 1.2, "surface": 1.5},
    "two fires": {"fires": ((-400.0, -200.0, 0.0), (350.0, 150.0, 1200.0))},
    "starts late": {"fires": ((0.0, 0.0, 1800.0),)},
    "fluxes alone": {"arrival": False},
    "85 north": {"at": (85.0, 10.0)},
    "one cell of 1e7 W/m2": {"arrival": False, "flux": spots(*MIDDLE, 1e7)},
    "2 x 2 cells of 1e7 W/m2": {"arrival": False, "flux": spots(slice(31, 33), slice(31, 33), 1e7)},
    "goes out": {"arrival": False, "flux": spots(slice(28, 34), slice(28, 34), 4e4, 1, 8)},
}
CASES = [(fire, terrain) for fire in FIRES for terrain in TERRAIN]


@dataclass(frozen=True)
class Sums:
    """Errors of sums, relative: smoke of the box and of the nest, heat of run, of sources and of the air."""

    smoke: float
    nest: float
    run: float
    air: float


def make_shot(folder: Path, fire: str, terrain: str, spin_up: float = SPIN_UP) -> Shot:
    """Write a run of a fire over a terrain, and return a shot of two frames."""
    options = dict(FIRES[fire])
    put = options.pop("flux", None)
    times = tuple(np.arange(0.0, 2701.0, 300.0).tolist())
    whole_run.write(folder, times=times, height=TERRAIN[terrain], **options)
    if put is not None:
        flux = np.load(folder / "heat_flux.npy")
        put(flux)
        np.save(folder / "heat_flux.npy", flux)
    start = datetime.fromisoformat("2020-07-01T20:00:00+00:00") + timedelta(seconds=2000.0)
    time = Time(start=start, end=start + timedelta(seconds=SPAN), frames=2)
    settings = replace(Settings(), run=folder, cache=folder / "cache", time=time)
    settings = replace(settings, smoke=replace(settings.smoke, spin_up=spin_up))
    shot = Shot(settings, runs.open(folder))
    shot.scale = Scale(CELL, True)
    return shot


def domains(shot: Shot, levels: int = 9) -> list[Domain]:
    """Return a box of 40 x 40 cells around a shot's fire, and a nest of 27 x 27 cells over a part of it."""
    sources = shot.fire.sources(shot.frames.middle)
    middle = np.average(sources.position[:, :2], axis=0, weights=sources.power)
    top = tuple(float(z) for z in np.linspace(0.0, 1800.0, levels + 1))
    nested: list[Domain] = []
    for count, cell, shift in ((40, CELL, 0.0), (27, CELL / 3, 100.0)):
        corner = np.round((middle + shift) / CELL) * CELL - 0.5 * count * cell
        box = Box(top, (count, count), cell, (float(corner[0]), float(corner[1])))
        x, y = box.middles()
        ground = shot.bare_ground.up(np.tile(x, count), np.repeat(y, count)).reshape(count, count)
        mean = nested[0].mean if nested else float(ground.mean())
        folder = shot.settings.cache / f"domain_{len(nested)}"
        folder.mkdir(parents=True, exist_ok=True)
        nested.append(Domain(box, ground, mean, top[-1], folder, shot.scale))
    return nested


def airborne(domain: Domain, moment: snapshots.Snapshot) -> float:
    """Sum the smoke in the cells of a snapshot, kg."""
    smoke = moment.fields["smoke"].astype(np.float64)
    (west, south), (high, rows, columns) = moment.low, smoke.shape
    return float(np.sum(smoke * domain.volumes()[:high, south : south + rows, west : west + columns]))


def emission(shot: Shot, domain: Domain, first: float, last: float, count: int = 400) -> tuple[float, float]:
    """Integrate smoke (kg) and heat (J) that the fire of a shot emits in a domain, by the midpoint rule."""
    smoke, heat, step = 0.0, 0.0, (last - first) / count
    for time in first + step * (np.arange(count) + 0.5):
        sources = shot.fire.sources(float(time))
        inside = sources.take(domain.box.contains(sources.position))
        smoke, heat = smoke + step * inside.smoke.sum(), heat + step * inside.power.sum()
    return float(smoke), float(heat)


def heat_of_run(shot: Shot, first: float, last: float) -> float:
    """Integrate the run's heat flux over its cells, J, linear between model times."""
    run = shot.run
    area = burning.model_cell_areas(run)
    power = [
        float(np.sum(np.nan_to_num(run.heat_flux(k).astype(np.float64)) * area))
        for k in range(len(run.times))
    ]
    times = np.concatenate([[first], run.times[(run.times > first) & (run.times < last)], [last]])
    values = np.interp(times, run.times, power)
    return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(times)))


def measure(shot: Shot, count: int = 400) -> Sums:
    """Solve the smoke of a shot, and compare its snapshots with the emission of the fire.

    The nest has the same beginning as the box.
    """
    nested = domains(shot)
    solving = Integrator(shot, nested, Event(), 2)
    solving.solve(2, lambda *_: None, 2)
    begin, first, last = shot.frames.first - shot.spin_up, shot.frames.first, shot.frames.last
    errors = []
    for domain in nested:
        late = snapshots.load(domain.snapshot_path(2))
        smoke, _ = emission(shot, domain, begin, last, count)
        held = airborne(domain, late) + late.mass["left"] - late.mass["entered"] - late.mass["initial"]
        errors.append(held / smoke - 1.0 if smoke > 0.0 else held)
    early, late = (snapshots.load(nested[0].snapshot_path(frame)) for frame in (1, 2))
    _, heat = emission(shot, nested[0], first, last, count)
    given = (late.heat["given"] - early.heat["given"]) / integrator.CONVECTED
    return Sums(*errors, heat / heat_of_run(shot, first, last) - 1.0, given / heat - 1.0)
