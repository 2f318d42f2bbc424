"""Lines of observations in Blender: visible from their date on, and never in the thermal pass."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.scene.fire import build as fire
from firetwin.scene.fire import observed as ribbons
from firetwin.shot.shot import Shot
from firetwin.shot.surface import observed


@pytest.fixture
def seen(settings, run, tmp_path):
    """A shot whose fire was seen once, half-way, as a triangle."""
    corners = [[-120.56, 38.83], [-120.54, 38.83], [-120.55, 38.85], [-120.56, 38.83]]
    path = tmp_path / "seen.geojson"
    path.write_text(
        f'{{"type": "Feature", "properties": {{"time": "2014-09-17T21:30:00Z"}}, "geometry": '
        f'{{"type": "Polygon", "coordinates": [{corners}]}}}}'
    )
    wanted = replace(settings.fire, observed=path, observed_width=50.0, flames=False)
    return Shot(replace(settings, fire=wanted), run)


def test_no_file_no_lines(shot):
    fire.build(shot, owned.stage(bpy.context.scene))
    assert "Firetwin Observed" not in bpy.data.objects


def test_a_ribbon_as_wide_as_it_should_be_with_its_times(seen):
    fire.build(seen, owned.stage(bpy.context.scene))
    thing = bpy.data.objects["Firetwin Observed"]
    mesh, (line,) = thing.data, observed.lines(seen)
    count = len(line.points)
    assert (len(mesh.vertices), len(mesh.polygons)) == (2 * count, count)
    place = np.array([v.co[:] for v in mesh.vertices])
    apart = np.linalg.norm((place[:count] - place[count:])[:, :2], axis=1)
    np.testing.assert_allclose(apart, 50.0, rtol=1e-3)
    start = [each.value for each in mesh.attributes["seen_start"].data]
    assert set(start) == {1800.0}
    assert not thing.visible_shadow


def test_a_square_band_by_hand():
    points = np.array([[0.0, 0, 5], [10, 0, 5], [10, 10, 5], [0, 10, 5]])
    band = ribbons.closed_ribbon(points, np.sqrt(8.0))
    np.testing.assert_allclose((band[:4] + band[4:]) / 2, points, atol=1e-6)
    assert abs(band[0] - band[4]).max() == pytest.approx(2.0, rel=1e-6)
