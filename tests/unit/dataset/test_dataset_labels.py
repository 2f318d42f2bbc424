"""Labels of closed form: a pole of smoke, a rectangle of fire on a plane; hidden, small, invisible ones."""

from dataclasses import replace

import numpy as np
import plain_samples
import pytest
from firetwin.dataset import labels, survey, truth
from firetwin.passes import masks
from hypothesis import given, settings
from hypothesis.extra import numpy as arrays

PLACE = plain_samples.flat_place()
CAMERA = plain_samples.looking(-3.0, height=100.0, size=(320, 240))


def smoky(sample, shown, opacity, away, added=0.2):
    """Add smoke in pixels `shown`: its opacity, its distance (m), and its light."""
    clear = np.where(shown, 1.0 - opacity, 1.0).astype(np.float32)
    rgb = np.clip(sample.twin + np.where(shown, added, 0.0)[..., None], 0.0, 1.0).astype(np.float32)
    away = np.where(shown, away, np.inf).astype(np.float32)
    kind = np.where(clear < 0.5, masks.SMOKE, sample.surface).astype(np.uint8)
    return replace(sample, clear=clear, rgb=rgb, smoke_range=away, classes=kind)


def burning(sample, shown, hidden=None):
    """Add fire in pixels `shown`; smoke hides it in pixels `hidden`."""
    hidden = np.zeros_like(shown) if hidden is None else hidden
    surface = np.where(shown, masks.FIRE, sample.surface).astype(np.uint8)
    twin_fire = np.where(shown, 1.0, 0.0)[..., None].repeat(3, -1).astype(np.float32)
    return replace(
        sample,
        surface=surface,
        classes=np.where(hidden, masks.SMOKE, surface).astype(np.uint8),
        twin_fire=twin_fire,
        fire=np.where(hidden[..., None], 0.0, twin_fire).astype(np.float32),
        kelvin=np.where(shown, 900.0, 300.0).astype(np.float32),
    )


def block(rows, columns, shape=(240, 320)):
    mask = np.zeros(shape, bool)
    mask[slice(*rows), slice(*columns)] = True
    return mask


def pole(height, distance, half_width, camera=CAMERA):
    """Pixels whose rays meet an upright screen at y = distance, and the distances there."""
    ahead = plain_samples.directions(camera)
    part = distance / ahead[..., 1]
    z = camera.to_world[2, 3] + part * ahead[..., 2]
    shown = (z > 0.0) & (z < height) & (abs(part * ahead[..., 0]) < half_width)
    return shown, part * np.linalg.norm(ahead, axis=-1)


@pytest.mark.parametrize(("height", "distance"), [(150.0, 2000.0), (600.0, 4000.0), (80.0, 900.0)])
def test_a_pole_of_smoke_has_its_height_distance_and_box(height, distance):
    shown, away = pole(height, distance, 60.0)
    sample = smoky(plain_samples.plane(CAMERA), shown, 0.4, away)
    found, drawn = labels.label(sample, PLACE, 3)
    (plume,) = found.annotations
    pixel = distance / CAMERA.fy
    assert plume.category == truth.SMOKE
    assert plume.top_above_ground_m == pytest.approx(height, abs=pixel)
    assert plume.top_above_sea_m == pytest.approx(height, abs=pixel + 2.0)
    assert plume.distance_m == pytest.approx(distance, rel=0.02)
    u, v, _ = survey.project(
        CAMERA, np.array([[-60.0, distance, height], [60.0, distance, height], [60.0, distance, 0.0]])
    )
    assert plume.box == pytest.approx((u[0], v[0], u[1], v[2]), abs=1.0)
    assert np.array_equal(drawn.visible_pixels(plume), shown)
    assert plume.visible_fraction == 1.0
    assert plume.contrast == pytest.approx(0.2, abs=0.08)
    assert "green" in plume.band


def test_boxes_by_opacity_shrink():
    sample = plain_samples.plane(CAMERA)
    opacity = np.zeros((240, 320))
    opacity[40:140, 50:150], opacity[60:120, 70:130], opacity[80:100, 90:110] = 0.06, 0.3, 0.8
    sample = smoky(sample, opacity > 0.0, opacity, 3000.0)
    (plume,) = labels.label(sample, PLACE, 1)[0].annotations
    assert plume.boxes_by_alpha == {
        "0.05": (50.0, 40.0, 150.0, 140.0),
        "0.2": (70.0, 60.0, 130.0, 120.0),
        "0.5": (90.0, 80.0, 110.0, 100.0),
    }
    assert plume.box == plume.boxes_by_alpha["0.05"]


