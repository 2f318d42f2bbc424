"""Scene files of a story's shots: cameras see the subject of the shot, and edited files keep their camera."""

from dataclasses import replace

import numpy as np
import pytest
import whole_run
from firetwin.auto_framing import fire_views
from firetwin.errors import InputError
from firetwin.run import readers, times
from firetwin.run.frame import local_frame
from firetwin.shot import run_checks
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.cameras.rigs.chase import Chase
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.settings import Camera, scene_file
from firetwin.shot.shot import Shot
from firetwin.story import choose, quality, scenes, timeline, wipe
from firetwin.story.quality import QUALITIES
from firetwin.story.scenes import Scenes
from firetwin.story.storyboard import SCENE

QUALITY = replace(QUALITIES["draft"], resolution=(64, 36))
SCENE_FILE = 'run = "../run"\nlabels = { file = "../places.csv" }\n'

CHASE = Chase(distance=400.0, height=300.0)


@pytest.fixture
def story(tmp_path, monkeypatch):
    """Scenes of a run with a place, whose fitted cameras are a drone and a chase."""

    def fit(run, settings):
        over = Drone(keys=(CameraKey(0.0, 38.9, -120.62, 2000.0, "point", 38.9, -120.6),))
        near = Drone(keys=(CameraKey(0.0, 38.9, -120.601, 20.0, "point", 38.9, -120.6),))
        rigs = {"overview": over, "chase": CHASE, "flank": near}
        return replace(settings, cameras=tuple(Camera(name, rig=rig) for name, rig in rigs.items()))

    near = Drone(keys=(CameraKey(0.0, 38.9, -120.602, 30.0, "point", 38.9, -120.6),))
    view = fire_views.NearView(
        fire_views.KINDS[-1], fire_views.LIGHTS[0], 900.0, Camera("near", rig=near), 170.0
    )
    monkeypatch.setattr(fire_views, "find_near_view", lambda *_: view)
    monkeypatch.setattr(scenes, "_fit", fit)
    run = readers.open(whole_run.write(tmp_path / "run", cells=32))
    (tmp_path / "places.csv").write_text("name,latitude,longitude\nNear,38.9,-120.597\n")
    (tmp_path / "out").mkdir()
    scene = tmp_path / "out" / "scene.toml"
    scene.write_text(SCENE_FILE)
    board = choose.choose(run, tmp_path / "out" / "story.toml", scene, tmp_path / "places.csv")
    return Scenes(board, run, QUALITY), {span.shot.name: span for span in timeline.lay_out(board)}


def _view(settings, run):
    """Path of the camera of a scene file."""
    shot = Shot(settings, run)
    (camera,) = settings.cameras
    return camera.rig.path(camera, shot.filming, shot.bare_ground), shot


def test_each_shot_has_a_scene_file_with_its_times_camera_and_pass(story):
    shot_scenes, spans = story
    rendered = [span for span in spans.values() if span.shot.picture == SCENE]
    assert len(rendered) == 7
    for span in rendered:
        shot_scenes.write(span)
        settings = scene_file.read(shot_scenes.path(span.shot))
        run_checks.check(settings, shot_scenes.run)
        assert (settings.time.start, settings.time.end) == (span.shot.start, span.shot.end)
        assert settings.time.frames == QUALITY.pictures(span, 24) > 1
        assert [camera.name for camera in settings.cameras] == [span.shot.camera]
        assert settings.render.passes[0] == span.shot.render_pass
        assert (settings.render.resolution, settings.smoke.method) == ((64, 36), "preview")
        assert settings.smoke.enabled == span.shot.smoke


def test_the_flight_ends_at_the_first_view_of_the_next_shot(story):
    shot_scenes, spans = story
    flight, _ = _view(shot_scenes.write(spans["arrival"]), shot_scenes.run)
    flames, _ = _view(shot_scenes.write(spans["flames"]), shot_scenes.run)
    assert flight.position[-1] == pytest.approx(flames.position[0], abs=2.0)
    assert np.hypot(*(flight.position[0] - flames.position[0])[:2]) > 1000.0


def test_the_view_from_above_holds_all_burned_ground(story):
    shot_scenes, spans = story
    settings = shot_scenes.write(spans["scar"])
    (camera,) = settings.cameras
    view, shot = _view(settings, shot_scenes.run)
    row, column = np.nonzero(shot.arrival <= shot_scenes.run.times[-1])
    latitude, longitude = shot_scenes.run.fuel_latitude[row], shot_scenes.run.fuel_longitude[column]
    ground = local_frame(shot_scenes.run).forward(latitude, longitude, np.zeros(len(row)))[:, :2]
    half = 0.5 * camera.rig.swath * np.array([1.0, 36 / 64])
    inside = np.abs(ground - view.position[0, :2]) <= half
    assert inside.all()
    assert np.abs(ground - view.position[0, :2]).max(axis=0).max() > 0.5 * half.min()


