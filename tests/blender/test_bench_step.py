"""The benchmark of steps through smoke draws what it compares."""

import numpy as np
from firetwin.bench import step
from firetwin_core import sensor


def test_longer_steps_are_further_from_the_finest(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(step, "RESOLUTION", (48, 27))
    monkeypatch.setattr(step, "SAMPLES", 2)
    seconds = step.render_in_blender(str(tmp_path), 1)
    assert seconds.keys() == step.STEPS.keys()
    assert min(seconds.values()) > 0.0
    pictures = {
        name: np.asarray(sensor.read_image(step.picture(tmp_path, name)))[..., :3].astype(float)
        for name in seconds
    }
    assert np.ptp(pictures[step.OURS]) > 0.1 * pictures[step.OURS].max()
    off = {name: np.abs(image - pictures[step.FINEST]).mean() for name, image in pictures.items()}
    assert 0.0 == off[step.FINEST] < off["half the step"] < off[step.OURS] < off["4 times the step"]
    assert not np.array_equal(pictures[step.OTHER_GRAIN], pictures[step.OURS])
