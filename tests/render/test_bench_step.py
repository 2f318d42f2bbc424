"""The benchmark of steps through smoke draws what it compares."""

import numpy as np
from firetwin.bench import step
from firetwin_core import sensor


def test_longer_steps_are_further_from_the_finest(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(step, "RESOLUTION", (48, 27))
    monkeypatch.setattr(step, "SAMPLES", 2)
    told = []
    seconds = step.render_in_blender(  # called as the worker process calls it
        folder=str(tmp_path), times=2, progress=lambda *what: told.append(what), tell=print
    )
    assert told == [(0, 2), (1, 2)]
    assert seconds.keys() == step.STEPS.keys()
    assert all(len(times) == 2 and min(times) > 0.0 for times in seconds.values())
    pictures = {
        name: np.asarray(sensor.read_image(step.picture(tmp_path, name)))[..., :3].astype(float)
        for name in seconds
    }
    assert np.ptp(pictures[step.OURS]) > 0.1 * pictures[step.OURS].max()
    off = {name: np.abs(image - pictures[step.FINEST]).mean() for name, image in pictures.items()}
    assert 0.0 == off[step.FINEST] < off["half the step"] < off[step.OURS] < off["4 times the step"]
    assert not np.array_equal(pictures[step.OTHER_GRAIN], pictures[step.OURS])