@pytest.mark.parametrize(("opacity", "added", "count"), [(0.3, 0.2, 1), (0.3, 0.04, 0), (0.04, 0.1, 0)])
def test_smoke_without_opacity_or_contrast_has_no_box(opacity, added, count):
    shown = block((40, 100), (40, 100))
    sample = smoky(plain_samples.plane(CAMERA), shown, opacity, 3000.0, added)
    found, drawn = labels.label(sample, PLACE, 1)
    assert len(found.annotations) == count
    assert drawn.smoke.any() == bool(count)
    invisible = found.labelling["smoke_without_contrast_pixels"]
    assert invisible == (shown.sum() if opacity > 0.05 and not count else 0)


def test_a_veil_without_a_sure_part_is_doubtful_and_has_no_box():
    """A threshold alone would cut splinters out of it."""
    shown, slope = block((40, 140), (40, 240)), np.linspace(0.02, 0.075, 320)[None, :]
    found, drawn = labels.label(smoky(plain_samples.plane(CAMERA), shown, 0.3, 90.0, slope), PLACE, 1)
    assert (found.annotations, len(found.below_size), drawn.smoke.any()) == ((), 1, False)


def test_the_mask_of_a_plume_has_no_hole_where_its_light_is_that_of_the_background():
    shown = block((40, 140), (40, 240))
    away = np.hypot(*np.mgrid[-90:150, -140:180]) - 30.0  # pixels from a circle within it
    light = np.where(away > 0.0, 0.2, -0.2) * np.minimum(abs(away) / 20.0, 1.0)
    found, drawn = labels.label(smoky(plain_samples.plane(CAMERA), shown, 0.6, 3000.0, light), PLACE, 1)
    assert len(found.annotations) == 1
    np.testing.assert_array_equal(drawn.smoke > 0, shown)


def test_smoke_without_contrast_joins_the_parts_of_its_plume():
    near, far, between = (block((40, 100), columns) for columns in ((40, 90), (150, 200), (90, 150)))
    sample = plain_samples.plane(CAMERA)
    plume = smoky(sample, near | far | between, 0.3, 3000.0, np.where(between, 0.0, 0.2))
    (joined,) = labels.label(plume, PLACE, 1)[0].annotations
    assert joined.box == pytest.approx((40.0, 40.0, 200.0, 100.0))
    assert joined.pixels == pytest.approx((near | far).sum(), rel=0.1)
    parts = smoky(sample, near | far, 0.3, 3000.0)
    assert len(labels.label(parts, PLACE, 1)[0].annotations) == 2


@pytest.mark.parametrize(("gap", "boxes", "ignored"), [(14, 1, 1), (60, 2, 0)])
def test_a_small_piece_next_to_a_plume_has_no_box_and_is_ignored(gap, boxes, ignored):
    plume, piece = block((40, 140), (40, 140)), block((80, 92), (140 + gap, 152 + gap))
    found, drawn = labels.label(smoky(plain_samples.plane(CAMERA), plume | piece, 0.3, 3000.0), PLACE, 1)
    assert (len(found.annotations), len(found.below_size)) == (boxes, ignored)
    assert found.annotations[0].box == (40.0, 40.0, 140.0, 140.0)
    assert drawn.smoke[piece].any() == (not ignored)


def test_noise_of_the_picture_is_no_contrast():
    sample = smoky(plain_samples.plane(CAMERA), block((40, 200), (40, 200)), 0.3, 3000.0, 0.0)
    noise = np.random.default_rng(0).normal(0.0, 0.03, sample.rgb.shape).astype(np.float32)
    found, _ = labels.label(replace(sample, rgb=sample.rgb + noise), PLACE, 1)
    assert found.annotations == ()


