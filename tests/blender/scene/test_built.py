"""Facts about a built scene, stored with it."""

import json

import numpy as np
import pytest
from firetwin.scene import built
from firetwin.shot.stations import station_signs


def test_facts_are_those_of_the_shot(shot, stage):
    text = built.landmarks_text(station_signs.find_moving_points(shot))
    built.store(stage, built.gather(shot, text))
    facts = built.read(stage)
    assert facts.first_time == "2014-09-17T21:00:00+00:00"
    assert (facts.seconds_per_frame, facts.frames, facts.zone) == (1800.0, 3, shot.settings.time.zone)
    assert facts.extent == pytest.approx(0.08 * 111_000.0, rel=0.05)  # north to south
    assert facts.height == pytest.approx(float(np.nanmean(shot.run.elevation)))
    found = json.loads(facts.landmarks)
    assert found["frames"] == [1, 2, 3]
    np.testing.assert_allclose(found["head"], station_signs.find_moving_points(shot).head, atol=0.051)


def test_facts_of_other_versions_are_read_as_far_as_they_are_known(shot, stage):
    assert built.read(stage) is None
    facts = built.gather(shot, "")
    built.store(stage, facts)
    stage.root["firetwin_facts"]["later"] = 1
    assert built.read(stage) == facts
    built.clear(stage)
    built.clear(stage)
    assert built.read(stage) is None