def test_a_camera_at_a_place_looks_at_the_fire(story):
    shot_scenes, spans = story
    view, _ = _view(shot_scenes.write(spans["ground"]), shot_scenes.run)
    latitude, longitude, _ = local_frame(shot_scenes.run).reverse(view.position[:1])
    assert (latitude[0], longitude[0]) == pytest.approx((38.9, -120.597))
    away = replace(spans["ground"].shot, place="Nowhere")
    with pytest.raises(InputError, match=r'"Nowhere" is not a place of this run; choose one of Near'):
        shot_scenes.write(replace(spans["ground"], shot=replace(away, name="elsewhere")))


def test_an_edited_scene_file_keeps_its_camera_and_takes_new_times(story):
    shot_scenes, spans = story
    span = spans["scar"]
    shot_scenes.write(span)
    path = shot_scenes.path(span.shot)
    swath = scene_file.read(path).cameras[0].rig.swath
    path.write_text(path.read_text().replace(f"swath = {swath}", "swath = 12345.0  # mine"))
    moved = replace(span, shot=replace(span.shot, start=times.utc(shot_scenes.run, 60.0)))
    finer = Scenes(shot_scenes.story, shot_scenes.run, replace(QUALITY, samples=9))
    settings = finer.write(moved)
    assert settings == scene_file.read(path)
    assert "# mine" in path.read_text()
    assert (settings.cameras[0].rig.swath, settings.render.samples) == (12345.0, 9)
    assert settings.time.start == moved.shot.start


def test_another_camera_in_the_storyboard_is_fitted(story):
    shot_scenes, spans = story
    span = spans["active"]
    shot_scenes.write(span)
    path = shot_scenes.path(span.shot)
    other = replace(span, shot=replace(span.shot, camera="overview"))
    assert [camera.name for camera in shot_scenes.write(other).cameras] == ["overview"]
    path.write_text(path.read_text().replace("focal_length = 28.0", "focal_length = 50.0"))
    assert shot_scenes.write(other).cameras[0].rig.focal_length == 50.0
    again = replace(shot_scenes, fit_again=True)
    assert again.write(other).cameras[0].rig.focal_length == 28.0


@pytest.mark.parametrize("link", [False, True])
def test_a_file_of_another_camera_is_not_lost(story, link):
    shot_scenes, spans = story
    span = spans["active"]
    path, mine = shot_scenes.path(span.shot), shot_scenes.path(span.shot).parents[1] / "mine.toml"
    path.parent.mkdir()
    mine.write_text(SCENE_FILE)
    if link:
        path.symlink_to(mine)
    else:
        mine.rename(path)
    with pytest.raises(InputError, match="rename or delete it"):
        shot_scenes.write(span)
    assert path.read_text() == SCENE_FILE
    replace(shot_scenes, fit_again=True).write(span)
    assert [camera.name for camera in scene_file.read(path).cameras] == [span.shot.camera]
    assert not link or mine.read_text() == SCENE_FILE


def test_unknown_cameras_are_explained(story):
    shot_scenes, spans = story
    shot = replace(spans["active"].shot, camera="crane", name="other")
    with pytest.raises(
        InputError, match=r'camera "crane" of other is unknown; choose one of overview, chase'
    ):
        shot_scenes.write(replace(spans["active"], shot=shot))


@pytest.mark.parametrize(("height", "kind"), [(0.5, "drone"), (50.0, "chase")])
def test_the_front_is_filmed_from_afar_if_its_flames_are_low_in_the_chase(story, monkeypatch, height, kind):
    shot_scenes, spans = story
    scenes._front.cache_clear()
    monkeypatch.setattr(
        scenes.flame_map, "cell_lengths", lambda front, formula: np.full(front.ground.shape, height)
    )
    (camera,) = shot_scenes.write(spans["active"]).cameras
    assert (camera.name, camera.kind) == ("front", kind)


def test_a_line_moves_from_the_colour_picture_to_the_infrared_one():
    colour, infrared = np.full((9, 64, 3), 0.2, np.float32), np.full((9, 64, 3), 0.7, np.float32)
    shares = []
    for part in (0.0, 0.25, 0.5, 1.0):
        picture = wipe.join(colour, infrared, part)
        (line,) = np.flatnonzero(picture[4, :, 0] == 1.0)
        assert (picture[:, :line] == colour[:, :line]).all()
        assert (picture[:, line + 1 :] == infrared[:, line + 1 :]).all()
        shares.append(line / 64)
    assert shares == pytest.approx([0.92, 0.79, 0.5, 0.08], abs=0.02)


def test_each_frame_shows_the_nearest_of_its_pictures(story):
    _, spans = story
    span = spans["growth"]
    count = QUALITY.pictures(span, 24)
    shown = [quality.picture_of(span, count, frame) for frame in range(span.first, span.end)]
    assert (shown[0], shown[-1], len({*shown})) == (1, count, count) == (1, 240, 240)
    assert QUALITIES["final"].pictures(span, 24) == span.length
