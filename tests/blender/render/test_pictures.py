"""The queue of frames: lifetime of a frame's data, and messages."""

import weakref

import pytest
from firetwin import memory
from firetwin.imaging.credits import Credits
from firetwin.progress import no_message
from firetwin.render import engine, integrated, pictures
from firetwin.render.picture import Picture
from firetwin.render.sharing import open_session
from firetwin.shot import passes

PASSES = ("depth", "rgb")


class Smoke(list):
    """Bricks that a test can see the end of."""


@pytest.fixture
def film(shot, stage, tmp_path, monkeypatch):
    """Make frames that no engine draws: film(count) -> (what happened in order, progress)."""
    events, told, alive = [], [], []

    class Frame:
        draw_layers, words = None, Credits()

        def __init__(self, shot, stage, session, part, camera, frame):
            self.camera, self.frame = camera, frame
            self.held = alive[-1]()  # as what draws it holds it

        def render(self, names):
            events.append(f"render {self.frame}")
            return [Picture(self.camera, self.frame, name) for name in names]

    def ready(frame, ahead):
        assert not [each for each in alive if each() is not None], "smoke of the frame before is still held"
        smoke = Smoke()
        alive.append(weakref.ref(smoke))
        events.append(f"smoke {frame}")
        return smoke

    monkeypatch.setattr(pictures, "_Frame", Frame)
    monkeypatch.setattr(pictures, "publish", lambda *_: None)
    monkeypatch.setattr(integrated, "applies", lambda *_: False)
    monkeypatch.setattr(memory, "release_freed", lambda: events.append("give back"))

    def make(count, tell=no_message):
        wanted = [Picture("drone", frame, name) for frame in range(1, count + 1) for name in PASSES]
        with open_session(tmp_path, {("drone", name): {"pass": name} for name in passes.known()}) as here:
            made = pictures.render(shot, stage, here, wanted, lambda *how: told.append(how), ready, tell)
        assert made == count
        return events, told

    return make


def test_nothing_of_a_frame_stays_in_memory(film):
    events, _ = film(2)
    assert events == [
        *("smoke 1", "give back", "render 1", "give back"),
        *("smoke 2", "give back", "render 2", "give back"),
    ]


def test_the_note_is_the_picture_that_people_look_at(film):
    _, told = film(2)
    assert told == [
        (0, 2, "rendering", ""),
        (1, 2, "rendering", "drone/rgb/drone_rgb_000001.png"),
        (2, 2, "rendering", "drone/rgb/drone_rgb_000002.png"),
    ]


def test_the_exposure_of_the_blender_scene_is_told(film, monkeypatch):
    stops, said = iter((3.96, 3.96, 4.2, 4.2)), []
    monkeypatch.setattr(engine, "exposure", lambda scene: next(stops))
    film(2, said.append)
    assert [each for each in said if "exposed" in each] == [
        "drone is exposed by 4.0 stops",
        "drone is exposed by 4.0 to 4.2 stops",
    ]


def test_data_alone_is_noted_too():
    assert pictures._preview([Picture("drone", 3, "depth")]) == "drone/depth/drone_depth_000003.exr"
