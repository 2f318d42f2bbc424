"""A run with smoke on levels, whose frames are volumes that are written in a moment."""

import shutil

import numpy as np
from firetwin.run import opening as runs


def write(run, folder):
    """Copy a run to `folder` and add smoke that grows with time; return the folder."""
    shutil.copytree(run, folder)
    plain = runs.open(folder)
    levels = plain.elevation + np.linspace(10.0, 3000.0, 12, dtype=np.float32)[:, None, None]
    smoke = np.zeros((len(plain.times), *levels.shape), np.float32)
    smoke[:, 4:8, 8:16, 8:16] = 1.0e-6 * (1.0 + np.arange(len(plain.times)))[:, None, None, None]
    np.save(folder / "height_3d.npy", levels)
    np.save(folder / "smoke_3d.npy", smoke)
    return folder
