"""The Earth beyond the terrain: its position, its join, and that only cameras in space show it."""

from collections import Counter
from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.imaging.credits import Credits
from firetwin.scene import build
from firetwin.scene.terrain import globe, material
from firetwin.shot import picture_credits, run_checks
from firetwin.shot.cameras.rigs.globe import Globe
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core.terrain import bilinear


@pytest.fixture
def space(settings, run):
    """The small shot with a camera that comes from space."""
    camera = Camera("space", Globe(latitude=38.84, longitude=-120.55, height=3000.0))
    return Shot(replace(settings, cameras=(camera,), time=replace(settings.time, frames=24)), run)


def test_the_shell_is_the_ellipsoid_and_joins_the_terrain(space):
    ground = space.ground
    position, triangles = globe.create_shell(ground)
    latitude, longitude, height = ground.frame.reverse(position)
    assert np.linalg.norm(position, axis=1).max() > 1.27e7, "it reaches the other side"
    far = np.linalg.norm(position, axis=1) > 3.0e6
    assert np.abs(height[far]).max() < 1.0
    around = 4 * globe._SIDE
    row, column = ground.indices(latitude[around : 2 * around], longitude[around : 2 * around])
    edge = bilinear(ground.fields.elevation, row, column)
    assert height[around : 2 * around] == pytest.approx(edge, abs=0.01)
    fields = ground.fields
    on_border = np.minimum.reduce(
        [
            np.abs(latitude[around : 2 * around] - fields.latitude[0]),
            np.abs(latitude[around : 2 * around] - fields.latitude[-1]),
            np.abs(longitude[around : 2 * around] - fields.longitude[0]),
            np.abs(longitude[around : 2 * around] - fields.longitude[-1]),
        ]
    )
    assert on_border.max() < 1e-9
    edges = Counter(
        tuple(sorted(pair)) for a, b, c in triangles.tolist() for pair in ((a, b), (b, c), (c, a))
    )
    once = [pair for pair, count in edges.items() if count == 1]
    ends = len(position) - around
    assert all(max(pair) < 3 * around or min(pair) >= ends for pair in once), "no hole between"
    corner = position[triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    out = np.einsum("ni,ni->n", normal, corner.mean(axis=1) - np.array([0.0, 0.0, -6.37e6]))
    assert (out[np.linalg.norm(normal, axis=1) > 1.0] > 0.0).mean() > 0.99, "it faces outwards"


def test_the_ground_goes_over_into_the_globe_between_run_and_border(space):
    ground = space.ground
    rows, columns = ground.shape
    margin = ground.fields.margin
    at = np.array([0.0, rows / 2, margin, rows - 1.0])
    share = globe.border_share(ground, at, np.full(4, columns / 2))
    assert share == pytest.approx([1.0, 0.0, 0.0, 1.0], abs=0.02)
    assert globe.border_share(ground, np.array([rows / 2]), np.zeros(1)) == pytest.approx([1.0])


@pytest.mark.slow  # three builds of the terrain
def test_it_is_built_for_cameras_in_space_alone(space, shot, stage, scene, request):
    build.build(space, scene, parts=("terrain", "cameras"))
    names = {obj.name for obj in stage.root.all_objects}
    assert "Firetwin Globe" in names
    ground = next(obj for obj in stage.root.all_objects if obj.name == "Firetwin Ground")
    assert material.GLOBE in ground.data.attributes
    data = stage.camera("space").data
    for frame in (1, 12, 24):
        scene.frame_set(frame)
        wanted = space.paths[0].clips[frame - 1]
        assert (data.clip_start, data.clip_end) == pytest.approx(tuple(wanted), rel=0.02)
    request.getfixturevalue("plain_ground")
    build.build(shot, scene, parts=("terrain", "cameras"))
    assert "Firetwin Globe" not in {obj.name for obj in stage.root.all_objects}
    ground = next(obj for obj in stage.root.all_objects if obj.name == "Firetwin Ground")
    assert material.GLOBE not in ground.data.attributes
    assert "globe" not in stage.root


@pytest.mark.parametrize(
    ("content", "credit", "words"),
    [
        (b"\xff\xd8\xff\xe0", "", "globe_credit"),
        (b"GIF89a..", "NASA", "by its first bytes"),
        (None, "NASA", "is not a file"),
    ],
)
def test_a_picture_is_checked_and_needs_a_credit(settings, run, tmp_path, content, credit, words):
    path = tmp_path / "earth.jpg"
    if content is not None:
        path.write_bytes(content)
    settings.path.write_text(f'[terrain]\nglobe = "{path.name}"\nglobe_credit = "{credit}"\n')
    terrain_settings = replace(settings.terrain, globe=path, globe_credit=credit)
    with pytest.raises(InputError, match=words) as error:
        run_checks.check(replace(settings, terrain=terrain_settings), run)
    assert error.value.line == 2


def test_a_damaged_picture_is_one_line(space, tmp_path):
    path = tmp_path / "earth.jpg"
    path.write_bytes(b"\xff\xd8\xff\xe0 cut off")
    settings = replace(space.settings, terrain=replace(space.settings.terrain, globe=path))
    with pytest.raises(InputError, match=r"earth\.jpg: is damaged or not a picture; export it again"):
        globe.load_picture(Shot(settings, space.run))


def test_its_picture_and_credit_are_told(space, stage, tmp_path, plain_looks):
    path = tmp_path / "earth.png"
    image = bpy.data.images.new("earth", 8, 4)
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    settings = replace(space.settings.terrain, globe=path, globe_credit="NASA")
    shot = Shot(replace(space.settings, terrain=settings), space.run)
    assert picture_credits.of_shot(shot) == Credits(("NASA",))
    assert globe.load_picture(shot).size[:] == (8, 4)


def test_the_default_picture_has_land_and_sea_where_they_are(space):
    image = globe.load_picture(space)
    assert image.packed_file.size < 2_000_000
    width, height = image.size
    pixels = np.empty((height, width, 4), np.float32)
    image.pixels.foreach_get(pixels.ravel())

    def at(latitude, longitude):
        return pixels[int((latitude + 90) / 180 * height), int((longitude + 180) / 360 * width), :3]

    for wet in ((30.0, -140.0), (-40.0, 80.0), (47.7, -87.5)):
        assert at(*wet)[2] > 2.0 * at(*wet)[0]
    for dry in ((38.8, -120.5), (23.0, 10.0), (-5.0, -62.0), (-25.0, 135.0)):
        assert at(*dry)[2] < at(*dry)[1]
    assert at(72.0, -40.0).min() > 0.8, "ice"
