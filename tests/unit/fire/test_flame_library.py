"""Blocks of solved flames: how files are packed and read."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from firetwin.data.flames import pack
from firetwin.errors import InputError
from firetwin.shot.fire import flame_library

SETTINGS = {
    "cells": 16,
    "nx": 24,
    "ny": 16,
    "nz": 20,
    "front": 0.8,
    "depth": 0.3,
    "interval": 0.09,
    "wind": 0.5,
}


def solved(height: float = 0.6) -> pack.Solved:
    """Return frames of an upright flame `height` units high over the whole base."""
    shape = (10, SETTINGS["nz"], SETTINGS["ny"], SETTINGS["nx"])
    z, x = (np.arange(shape[1]) + 0.5) / 16, (np.arange(shape[3]) + 0.5) / 16
    inside = (z[:, None] < height) & (np.abs(x - 0.65) < 0.15)
    codes = np.broadcast_to(np.where(inside, 180, 0)[:, None], shape).astype(np.uint8)
    levels = np.linspace(0.5, 1.0, shape[1], dtype=np.float32)
    return pack.Solved(codes, 0.1, levels, 0.0, SETTINGS)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    pack.save(tmp_path / "calm_1.npz", solved())
    return tmp_path / "calm_1.npz"


def test_a_packed_flame_is_one_long_and_keeps_its_place(path):
    length = pack.flame_length(solved())
    block = flame_library.read(path)
    tips = pack.find_tips(block.codes, block.cell, block.front - 0.15 / length, False)
    assert tips.median(tips.length) == pytest.approx(1.0, abs=0.01)
    assert block.cell == pytest.approx(1 / (16 * length))
    burning = np.flatnonzero(block.codes.any(axis=(0, 1, 2)))
    assert (burning[-1] + 1) * block.cell == pytest.approx(block.front, abs=block.cell)
    assert (block.interval, block.wind) == pytest.approx((0.09 / length**0.5, 0.5 / length**0.5))
    assert block.fade == 2


def test_gaps_in_a_line_do_not_count():
    flame = solved()
    codes = flame.codes.copy()
    codes[:, :, :10] = 0
    assert pack.flame_length(dataclasses.replace(flame, codes=codes)) == pack.flame_length(flame)


def test_the_temperature_on_the_axis_is_that_of_stoichiometric_gas():
    flame = solved()
    codes = np.where(flame.codes > 0, 127, 0).astype(np.uint8)  # mixture 0.99
    excess = pack.mean_excess(dataclasses.replace(flame, codes=codes))
    assert excess[0] == pytest.approx(3.2 * 0.992 * (1 - 0.35 / 32 / 1.2), rel=1e-3)
    assert (excess[10:] == 0).all()


def test_lean_gas_away_from_flames_is_softened_and_flames_are_not():
    flame = solved()
    codes = flame.codes.copy()
    codes[:, 15, 8, 4] = 100  # mixture 0.6, alone
    soft = pack._soften_dissolving(codes)
    assert soft[0, 15, 8, 4] == pytest.approx(100 / 8)
    assert (soft[0, :8, :, 8:12] == codes[0, :8, :, 8:12]).all()


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        ({"codes": np.zeros((4, 3, 6, 5), np.uint8)}, "codes are uint8 of shape"),
        ({"codes": np.zeros((4, 3, 8, 5), np.int16)}, "codes are int16"),
        ({"rise": np.zeros(2, np.float32)}, "rise is float32 of shape"),
        ({"cell": np.float64(np.nan)}, "cell nan"),
        ({"fade": np.int64(10)}, "10 of 10 frames fade"),
        ({"crown": np.array(["a"], dtype=object)}, "allow_pickle"),
    ],
)
def test_a_damaged_block_is_refused_with_its_name(path, damage, reason):
    with np.load(path) as stored:
        fields = {name: stored[name] for name in stored.files}
    np.savez_compressed(path, **fields | damage)
    with pytest.raises(InputError, match="not a block of flames") as error:
        flame_library.read(path)
    assert reason in str(error.value)
    assert str(path) in str(error.value)


def test_a_cut_off_or_missing_block_is_refused(path):
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(InputError, match="not a block of flames"):
        flame_library.read(path)
    path.unlink()
    with pytest.raises(InputError, match="cannot be read"):
        flame_library.read(path)


def test_a_block_that_is_too_large_is_not_unpacked(path, monkeypatch):
    monkeypatch.setattr(flame_library, "_LARGEST", 1000)
    with pytest.raises(InputError, match="more than 1000"):
        flame_library.read(path)
