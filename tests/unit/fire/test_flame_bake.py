"""Flames written as voxels: the values of the field at the voxels' centres, and no flame left out."""

import numpy as np
import pytest
from firetwin_core import volume
from firetwin_core.flames import write_flames
from flame_field import flames, front
from planck import EMPTY, EVERY, PLANCK
from plumes import read

VOXEL = 0.5
HALF = 2.0**-10  # relative rounding of half precision


ORIGIN = (1024.0, -2048.0, 300.0)
EYE = (984.0, -2048.0, 300.0)


def front_of(height=6.0, **changes):
    """Flames along two of their heights at the origin, on ground at its height."""
    nodes, corners, spacings = front(
        max(height, 1.0),
        half=(2.0, 3.0),
        GROUND=ORIGIN[2],
        LENGTH=lambda x, y: height * (np.abs(x) < height),
    )
    patches = nodes, corners + ORIGIN[:2], spacings
    return flames(patches, 7.0, (0.0, 1.0), origin=EYE, soot=0.01, **changes)


@pytest.fixture
def written(tmp_path):
    """Flames, the summary of their file, and indices (n, 3) and values (n, 3) of its voxels."""
    burning = front_of()
    summary = write_flames(tmp_path / "flames.vdb", burning, VOXEL)
    grids = read(tmp_path / "flames.vdb")
    extinction, low = grids["flames"]
    assert all(np.array_equal(low, grids[name][1]) for name in ("infrared", "temperature"))
    lit = np.argwhere(extinction > 0.0)
    values = [grids[name][0][tuple(lit.T)] for name in ("flames", "infrared", "temperature")]
    return burning, summary, lit + low, np.stack(values, axis=-1)


def test_voxels_hold_the_field_at_their_centres(written):
    """Eight neighbours are evaluated together and share a level of the blocks, which moves a few edges."""
    burning, summary, index, values = written
    found = burning.sample(index * VOXEL, fine=VOXEL)
    assert summary.active_voxels == len(found) > 500
    alike = np.isclose(values, found, rtol=2.0 * HALF, atol=1e-3).all(axis=1)
    assert alike.mean() > 0.95
    assert np.abs(values - found)[:, 0].mean() < 0.01 * found[:, 0].mean()
    assert 960.0 <= values[:, 2].min() < values[:, 2].max() <= 1400.0


@pytest.mark.parametrize("height", [1.8, 6.0, 18.0])
def test_voxels_radiate_the_power_of_the_field(tmp_path, height):
    """Radiance of all wavelengths along parallel rays through the voxels, against the march."""
    burning, voxel = front_of(height), height / 36.0
    write_flames(tmp_path / "flames.vdb", burning, voxel)
    grids = read(tmp_path / "flames.vdb")
    (dim, low), (kelvin, _) = grids["infrared"], grids["temperature"]
    kept = np.exp(-np.asarray(dim, np.float64) * voxel)
    before = np.cumprod(np.concatenate([np.ones_like(kept[:, :1]), kept[:, :-1]], axis=1), axis=1)
    power = 5.670374e-8 / np.pi * np.asarray(kelvin, np.float64) ** 4
    stored = (before * (1.0 - kept) * power).sum()
    east, up = np.meshgrid(*((low[k] + np.arange(dim.shape[k])) * voxel for k in (0, 2)), indexing="ij")
    origins = np.stack([east, np.full_like(east, low[1] * voxel - 5.0), up], axis=-1).reshape(-1, 3)
    ahead, far = np.tile((0.0, 1.0, 0.0), (len(origins), 1)), dim.shape[1] * voxel + 10.0
    ends = np.full(len(origins), far)
    marched = volume.march_infrared(
        [], origins, ahead, ends, radiance=EVERY, flames=burning, **PLANCK, **EMPTY
    )
    assert stored == pytest.approx(float(marched[:, 0].sum()), rel=0.1)


def test_no_flame_is_left_out(written):
    burning, _, index, _ = written
    low, high = (np.array(corner) for corner in ((2030, -4120, 596), (2066, -4076, 624)))
    every = np.stack(np.meshgrid(*map(np.arange, low, high), indexing="ij"), axis=-1).reshape(-1, 3)
    burns = burning.sample(every * VOXEL, fine=VOXEL)[:, 0] > 0.1
    missing = set(map(tuple, every[burns])) - set(map(tuple, index))
    assert burns.sum() > 200
    assert len(missing) < 0.01 * burns.sum()


def test_flames_fade_out_with_the_distance(tmp_path):
    near = write_flames(tmp_path / "near.vdb", front_of(fade=(36.0, 44.0)), VOXEL)
    full = write_flames(tmp_path / "full.vdb", front_of(), VOXEL)
    none = write_flames(tmp_path / "none.vdb", front_of(0.0), VOXEL)
    assert 0 < near.active_voxels < 0.85 * full.active_voxels
    assert none.active_voxels == 0


def test_voxels_of_no_size_are_refused(tmp_path):
    with pytest.raises(ValueError, match="voxel"):
        write_flames(tmp_path / "flames.vdb", front_of(), 0.0)
