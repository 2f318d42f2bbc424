"""The solver of the library of flames, on a tiny box."""

import functools
import shutil

import numpy as np
import pytest
from firetwin.data.flames import pack, solve

TINY = {"cells": 14, "nx": 24, "ny": 16, "nz": 24, "frames": 2, "spin": 1.2}


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    if not (shutil.which("g++") or shutil.which("clang++")):
        pytest.skip("no compiler")
    try:
        return solve.compile_solver(tmp_path_factory.mktemp("solver"), optimise="-O1")
    except solve.subprocess.CalledProcessError:
        pytest.skip("no FFTW of single precision")


@pytest.fixture(scope="module")
def solve_again(program, tmp_path_factory):
    def solved(kind: str, seed: int = 1, **changed) -> pack.Solved:
        settings = solve.settings_of(kind, seed, 14, 2) | TINY | changed
        return solve.run(program, settings, tmp_path_factory.mktemp("frames"))

    return solved


@pytest.fixture(scope="module")
def run(solve_again):
    """Run the solver once for equal settings."""
    return functools.cache(solve_again)


def test_equal_settings_give_equal_bytes_and_another_seed_does_not(run, solve_again):
    first, again, other = run("calm"), solve_again("calm"), run("calm", seed=2)
    assert (first.codes == again.codes).all()
    assert (first.rise == again.rise).all()
    assert (first.codes != other.codes).any()


@pytest.mark.parametrize("kind", ["calm", "wind", "crown"])
def test_the_divergence_is_that_of_the_expanding_gas(run, kind):
    flame = run(kind)
    assert flame.divergence < 1e-5  # rounding of float32; expansion is up to 0.4 per cell


def test_a_flame_leans_with_the_wind_and_rises_without(run):
    def lean(flame):
        mixture = pack.mixture(flame.codes).mean(axis=(0, 2))[6]
        return mixture @ np.arange(len(mixture)) / mixture.sum()

    assert lean(run("breeze", front=0.85)) > lean(run("calm", front=0.85)) + 1.0
    assert run("calm").rise[:8].max() > 0.3


def test_more_fuel_gives_more_heat(run):
    assert run("calm", inflow=0.1, spin=4.0).heat > 1.2 * run("calm", inflow=0.05, spin=4.0).heat > 0


def test_an_unknown_setting_is_refused(program, tmp_path):
    answer = solve.subprocess.run(
        [program, f"out={tmp_path / 'a'}", "nonsense=3"], capture_output=True, text=True
    )
    assert answer.returncode == 1
    assert "nonsense=3: not a setting" in answer.stderr
