"""A shot of cameras over bare ground, and level ground of the small run."""

import numpy as np
from firetwin.shot.sections import Forest, TerrainSettings, Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from small_run import FX, FY, NX, NY

LEVEL = {
    "elevation": np.full((NY, NX), 1200.0, np.float32),
    "fuel_elevation": np.full((FY, FX), 1200.0, np.float32),
}


def film(run, *cameras, near_radius=0.0, apron=3000.0, render=None, **time):
    """A shot of a run without trees; keywords of time are those of its section."""
    settings = Settings(
        time=Time(**time),
        terrain=TerrainSettings(near_radius=near_radius, apron=apron),
        forest=Forest(trees=False),
        cameras=cameras,
        **({} if render is None else {"render": render}),
    )
    return Shot(settings, run)