def test_a_rectangle_of_fire_on_a_plane_has_its_area_and_distance():
    camera = plain_samples.looking(-60.0, height=400.0, size=(320, 240))
    sample = plain_samples.plane(camera)
    ahead = plain_samples.directions(camera)
    x, y = (sample.depth * ahead[..., k] for k in (0, 1))
    shown = (abs(x) < 60.0) & (abs(y - 250.0) < 40.0)
    found, drawn = labels.label(burning(sample, shown), PLACE, 1)
    (flames,) = found.annotations
    assert flames.category == truth.FIRE
    assert flames.ground_area_m2 == pytest.approx(120.0 * 80.0, rel=0.03)
    assert flames.distance_m == pytest.approx(np.hypot(400.0, 250.0), rel=0.02)
    assert flames.nearest_m == pytest.approx(np.hypot(400.0, 210.0), rel=0.02)
    assert flames.max_temperature_k == 900.0
    assert flames.seconds_since_ignition == 3600.0
    assert np.array_equal(drawn.fire > 0, shown)


def test_ground_that_does_not_burn_is_not_below_flames():
    place = replace(PLACE, burns=lambda x, _: np.zeros(np.shape(x), bool))
    found, _ = labels.label(burning(plain_samples.plane(CAMERA), block((200, 220), (9, 40))), place, 1)
    assert found.annotations[0].distance_m is None
    assert found.annotations[0].ground_area_m2 is None


def test_flames_behind_smoke_have_a_visible_fraction_and_an_amodal_box():
    shown, hidden = block((150, 190), (100, 160)), block((150, 190), (100, 130))
    sample = plain_samples.plane(CAMERA)
    sample = burning(smoky(sample, hidden, 0.9, 500.0), shown, hidden)
    found, drawn = labels.label(sample, PLACE, 1)
    flames, plume = found.annotations
    assert (flames.category, plume.category) == (truth.FIRE, truth.SMOKE)
    assert flames.visible_fraction == pytest.approx(0.5)
    assert flames.box == (130.0, 150.0, 160.0, 190.0)
    assert flames.amodal_box == (100.0, 150.0, 160.0, 190.0)
    assert (flames.pixels, flames.amodal_pixels) == (1200, 2400)
    assert np.array_equal(drawn.visible_pixels(flames), shown & ~hidden)
    assert np.array_equal(drawn.amodal_pixels(flames), shown)


def test_small_and_hidden_instances_are_only_in_the_metadata():
    small, large, hidden = block((10, 13), (10, 15)), block((60, 64), (60, 64)), block((200, 230), (200, 250))
    sample = burning(plain_samples.plane(CAMERA), small | large | hidden, hidden)
    label, drawn = labels.label(sample, PLACE, 1)
    assert [(each.id, each.pixels) for each in label.annotations] == [(1, 16)]
    assert [(each.id, each.pixels) for each in label.below_size] == [(2, 15), (3, 0)]
    assert label.below_size[1].box == (0.0, 0.0, 0.0, 0.0)
    assert label.below_size[1].amodal_box == (200.0, 200.0, 250.0, 230.0)
    assert set(np.unique(drawn.amodal)) == {0, 1}
    assert not label.is_negative


def test_at_most_255_instances_have_boxes():
    shown = np.zeros((480, 640), bool)
    for row in range(16):
        for column in range(20):
            shown[row * 30 : row * 30 + 4 + (row == 3), column * 32 : column * 32 + 4] = True
    camera = plain_samples.looking(-3.0, size=(640, 480))
    found, drawn = labels.label(burning(plain_samples.plane(camera), shown), PLACE, 1)
    assert len(found.annotations) == 255
    assert len(found.below_size) == 320 - 255
    assert found.annotations[0].pixels == 20  # the largest first
    assert drawn.fire.max() == 255


def test_a_trunk_does_not_divide_a_plume_and_a_ridge_does():
    sample = plain_samples.plane(CAMERA)
    trunk = block((40, 100), (40, 100)) & ~block((0, 240), (60, 66))
    ridge = block((40, 100), (40, 100)) & ~block((0, 240), (60, 80))
    assert len(labels.label(smoky(sample, trunk, 0.4, 2000.0), PLACE, 1)[0].annotations) == 1
    assert len(labels.label(smoky(sample, ridge, 0.4, 2000.0), PLACE, 1)[0].annotations) == 2


@pytest.mark.parametrize(("rows", "cut"), [((0, 40), True), ((1, 40), False), ((200, 240), True)])
def test_an_instance_at_the_edge_is_cut(rows, cut):
    found, _ = labels.label(burning(plain_samples.plane(CAMERA), block(rows, (50, 90))), PLACE, 1)
    assert found.annotations[0].cut_by_edge == cut


