"""Clock of flames: real time in slow films, even steps that an eye can follow in quick ones."""

import numpy as np
import pytest
from firetwin.shot.fire import flame_clock
from firetwin.shot.frames import Frames


@pytest.mark.parametrize(("step", "shown"), [(0.04, 0.04), (0.25, 0.25), (1.25, 0.25), (30.0, 0.25)])
def test_the_pattern_moves_by_at_most_a_quarter_of_a_second_in_a_frame(step, shown):
    frames = Frames(100.0, 100.0 + 9 * step, 10)
    times = np.array([flame_clock.time(frames, moment) for moment in frames.times])
    assert np.diff(times) == pytest.approx([shown] * 9)
    assert times[0] == 100.0


def test_a_still_shows_its_moment():
    assert flame_clock.time(Frames(7.0, 7.0, 1), 7.0) == 7.0
