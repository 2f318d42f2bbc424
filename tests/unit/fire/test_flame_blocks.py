"""The blocks of solved flames that are shipped."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from firetwin.data.flames import FOLDER, pack
from firetwin.shot.fire import flame_library

SHIPPED = [(kind, seed) for kind in flame_library.KINDS for seed in flame_library.SEEDS]


def test_shipped_blocks_have_less_than_20_megabytes():
    assert sum(path.stat().st_size for path in Path(FOLDER).glob("*.npz")) <= 20e6


@pytest.mark.parametrize(("kind", "seed"), SHIPPED)
def test_a_shipped_flame_is_one_long(kind, seed):
    block = flame_library.load(kind, seed)
    with np.load(Path(FOLDER) / f"{kind}_{seed}.npz") as stored:
        base = block.front - 0.5 * float(stored["depth"])
    crown = kind == "crown"
    tips = pack.find_tips(block.codes, block.cell, base, crown)
    assert tips.median(tips.length) == pytest.approx(1.0, abs=0.05)
    assert block.wind == pytest.approx({"breeze": 0.4, "wind": 1.0}.get(kind, 0.0), abs=0.1)
    assert (block.crown[1] > block.crown[0] > 0) == crown


@pytest.mark.parametrize(("kind", "seed"), SHIPPED)
def test_a_shipped_loop_has_no_jump(kind, seed):
    """Where the last frames blend into the first ones, the burning volume changes as between other frames."""
    block = flame_library.load(kind, seed)
    volume = (block.codes > 127).sum(axis=(1, 2, 3)).astype(float)
    weight = (np.arange(block.fade) + 0.5) / block.fade
    faded = (1 - weight) * volume[-block.fade :] + weight * volume[: block.fade]
    loop = np.concatenate([volume[block.fade : -block.fade], faded, volume[block.fade : block.fade + 1]])
    steps = np.abs(np.diff(loop)) / volume.mean()
    assert steps[-block.fade - 1 :].max() < 0.15


def test_blocks_of_two_seeds_differ_and_cannot_be_changed():
    first, second = (flame_library.load("calm", seed) for seed in flame_library.SEEDS)
    assert first.codes.shape != second.codes.shape or (first.codes != second.codes).any()
    with pytest.raises(ValueError, match="read-only"):
        first.codes[0] = 0
    with pytest.raises(dataclasses.FrozenInstanceError):
        first.cell = 1.0
