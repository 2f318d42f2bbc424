"""Frames that worker threads read while the ones before are used."""

import gc
import threading

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening as runs
from small_run import small_fields


@pytest.fixture(params=["npy", "text"])
def run(request, make_run):
    return runs.open(make_run(request.param))


@pytest.mark.parametrize("ahead", [1, 2, 3, 100])
@pytest.mark.parametrize("field", ["heat_flux", "temperature", "wind_east", "wind_north"])
def test_all_frames_in_order(run, field, ahead):
    frames = list(run.frames(field, ahead=ahead))
    np.testing.assert_array_equal(frames, small_fields()[field])


def test_chosen_frames(run):
    flux = small_fields()["heat_flux"]
    np.testing.assert_array_equal(list(run.frames(indices=[2, 0, 2, 1], ahead=2)), flux[[2, 0, 2, 1]])
    assert list(run.frames(indices=np.array([], int))) == []


def test_ended_iterators_stay_ended_and_keep_their_run(make_run):
    frames = runs.open(make_run()).frames()
    gc.collect()
    assert len(list(frames)) == 3
    assert list(frames) == []


@pytest.mark.parametrize("ahead", [1, 2, 8])
def test_threads_may_share_one_iterator(make_run, ahead):
    """Each frame goes to one of them, and all of them come to the end."""
    flux = np.arange(300 * 20, dtype=np.float32).reshape(300, 4, 5)
    run = runs.open(make_run(heat_flux=flux, temperature=None, wind_east=None, wind_north=None))
    for _ in range(10):
        frames = run.frames(ahead=ahead)
        parts = [[] for _ in range(4)]
        threads = [threading.Thread(target=part.extend, args=(frames,), daemon=True) for part in parts]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(30.0)
            assert not thread.is_alive()
        taken = np.array([frame[0, 0] for part in parts for frame in part])
        assert np.array_equal(np.sort(taken), flux[:, 0, 0])
        assert all(np.all(np.diff([frame[0, 0] for frame in part]) > 0) for part in parts)


def test_an_unused_iterator_goes_without_waiting(run):
    frames = run.frames(ahead=1)
    next(frames)
    del frames
    gc.collect()


def test_a_bad_frame_is_an_error_in_its_turn(make_run):
    folder = make_run("text")
    run = runs.open(folder)
    (folder / "heat_flux" / "000001.txt").write_text("1 2 x")
    frames = run.frames(ahead=3)
    next(frames)
    with pytest.raises(core.InputError, match="'x' is not a number"):
        next(frames)
    np.testing.assert_array_equal(next(frames), small_fields()["heat_flux"][2])


def test_wrong_arguments(run, make_run):
    with pytest.raises(ValueError, match="no series is called 'flux'"):
        run.frames("flux")
    with pytest.raises(ValueError, match="ahead"):
        run.frames(ahead=0)
    with pytest.raises(ValueError, match="indices must contain integers, not float64"):
        run.frames(indices=[0.0, 1.5])
    with pytest.raises(ValueError, match="indices contains an integer out of range for int64"):
        run.frames(indices=np.array([2**64 - 1], np.uint64))
    assert list(run.frames(indices=[])) == []
    for index in (-1, 3):
        with pytest.raises(IndexError):
            run.frames(indices=[index])
