"""The user's rasters in the scene: objects on an elevation model, and colours of an orthophoto."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.scene import build
from firetwin.shot.shot import Shot


def plane(latitude, longitude):
    """A hillside unlike the run's, m."""
    return 1500.0 + 4.0e3 * (latitude - 38.84) - 6.0e3 * (longitude + 120.55)


@pytest.fixture
def model(tmp_path):
    """Write an elevation model of the whole run."""
    rasterio = pytest.importorskip("rasterio")
    count, step = 300, 0.0005
    longitude, latitude = np.meshgrid(-120.625 + step * np.arange(count), 38.915 - step * np.arange(count))
    transform = rasterio.Affine(step, 0.0, -120.625 - 0.5 * step, 0.0, -step, 38.915 + 0.5 * step)
    path = tmp_path / "dem.tif"
    with rasterio.open(
        path, "w", driver="GTiff", width=count, height=count, count=1, dtype="float32",
        crs="EPSG:4326", transform=transform,
    ) as file:  # fmt: skip
        file.write(plane(latitude, longitude).astype(np.float32), 1)
    return path


@pytest.mark.parametrize("density", ["paper", "stand"])
def test_trees_and_ground_stand_on_the_elevation_model(
    near_settings, run, scene, plain_looks, model, density
):
    changed = replace(
        near_settings,
        terrain=replace(near_settings.terrain, elevation=model),
        forest=replace(near_settings.forest, density=density),
    )
    shot = Shot(changed, run)
    build.build(shot, scene, ("terrain", "forest"))
    for name, most in (("Ground", 0.3), ("Trees", 0.3)):
        data = next(thing.data for thing in bpy.data.objects if thing.name.endswith(name))
        place = np.empty(3 * len(data.vertices), np.float32)
        data.vertices.foreach_get("co", place)
        place = place.reshape(-1, 3).astype(float)
        place = place[np.abs(place[:, :2]).max(axis=1) < 3500.0]
        assert len(place) > 20
        latitude, longitude, height = shot.local_frame.reverse(place)
        assert height == pytest.approx(plane(latitude, longitude), abs=most)
