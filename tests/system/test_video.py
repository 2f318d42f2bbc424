"""Films: their frames, colours, captions and when they are made again."""

import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from firetwin.render import films, picture, video
from firetwin.render.picture import Picture
from firetwin.render.sharing import open_session
from firetwin.render.store import Store, describe
from firetwin.shot.shot import Shot
from firetwin_core import sensor

MADE_WITH = {("drone", "rgb"): {"samples": 1}}
SIZE = (96, 160)  # rows and columns
PLAIN = (slice(8, 60), slice(8, 152))  # clear of the captions


@pytest.fixture
def filmed(settings, run, tmp_path):
    """A shot of three finished pictures with coloured squares, and its output folder."""
    out = tmp_path / "out"
    render = replace(settings.render, resolution=SIZE[::-1], passes=("rgb",))
    time = replace(settings.time, fps=12, zone="America/Los_Angeles")
    changed = replace(settings, render=render, time=time)
    entries = {}
    for frame in (1, 2, 3):
        name = Picture("drone", frame, "rgb").file("png")
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        sensor.write_image(out / name, _picture(frame))
        entries |= _entry(out, frame)
    _enter(out, MADE_WITH["drone", "rgb"], entries)
    return Shot(changed, run), out


def _enter(out, settings, entries):
    with Store(out, create=True) as store:
        store.add(settings, entries)


def _entry(out, frame):
    name = Picture("drone", frame, "rgb").file("png")
    return {name: describe(out / name) | {"camera": "drone", "pass": "rgb", "frame": frame}}


def _missing(shot, out, made_with):
    with Store(out) as store:
        return list(films.missing(shot, store, made_with))


def _make(shot, out, made_with):
    with open_session(out, made_with) as here:
        video.make(shot, here)