def test_dim_flames_count_by_the_exposure():
    sample = plain_samples.plane(CAMERA)
    dim = np.where(block((60, 90), (60, 90)), 0.015, 0.0)[..., None].repeat(3, -1).astype(np.float32)
    by_day = replace(sample, fire=dim, twin_fire=dim, light=dim + 0.02, twin_light=dim + 0.02)
    assert labels.label(by_day, PLACE, 1)[0].is_negative
    assert len(labels.label(replace(by_day, exposure=1.0), PLACE, 1)[0].annotations) == 1


@pytest.mark.parametrize(("light", "visible"), [(0.1, 1.0), (0.4, 1.0), (0.6, 0.0)])
def test_flames_that_bright_smoke_outshines_are_hidden(light, visible):
    shown = block((60, 90), (60, 90))
    sample = burning(plain_samples.plane(CAMERA), shown, shown)
    dimmed = np.where(shown, 0.1, 0.0)[..., None].repeat(3, -1).astype(np.float32)
    sample = replace(sample, fire=dimmed, light=np.full_like(dimmed, light))
    found, _ = labels.label(sample, PLACE, 1)
    (flames,) = found.annotations + found.below_size
    assert flames.visible_fraction == visible


def test_the_pose_of_the_file_projects_a_landmark_to_its_pixel():
    found, _ = labels.label(plain_samples.plane(CAMERA), PLACE, 1)
    pose = found.camera
    turned = (pose.heading + 180.0) % 360.0 - 180.0  # a heading of 360 is north too
    assert (turned, pose.pitch, pose.roll) == pytest.approx((0.0, -3.0, 0.0), abs=1e-6)
    assert pose.height_above_ground_m == pytest.approx(100.0)
    assert pose.ellipsoidal_height_m == pytest.approx(75.0)
    assert pose.origin_ellipsoidal_height_m == pytest.approx(-25.0)
    assert (pose.latitude, pose.longitude) == pytest.approx((38.8, -120.6))
    landmark = np.array([30.0, 400.0, 20.0, 1.0])
    x, y, z, _ = np.linalg.inv(pose.camera_to_world) @ landmark
    u, v, depth = survey.project(CAMERA, landmark[None, :3])
    assert pose.cx + pose.fx * x / -z == pytest.approx(u[0])
    assert pose.cy - pose.fy * y / -z == pytest.approx(v[0])
    assert -z == pytest.approx(depth[0])


def test_a_sample_without_fire_is_a_negative_with_a_horizon():
    place = replace(PLACE, ignition=None)
    label, drawn = labels.label(plain_samples.plane(CAMERA), place, 8)
    assert label.is_negative
    assert label.index == 8
    assert label.seconds_since_ignition is None
    assert label.front == []
    assert label.front_geojson is None
    assert len(label.horizon) == 1
    assert not drawn.smoke.any()


blobs = arrays.arrays(bool, (24, 32))


@given(blobs, blobs, blobs)
@settings(max_examples=25)
def test_masks_boxes_and_counts_agree(tmp_path_factory, smoke, fire, hidden):
    camera = plain_samples.looking(-3.0, size=(128, 96))
    smoke, fire, hidden = (np.kron(each, np.ones((4, 4), bool)) for each in (smoke, fire, hidden))
    sample = burning(smoky(plain_samples.plane(camera), smoke, 0.3, 900.0), fire, hidden & fire)
    label, drawn = labels.label(sample, PLACE, 1)
    assert [each.id for each in label.annotations] == list(range(1, len(label.annotations) + 1))
    for each in label.annotations:
        for mask, box, pixels in (
            (drawn.visible_pixels(each), each.box, each.pixels),
            (drawn.amodal_pixels(each), each.amodal_box, each.amodal_pixels),
        ):
            row, column = np.nonzero(mask)
            assert mask.sum() == pixels
            assert box == (column.min(), row.min(), column.max() + 1, row.max() + 1)
        assert 0.0 < each.visible_fraction <= 1.0
    assert ((drawn.fire == 0) | (drawn.fire == drawn.amodal)).all()
    again, masks_again = labels.label(sample, PLACE, 1)
    assert again == label
    assert np.array_equal(masks_again.amodal, drawn.amodal)
    folder = tmp_path_factory.mktemp("set")
    truth.write(folder, label)
    assert truth.read(folder, 1) == label
