"""Cost of frames by part."""

import pytest
from firetwin.render import frame_cost


@pytest.fixture
def clock(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(frame_cost.time, "process_time", lambda: now[0])
    monkeypatch.setattr(frame_cost.time, "perf_counter", lambda: 0.5 * now[0])
    monkeypatch.setattr(frame_cost.os, "cpu_count", lambda: 4)
    return now


def spend(cost, clock, smoke, surfaces, rest):
    with cost.part(frame_cost.FRAME):
        with cost.part(frame_cost.SMOKE):
            clock[0] += smoke
        with cost.part(frame_cost.SURFACES):
            clock[0] += surfaces
        clock[0] += rest


def test_parts_and_the_rest_add_up_to_the_frame(clock):
    cost = frame_cost.FrameCost()
    assert cost.sentence() == ""
    spend(cost, clock, 2.0, 30.0, 1.5)
    parts = "smoke 2.0, surfaces in Cycles 30, the rest 1.5"
    assert cost.sentence() == f"the first frame took 17 s, of processor time 34 s, 50% of 4 cores ({parts})"


def test_the_report_is_the_mean_of_the_frames_after_the_first(clock):
    cost = frame_cost.FrameCost()
    spend(cost, clock, 20.0, 50.0, 7.5)
    spend(cost, clock, 2.0, 30.0, 1.5)
    parts = "smoke 2.0, surfaces in Cycles 30, the rest 1.5"
    assert (
        cost.sentence() == f"mean of 1 further frame: 17 s, of processor time 34 s, 50% of 4 cores ({parts})"
    )
    spend(cost, clock, 4.0, 10.0, 2.5)
    parts = "smoke 3.0, surfaces in Cycles 20, the rest 2.0"
    assert (
        cost.sentence() == f"mean of 2 further frames: 12 s, of processor time 25 s, 50% of 4 cores ({parts})"
    )
