"""A small run with a straight front."""

import numpy as np
from firetwin.run import areas
from firetwin.run import opening as runs
from firetwin.shot.sections import Forest, TerrainSettings, Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from small_run import NT, RUN_TOML

NORTH, EAST = areas.metres_per_degree(38.9)
N, PACE = 24, 0.5  # fuel cells along a side; m/s


def shot_of(make_run, cell, load, canopy=0.0, flank=1.0):
    """A front that goes east at `PACE`, and north of the middle so much slower, over cells of `cell` m."""
    fine = (np.arange(N) - 0.5 * (N - 1)) * cell
    coarse = fine.reshape(-1, 2).mean(axis=1)
    north, east = np.meshgrid(fine, fine, indexing="ij")
    arrival = (east - east.min()) / (PACE * np.where(north > 0.0, flank, 1.0)) + 1.0
    shape = (NT, N // 2, N // 2)
    folder = make_run(
        toml=RUN_TOML.replace("synthetic = true", "synthetic = false").replace("60.0", f"{arrival.max()}"),
        latitude=38.9 + coarse / NORTH,
        longitude=-120.6 + coarse / EAST,
        elevation=np.zeros(shape[1:], np.float32),
        fuel_latitude=38.9 + fine / NORTH,
        fuel_longitude=-120.6 + fine / EAST,
        surface_fuel=np.full((N, N), load, np.float32),
        canopy_fuel=np.full((N, N), canopy, np.float32),
        fuel_arrival_time=arrival.astype(np.float32),
        heat_flux=np.ones(shape, np.float32),
        temperature=None,
        wind_east=None,
        wind_north=None,
    )
    settings = Settings(
        time=Time(frames=3),
        terrain=TerrainSettings(near_radius=0.0, apron=2000.0),
        forest=Forest(trees=False),
    )
    return Shot(settings, runs.open(folder))