def _picture(frame):
    """Large patches, the colours of smoke, sky, forest and flame, brighter from frame to frame."""
    colours = np.array([[0.62, 0.56, 0.5], [0.45, 0.6, 0.8], [0.1, 0.16, 0.08], [0.95, 0.5, 0.15]])
    picture = np.repeat(np.repeat(colours[[[0, 1], [2, 3]]], SIZE[0] // 2, 0), SIZE[1] // 2, 1)
    return (picture * (0.85 + 0.05 * frame)).astype(np.float32)


def _decode(path, tmp_path):
    """Frames of a film as floats 0..1, decoded by ffmpeg."""
    if not shutil.which("ffmpeg"):
        pytest.skip("needs ffmpeg")
    for left in tmp_path.glob("decoded_*.png"):
        left.unlink()
    command = ["ffmpeg", "-v", "error", "-i", path, "-fps_mode", "passthrough", tmp_path / "decoded_%03d.png"]
    subprocess.run(command, check=True)
    return [np.asarray(sensor.read_image(p))[..., :3] for p in sorted(tmp_path.glob("decoded_*.png"))]


def _probe(path, what):
    """Fields of a film's video stream, as ffprobe prints them, such as ``stream=width,height``."""
    if not shutil.which("ffprobe"):
        pytest.skip("needs ffprobe, which is a part of ffmpeg")
    command = ["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", what]
    result = subprocess.run([*command, "-of", "csv=p=0", path], check=True, capture_output=True, text=True)
    return result.stdout.strip()


@pytest.fixture
def film(filmed):
    shot, out = filmed
    _make(shot, out, MADE_WITH)
    return out / picture.film("drone", "rgb")


def test_a_film_has_the_frames_size_and_rate_of_its_scene(film):
    what = "stream=codec_name,width,height,sample_aspect_ratio,pix_fmt,r_frame_rate"
    assert _probe(film, what) == "h264,160,96,1:1,yuv420p,12/1"


def test_its_colours_are_those_of_the_pictures(film, tmp_path):
    decoded = _decode(film, tmp_path)
    assert len(decoded) == 3
    for frame, shown in enumerate(decoded, start=1):
        difference = np.abs(shown - _picture(frame))[PLAIN] * 255
        assert difference.mean() < 2.0
        assert np.percentile(difference, 95) < 5.0


def test_the_model_time_is_burnt_into_each_frame(film, tmp_path):
    decoded = _decode(film, tmp_path)
    captions = [frame[76:, :80] - _picture(i)[76:, :80] for i, frame in enumerate(decoded, start=1)]
    for caption in captions:
        assert caption.max() > 0.4  # white letters
    # 14:00, 14:30 and 15:00 PDT differ from each other far more than coding noise does.
    for a, b in ((0, 1), (1, 2), (0, 2)):
        assert np.abs(captions[a] - captions[b]).max() > 0.3
    synthetic = [frame[80:, 100:] - _picture(i)[80:, 100:] for i, frame in enumerate(decoded, start=1)]
    assert all(np.abs(note).max() > 0.3 for note in synthetic)
    assert np.abs(synthetic[0] - synthetic[2]).mean() < 0.03


def test_a_film_is_made_again_only_when_it_must_be(filmed, film):
    shot, out = filmed
    written = film.stat().st_mtime_ns
    assert _missing(shot, out, MADE_WITH) == []
    _make(shot, out, MADE_WITH)
    assert film.stat().st_mtime_ns == written
    settings = shot.settings
    for other in (
        replace(settings, time=replace(settings.time, fps=24)),
        replace(settings, time=replace(settings.time, zone="UTC")),
    ):
        assert [f[:2] for f in _missing(Shot(other, shot.run), out, MADE_WITH)] == [("drone", "rgb")]
    silent = replace(settings, render=replace(settings.render, video=False))
    assert _missing(Shot(silent, shot.run), out, MADE_WITH) == []
    name = Picture("drone", 2, "rgb").file("png")
    sensor.write_image(out / name, _picture(5))
    _enter(out, MADE_WITH["drone", "rgb"], _entry(out, 2))
    assert [f[:2] for f in _missing(shot, out, MADE_WITH)] == [("drone", "rgb")]
    film.write_bytes(film.read_bytes()[:-1])
    _make(shot, out, MADE_WITH)
    assert _missing(shot, out, MADE_WITH) == []


def test_a_slate_precedes_a_review_film(filmed, tmp_path):
    """The first picture keeps its timecode, and a clean film has no slate."""
    shot, out = filmed
    settings = shot.settings
    render = replace(settings.render, film="both", slate="King Fire v003")
    _make(Shot(replace(settings, render=render), shot.run), out, MADE_WITH)
    review, clean = out / "drone/drone_rgb.mp4", out / "drone/drone_rgb_clean.mp4"
    assert _probe(review, "stream_tags=timecode") == "00:59:59:11"
    assert _probe(clean, "stream_tags=timecode") == "01:00:00:00"
    assert len(_decode(clean, tmp_path)) == 3
    slate, *pictures = _decode(review, tmp_path)
    assert len(pictures) == 3
    assert np.median(slate) < 0.2
    assert slate.max() > 0.6  # letters
    for frame, shown in enumerate(pictures, start=1):
        assert (np.abs(shown - _picture(frame))[PLAIN] * 255).mean() < 2.0
    assert _missing(shot, out, MADE_WITH)[0][2].get("slate") is None  # without a slate: again
    with Store(out) as store:
        ((path, reasons),) = films.changes_of(shot, store, MADE_WITH)
        assert (path, reasons) == ("drone/drone_rgb.mp4", ["had a slate"])
        assert films.left_over(shot, store, MADE_WITH) == ["drone/drone_rgb_clean.mp4"]


def test_one_picture_makes_no_film(filmed):
    shot, out = filmed
    settings = shot.settings
    alone = replace(settings, cameras=(replace(settings.cameras[0], frames="2"),))
    assert _missing(Shot(alone, shot.run), out, MADE_WITH) == []


def test_pictures_made_with_other_settings_stay_out_of_a_film(filmed):
    shot, out = filmed
    _enter(out, {"samples": 2}, _entry(out, 2))
    ((_, _, film),) = _missing(shot, out, MADE_WITH)
    assert [frame for frame, _ in film["frames"]] == [1, 3]


def test_a_picture_that_was_deleted_leaves_no_hole(filmed, film, tmp_path):
    shot, out = filmed
    (out / Picture("drone", 2, "rgb").file("png")).unlink()
    _make(shot, out, MADE_WITH)
    decoded = _decode(film, tmp_path)
    assert len(decoded) == 2
    for frame, shown in zip((1, 3), decoded, strict=True):
        assert (np.abs(shown - _picture(frame))[PLAIN] * 255).mean() < 2.0


@pytest.mark.parametrize(
    ("codec", "end", "probed"),
    [
        ("h265", "mp4", "hevc,yuv420p10le,tv,bt709,bt709,bt709,30000/1001,3"),
        ("prores", "mov", "prores,yuv422p10le,tv,bt709,bt709,bt709,30000/1001,3"),
    ],
)
def test_clean_films_have_no_captions_but_timecode_and_colour_tags(filmed, tmp_path, codec, end, probed):
    shot, out = filmed
    settings = shot.settings
    render = replace(settings.render, film="both", film_codec=codec)
    _make(
        Shot(replace(settings, render=render, time=replace(settings.time, fps=29.97)), shot.run),
        out,
        MADE_WITH,
    )
    assert (out / "drone/drone_rgb.mp4").exists()  # for browsers
    path = out / f"drone/drone_rgb_clean.{end}"
    what = "stream=codec_name,pix_fmt,color_range,color_space,color_transfer,color_primaries"
    assert _probe(path, f"{what},r_frame_rate,nb_frames") == probed
    for film in (path, out / "drone/drone_rgb.mp4"):
        assert _probe(film, "stream_tags=timecode") == "01:00:00;00"
    for frame, shown in enumerate(_decode(path, tmp_path), start=1):
        assert (np.abs(shown - _picture(frame)) * 255).mean() < 2.0  # where captions would be, too
