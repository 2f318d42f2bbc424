"""Times in EXR headers are rewritten without rendering, as if the file had been written with them."""

from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.render import exr_clock
from firetwin.render.picture import Picture
from firetwin.render.store import Store, describe
from firetwin.shot import exr_tags
from firetwin_core import sensor

FIRST = Picture("drone", 1, "comp")
MADE_WITH = {("drone", "comp"): {"samples": 6}}


def write(path, fps, date="2014:09:17 16:12:00", **storage):
    pixels = np.random.default_rng(1).random((37, 5, 4), np.float32)
    about = {"cameraLabel": "drone", "capDate": date, "utcOffset": 25200.0, "worldToCamera": np.eye(4)}
    sensor.write_image(path, pixels, about | exr_tags.film_time(Fraction(fps), 30), list("RGBA"), **storage)


@pytest.mark.parametrize("storage", [{}, {"half": True, "one_line": True}])
@pytest.mark.parametrize("fps", ["24000/1001", "30", "60", "120"])
def test_the_file_is_the_one_that_a_render_writes(tmp_path, fps, storage):
    changed, fresh = tmp_path / "a.exr", tmp_path / "b.exr"
    times = {"capDate": "2014:09:18 01:12:00", "utcOffset": 25200.0}
    write(changed, "24", **storage)
    write(fresh, fps, times["capDate"], **storage)
    exr_clock.rewrite(changed, times | exr_tags.film_time(Fraction(fps), 30))
    assert changed.read_bytes() == fresh.read_bytes()
    write(changed, "24", **storage)
    exr_clock.rewrite(
        fresh, {"capDate": "2014:09:17 16:12:00", "utcOffset": 25200.0} | exr_tags.film_time(Fraction(24), 30)
    )
    assert changed.read_bytes() == fresh.read_bytes()


@pytest.fixture
def store(tmp_path):
    """A store with one finished picture at 24 frames per second."""
    (path,) = FIRST.files()
    (tmp_path / path).parent.mkdir(parents=True)
    write(tmp_path / path, "24")
    with Store(tmp_path, create=True) as made:
        entry = {"camera": "drone", "pass": "comp", "frame": 1, exr_clock.KEY: "24 UTC"}
        made.add(MADE_WITH["drone", "comp"], {path: describe(tmp_path / path) | entry})
        yield made


def of(fps, monkeypatch):
    monkeypatch.setattr(exr_tags, "times", lambda _, frame: exr_tags.film_time(Fraction(fps), frame))
    return SimpleNamespace(settings=SimpleNamespace(time=SimpleNamespace(rate=Fraction(fps), zone="UTC")))


def test_an_equal_frame_rate_changes_no_file(store, monkeypatch):
    before = store.latest_number()
    assert exr_clock.update(of("24", monkeypatch), store, [FIRST], MADE_WITH) == ""
    assert store.latest_number() == before


def test_another_frame_rate_is_written_and_reported(store, monkeypatch):
    (path,) = FIRST.files()
    shot = of("30000/1001", monkeypatch)
    assert exr_clock.update(shot, store, [], MADE_WITH) == "", "a picture that is rendered again"
    found = exr_clock.update(shot, store, [FIRST], MADE_WITH)
    assert found == "other frame rate or time zone: wrote new times into 1 EXR file, without rendering"
    header = pytest.importorskip("OpenEXR").File(str(store.out / path)).header()
    assert header["framesPerSecond"] == Fraction(30000, 1001)
    assert store.names() == [path]
    assert store.inputs_of(path) == MADE_WITH["drone", "comp"]
    assert store.differing("sha256", describe(store.out / path)["sha256"], ".exr") == {}
    assert exr_clock.update(shot, store, [FIRST], MADE_WITH) == "", "done once"
