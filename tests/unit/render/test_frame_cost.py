"""Cost of frames by part."""

import pytest
from firetwin.render import frame_cost


@pytest.fixture
def clock(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(frame_cost.time, "perf_counter", lambda: now[0])
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
    assert cost.sentence() == "the first frame took 34 s (smoke 2.0, surfaces in Cycles 30, the rest 1.5)"


def test_the_report_is_the_mean_of_the_frames(clock):
    cost = frame_cost.FrameCost()
    spend(cost, clock, 2.0, 30.0, 1.5)
    spend(cost, clock, 4.0, 10.0, 2.5)
    assert cost.sentence() == "mean of 2 frames: 25 s (smoke 3.0, surfaces in Cycles 20, the rest 2.0)"
