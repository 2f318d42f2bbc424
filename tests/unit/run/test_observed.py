"""Observations as lines on the ground of a shot and on the maps."""

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run import maps, observations, readers
from firetwin.shot.source import ShotSource
from firetwin.shot.surface import observed
from matplotlib.colors import to_hex

RING = [[-120.595, 38.903], [-120.590, 38.903], [-120.590, 38.907], [-120.595, 38.907], [-120.595, 38.903]]
TIMES = ("2014-09-17T04:45:30Z", "2014-09-17T04:46:30Z")


@pytest.fixture
def scene(make_run, tmp_path):
    """A scene file whose fire.observed is a folder with two perimeters and one detection."""
    folder = tmp_path / "seen"
    folder.mkdir()
    features = ", ".join(
        f'{{"type": "Feature", "properties": {{"time": "{time}"}}, "geometry": '
        f'{{"type": "Polygon", "coordinates": [{RING}]}}}}'
        for time in TIMES
    )
    (folder / "king.geojson").write_text(f'{{"type": "FeatureCollection", "features": [{features}]}}')
    (folder / "viirs.csv").write_text(
        "latitude,longitude,acq_date,acq_time,scan,track,instrument\n38.905,-120.592,2014-09-17,446,0.4,0.4,VIIRS\n"
    )
    path = tmp_path / "scene.toml"
    path.write_text(f'run = "{make_run().as_posix()}"\n[terrain]\napron = 0.0\n[fire]\nobserved = "seen"\n')
    return path


def test_lines_lie_over_the_ground_by_their_dates(scene):
    shot = ShotSource(scene=str(scene)).shot()
    first, pixel, second = observed.lines(shot)
    assert (first.start, first.fades, first.end) == (30.0, 90.0, observed.FOREVER)
    assert (pixel.start, pixel.end) == (60.0, 60.0 + 12 * 3600.0)
    assert (second.start, second.fades) == (90.0, observed.FOREVER)
    for line in (first, pixel):
        up = shot.ground.up(line.points[:, 0], line.points[:, 1])
        np.testing.assert_allclose(line.points[:, 2] - up, observed.ABOVE, atol=0.1)
        apart = np.linalg.norm(np.diff(line.points[:, :2], axis=0), axis=1)
        assert apart.max() < 20.1
    width = np.ptp(pixel.points[:, 0])
    assert width == pytest.approx(400.0, rel=2e-3)


def test_a_file_that_is_none_is_named_with_its_line(scene):
    scene.write_text(scene.read_text().replace('"seen"', '"gone.kml"'))
    with pytest.raises(InputError, match=r"scene.toml:5:1: fire.observed: .*gone.kml: there is no such file"):
        ShotSource(scene=str(scene)).shot()


def test_another_file_makes_other_pictures(scene):
    settings = ShotSource(scene=str(scene)).settings()
    before = observed.inputs(settings)
    assert set(before) == {"observed king.geojson", "observed viirs.csv"}
    path = scene.parent / "seen" / "viirs.csv"
    path.write_text(path.read_text().replace("38.905", "38.904"))
    after = observed.inputs(settings)
    assert [name for name in before if before[name] != after[name]] == ["observed viirs.csv"]


def test_perimeters_are_on_the_map_and_in_its_legend(scene):
    settings = ShotSource(scene=str(scene)).settings()
    run, found = readers.open(settings.run), observations.read(observed.files(settings))
    (axes, *_) = maps.intensity_map(run, "UTC", found).axes
    outlines = [each for each in axes.patches if to_hex(each.get_edgecolor()) == to_hex(maps.SEEN(1.0))]
    assert len(outlines) == 1
    assert np.ptp(outlines[0].get_path().vertices[:, 0]) == pytest.approx(0.005)
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert texts == ["17 Sep 2014 04:45 UTC", "17 Sep 2014 04:46 UTC"]
