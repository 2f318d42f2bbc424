"""Exposures of time lapses: which sub-frames a picture averages, with which weights."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from firetwin.run import opening as runs
from firetwin.shot.sections import SmokeSettings, TerrainSettings, Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from firetwin.smoke import shutter, sources
from hypothesis import given
from hypothesis import strategies as st
from small_run import RUN_TOML, small_fields, write_field

START = datetime(2014, 9, 17, 4, 46, 20, tzinfo=UTC)

LENGTHS = st.floats(0.05, 4.0)


def test_a_frame_without_exposure_is_its_own_moment():
    assert shutter.parts(0.0) == 1
    assert shutter.sub_frames(5, 0.0, 48) == [(1.0, 5)]
    assert shutter.moments(["bricks"]) == [(1.0, ["bricks"])]


def test_a_time_lapse_covers_the_interval_on_either_side():
    assert shutter.parts(2.0) == 3
    weights, numbers = zip(*shutter.sub_frames(5, 2.0, 48), strict=True)
    assert numbers == tuple(range(10, 17))  # frames 4, 5 and 6 are sub-frames 10, 13 and 16
    assert weights == pytest.approx([1 / 12, *[1 / 6] * 5, 1 / 12])


@given(st.integers(1, 20), LENGTHS)
def test_an_exposure_is_centred_and_within_the_film(frame, length):
    moments = shutter.sub_frames(frame, length, 20)
    each = shutter.parts(length)
    middle, last = (frame - 1) * each + 1, 19 * each + 1
    assert sum(weight for weight, _ in moments) == pytest.approx(1.0)
    assert middle in [number for _, number in moments]
    assert all(1 <= number <= last for _, number in moments)
    reach = 0.5 * length * each
    if middle - reach >= 1 and middle + reach <= last:
        assert sum(weight * number for weight, number in moments) == pytest.approx(middle)


@given(LENGTHS)
def test_neighbouring_frames_share_sub_frames_of_long_exposures(length):
    one, two = ({number for _, number in shutter.sub_frames(f, length, 20)} for f in (10, 11))
    assert bool(one & two) or length <= 1.2


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """Film of a small fire: three frames, 20 s apart."""
    folder = tmp_path_factory.mktemp("film")
    (folder / "run").mkdir()
    (folder / "run" / "run.toml").write_text(RUN_TOML)
    for name, values in small_fields().items():
        write_field(folder / "run", name, values, "npy")
    time = Time(start=START, end=START + timedelta(seconds=40), frames=3, fps=12)
    smoke = SmokeSettings(spin_up=60.0, voxel_size=60.0, complete=True)
    settings = Settings(cache=folder / "cache", time=time, smoke=smoke, terrain=TerrainSettings(apron=0.0))
    return lambda **changes: Shot(replace(settings, time=replace(time, **changes)), runs.open(folder / "run"))


def test_a_time_lapse_has_sub_frames_and_an_ordinary_film_has_none(film):
    source = sources.select(film())
    assert shutter.exposure(source.shot) == 2.0
    smoke = source.bricks(2)
    weights, bricks = zip(*shutter.moments(smoke), strict=True)
    assert len(weights) == 7
    assert bricks[3] is not bricks[0]
    assert [each.used for each in bricks[3]] == [each.used for each in smoke]
    assert sum(each.used for each in bricks[0]) < sum(each.used for each in smoke), "wider voxels"
    assert source.domains[0].has(source.snapshot(3))
    slow = sources.select(film(shutter=0.0))
    assert (slow.parts, slow.snapshot(3)) == (1, 3)
    assert slow.flow.key() != source.flow.key()


def test_a_preview_of_a_time_lapse_has_sub_frames_and_one_domain(film):
    shot = film()
    smoke = replace(shot.settings.smoke, method="preview")
    lapse, plain = (
        sources.select(
            shot.with_settings(
                replace(shot.settings, smoke=smoke, time=replace(shot.settings.time, shutter=exposure))
            )
        )
        for exposure in (2.0, 0.0)
    )
    assert [len(each.domains) for each in (lapse, plain)] == [1, 2]
    assert len(shutter.moments(lapse.bricks(2))) == 7
    assert lapse.domains[0].cells < 4 * plain.domains[0].cells
