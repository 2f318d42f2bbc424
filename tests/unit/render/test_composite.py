"""Pictures of surfaces and marched smoke, against the definition of a pixel of several rays."""

import dataclasses

import numpy as np
import pytest
from firetwin.render import composite
from hypothesis import given
from hypothesis import strategies as st

SIZE = 7, 9
FAR = np.float32(1e10)


def surfaces(shown, distance, **changes):
    """Surfaces of even colour and distance (broadcast to the picture), without fire."""
    colour = np.array(np.broadcast_to(np.float32(shown), (*SIZE, 3)))
    distance = np.array(np.broadcast_to(np.float32(distance), SIZE))
    none = np.zeros(SIZE, np.float32)
    given = {
        "colour": colour,
        "noisy": colour,
        "fire": np.zeros_like(colour),
        "distance": distance,
        "nearness": np.where(distance < 1e9, 1000.0 / distance, 0.0).astype(np.float32),
        "aside": none,
        "solid": (distance < 1e9).astype(np.float32),
        "fire_distance": none,
        "flame_distance": none,
        "before": none,
        "rays": 10**9,
    }
    return composite.Surfaces(**(given | changes))


def even_smoke(seen, extinction=1e-3, shine=2.0):
    """Result of a march through uniform smoke at distances."""
    through = np.exp(-extinction * np.minimum(seen, 1e5))[..., None].astype(np.float32)
    return np.concatenate([np.repeat(shine * (1.0 - through), 3, axis=-1), through], axis=-1)


def picture(found, **smoke):
    seen = composite.taps(found)
    return composite.compose(found, seen, even_smoke(seen, **smoke)).picture


@given(st.floats(0.0, 50.0), st.floats(10.0, 1e4))
def test_without_smoke_surfaces_are_what_cycles_drew(colour, distance):
    found = surfaces(colour, distance, fire=np.full((*SIZE, 3), 0.2 * colour, np.float32))
    assert picture(found, extinction=0.0) == pytest.approx(found.colour, rel=1e-5)


def test_a_plane_behind_smoke_is_dimmed_and_veiled():
    through = np.exp(-1e-3 * 700.0)
    assert picture(surfaces(3.0, 700.0)) == pytest.approx(3.0 * through + 2.0 * (1.0 - through), rel=1e-5)


def test_behind_thick_smoke_nothing_is_seen():
    assert picture(surfaces(3.0, 700.0), extinction=1.0) == pytest.approx(2.0, rel=1e-5)


@pytest.mark.parametrize("flames", [0.0, 5000.0])
@pytest.mark.parametrize("part", [0.0, 1 / 3, 2 / 3, 1.0])
def test_a_pixel_at_a_silhouette_is_shared_by_near_and_far(part, flames):
    """Also if flames are behind both surfaces, such as a tree before burned ground."""
    distance = np.full(SIZE, 200.0, np.float32)
    distance[:, 5:] = 4000.0
    near, far = np.float32(1.0), np.float32(8.0)
    nearness = 1000.0 / distance
    colour = np.where(distance[..., None] < 1000.0, near, far) * np.ones(3, np.float32)
    nearness[:, 4] = part * 5.0 + (1.0 - part) * 0.25
    colour[:, 4] = part * near + (1.0 - part) * far
    known = {"flame_distance": np.full(SIZE, flames, np.float32), "before": np.ones(SIZE, np.float32)}
    found = surfaces(0.0, distance, colour=colour, noisy=colour, nearness=nearness, **known)
    through = np.exp(-1e-3 * np.array([200.0, 4000.0]))
    veil = 2.0 * (1.0 - through)
    expected = part * (near * through[0] + veil[0]) + (1.0 - part) * (far * through[1] + veil[1])
    assert picture(found)[3, 4] == pytest.approx(expected, rel=1e-4)


def test_flames_that_dim_the_far_surface_are_seen():
    """Also if most flames are behind both surfaces, such as in rows of flames one behind the other."""
    distance = np.full(SIZE, 200.0, np.float32)
    distance[:, 5:] = 4000.0
    behind = {"flame_distance": np.full(SIZE, 5000.0, np.float32), "before": np.ones(SIZE, np.float32)}
    nearness = 1000.0 / distance
    nearness[:, 4] = 0.5 * (5.0 + 0.25)
    scene = surfaces(1.0, distance, nearness=nearness, **behind)
    seen = composite.taps(scene)
    marched = np.zeros((*SIZE, 3, 8), np.float32)
    marched[..., 3] = marched[..., 7] = 1.0
    past = seen > 1000.0  # opaque flames at 1000 m
    marched[past, :3], marched[past, 3], marched[past, 4:7] = 5.0, 0.0, 5.0
    picture = composite.compose(scene, seen, marched).picture
    assert picture[3, 4] == pytest.approx(0.5 * 1.0 + 0.5 * 5.0)
    assert picture[3, 7] == pytest.approx(5.0)


def test_the_sky_beside_a_twig_stays_behind_the_smoke():
    """Of 8 rays of a pixel one meets the twig, which is black."""
    distance = np.full(SIZE, FAR)
    distance[2:5, 4] = 5.0
    solid = np.where(distance < 1e9, 0.5, 0.0).astype(np.float32)
    solid[3, 5] = 0.125
    colour = (1.0 - solid[..., None]) * np.full(3, 8.0, np.float32)
    found = surfaces(0.0, distance, colour=colour, noisy=colour, nearness=200.0 * solid, solid=solid, rays=8)
    hidden = picture(found, extinction=0.05)
    assert hidden[3, 5] == pytest.approx(0.875 * 2.0 + 0.125 * 2.0 * -np.expm1(-0.25), rel=1e-3)
    assert hidden[3, 6] == pytest.approx(2.0, rel=1e-3)


def twig(share):
    """Dark twig that covers this share of a column of pixels before a bright sky."""
    solid = np.zeros(SIZE, np.float32)
    solid[:, 4] = share
    distance = np.full(SIZE, FAR)
    distance[:, 4] = 5.0
    colour = solid[..., None] * np.float32(0.5) + (1.0 - solid[..., None]) * np.full(3, 8.0, np.float32)
    return surfaces(0.0, distance, colour=colour, noisy=colour, nearness=200.0 * solid, solid=solid, rays=8)


@given(st.sampled_from([0.125, 0.25, 0.375, 0.75]))
def test_a_twig_before_smoke_shows_its_own_colour_and_none_of_the_sky(share):
    near = np.exp(-5.0 * 0.05)
    expected = share * (0.5 * near + 2.0 * (1.0 - near)) + (1.0 - share) * 2.0
    assert picture(twig(share), extinction=0.05)[3, 4] == pytest.approx(expected, rel=1e-3)


@given(st.floats(0.1, 0.9))
def test_the_sky_in_gaps_that_no_central_ray_meets_stays_behind_the_smoke(share):
    """Between leaves that every central ray meets."""
    leaves = np.full((*SIZE, 3), share * 0.5 + (1.0 - share) * 8.0, np.float32)
    solid = np.full(SIZE, share, np.float32)
    crown = surfaces(0.0, 5.0, colour=leaves, noisy=leaves, nearness=200.0 * solid, solid=solid)
    near = np.exp(-5.0 * 0.05)
    leaf = share * 2.0 * (1.0 - near) + (1.0 - share) * 2.0  # and some of the leaf's own colour
    assert 0.999 * leaf <= picture(crown, extinction=0.05)[3, 4, 0] <= leaf + share * 8.0 * near


@pytest.mark.parametrize(("rays", "part"), [(1, 0.75), (15, 0.5), (10**9, 0.25)])
def test_few_rays_count_little_beside_what_neighbours_tell(rays, part):
    distance = np.full(SIZE, 200.0, np.float32)
    distance[:, 5:] = 4000.0
    nearness = 1000.0 / distance
    nearness[:, 4] = 0.25 * 5.0 + 0.75 * 0.25
    found = surfaces(0.0, distance, nearness=nearness, rays=rays)
    veil = 2.0 * (1.0 - np.exp(-1e-3 * np.array([200.0, 4000.0])))
    expected = part * veil[0] + (1.0 - part) * veil[1]
    assert picture(found)[3, 4, 0] == pytest.approx(expected, abs=0.03 * veil[1])


def test_the_sky_is_the_far_part_of_a_silhouette():
    distance = np.full(SIZE, 200.0, np.float32)
    distance[:, 5:] = FAR
    nearness = np.where(distance < 1e9, 5.0, 0.0).astype(np.float32)
    nearness[:, 4] = 2.5
    found = surfaces(1.0, distance, nearness=nearness)
    near = np.exp(-0.2)
    assert picture(found)[3, 4] == pytest.approx(0.5 * (near + 2.0 * (1.0 - near)) + 0.5 * 2.0, rel=1e-4)


def test_a_material_that_does_not_tell_its_distance_is_where_its_middle_is():
    distance = np.full(SIZE, 200.0, np.float32)
    distance[:, 5:] = 4000.0
    unknown = surfaces(1.0, distance, nearness=np.zeros(SIZE, np.float32), solid=np.zeros(SIZE, np.float32))
    assert picture(unknown) == pytest.approx(picture(surfaces(1.0, distance)), rel=1e-5)


def test_flames_are_dimmed_by_the_smoke_before_them_alone():
    fire = np.full((*SIZE, 3), 10.0, np.float32)
    way = np.full(SIZE, 300.0, np.float32)
    found = surfaces(1.0 + fire, 3000.0, fire=fire, fire_distance=way)
    ground = np.exp(-3.0) + 2.0 * (1.0 - np.exp(-3.0))
    assert picture(found) == pytest.approx(10.0 * np.exp(-0.3) + ground, rel=1e-4)
    assert picture(surfaces(1.0, 3000.0, fire=fire))[3, 3] == pytest.approx(ground, rel=1e-4), (
        "of no distance"
    )


def test_flames_are_as_bright_as_the_denoiser_left_them():
    fire = np.full((*SIZE, 3), 8.0, np.float32)
    found = surfaces(4.0, 3000.0, noisy=fire, fire=fire, fire_distance=np.full(SIZE, 300.0, np.float32))
    assert picture(found, shine=0.0) == pytest.approx(4.0 * np.exp(-0.3), rel=1e-4)


def test_grain_of_flames_leaves_none_behind_smoke():
    """Few rays hit flames: a denoised picture stays smooth, though their light is sampled."""
    random = np.random.default_rng(2)
    grains = (random.uniform(size=(60, 80, 1)) < 0.5) * np.full(3, 20.0, np.float32)
    spread = np.full((60, 80, 3), 11.0, np.float32)
    shape, near = (60, 80), np.full((60, 80), 100.0, np.float32)
    scene = composite.Surfaces(
        colour=spread,
        noisy=(1.0 + grains).astype(np.float32),
        fire=grains.astype(np.float32),
        distance=near,
        nearness=1000.0 / near,
        aside=np.zeros(shape),
        solid=np.ones(shape),
        fire_distance=np.full(shape, 3000.0, np.float32),
        flame_distance=np.zeros(shape, np.float32),
        before=np.zeros(shape, np.float32),
        rays=3,
    )
    shown = picture(scene, shine=0.0)[..., 0]
    assert shown.std() < 0.5 * (np.exp(-0.1) - np.exp(-3.0)) * 10.0 * 0.5


def test_infrared_radiance_of_flames_is_bounded_by_their_own():
    surface = np.full((*SIZE, 3), [5.0, 1.0, 50.0], np.float32)
    flames = np.zeros((*SIZE, 3), np.float32)
    flames[..., 2] = [0.0, 0.5, 1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0]
    warmth = flames[..., 2] * 1000.0
    found = composite.infrared_radiance(surface, flames, warmth, 20.0)
    assert found[0, :5] == pytest.approx([50.0, 525.0, 1000.0, 1000.0, 1000.0])


def test_infrared_radiance_of_the_sky_fills_what_is_not_solid():
    surface = np.full((*SIZE, 3), [0.0, 0.25, 0.25 * 60.0], np.float32)
    none = np.zeros((*SIZE, 3), np.float32)
    assert composite.infrared_radiance(surface, none, none[..., 0], 20.0) == pytest.approx(
        0.25 * 60.0 + 0.75 * 20.0
    )


def flames_behind_foliage(before):
    """Foliage at 100 m before flames of radiance 8 at 300 m, and the light at taps beyond 250 m."""
    known = np.full(SIZE, 300.0, np.float32)
    found = surfaces(0.0, 100.0, flame_distance=known, before=np.full(SIZE, before, np.float32))
    at = composite.taps(found)
    shine, clear = np.where(at > 250.0, 8.0, 0.0)[..., None], np.ones((*at.shape, 1))
    return found, at, np.concatenate([shine * np.float32([1, 0.4, 0]), clear], axis=-1).astype(np.float32)


@pytest.mark.parametrize("before", [0.0, 0.375, 1.0])
def test_gaps_that_no_central_ray_meets_show_the_flames_behind(before):
    shown = composite.compose(*flames_behind_foliage(before)).picture
    assert shown[3, 4] == pytest.approx((1.0 - before) * 8.0 * np.array([1, 0.4, 0]), rel=1e-4)


def test_flames_behind_foliage_leave_its_colours_as_they_are():
    """Blocks of the darkest leaf of each neighbourhood would show if pixels counted as edges in smoke."""
    scene, at, marched = flames_behind_foliage(1.0)
    leaves = np.float32(0.2) + np.float32(0.1) * (np.indices(SIZE).sum(axis=0) % 2)[..., None] * np.ones(
        3, np.float32
    )
    scene = dataclasses.replace(scene, colour=leaves, noisy=leaves)
    opaque = np.where(at > 250.0, np.float32(0.1), np.float32(1.0))[..., None]
    parts = [marched[..., :3], opaque, marched[..., :3], np.where(at > 250.0, 0.3, 1.0)[..., None]]
    shown = composite.compose(scene, at, np.concatenate(parts, axis=-1).astype(np.float32), 1.0).picture
    assert shown == pytest.approx(leaves, rel=1e-4)


def test_few_rays_in_foliage_leave_no_stipple_before_flames():
    """Gaps of half of each pixel, of which three rays find none to all."""
    found, at, marched = flames_behind_foliage(0.5)
    met = np.random.default_rng(5).binomial(3, 0.5, SIZE) / np.float32(3.0)
    rough = composite.compose(dataclasses.replace(found, before=met), at, marched).picture
    few = composite.compose(dataclasses.replace(found, before=met, rays=3), at, marched).picture
    assert few.mean() == pytest.approx(rough.mean(), rel=0.1)
    assert few[..., 0].std() < 0.6 * rough[..., 0].std()


def test_small_gaps_show_flames_less_bright_than_open_flames():
    light = [
        composite.compose(*flames_behind_foliage(part), 1.0).picture[3, 4, 0] for part in (0.0, 0.5, 0.9)
    ]
    assert light[0] == pytest.approx(8.0, rel=0.01)
    assert 0.5 < light[1] < 2.0
    assert 0.05 < light[2] < 0.2
    found, at, marched = flames_behind_foliage(0.5)
    marched[..., :3] = marched[..., :1]  # smoke is grey, and as bright as it was
    assert composite.compose(found, at, marched, 1.0).picture[3, 4] == pytest.approx(
        [4.0, 4.0, 4.0], rel=1e-4
    )


@pytest.mark.parametrize("white", [None, 1.0])
def test_negative_blue_of_flames_stays_in_their_layer(white):
    found, at, marched = flames_behind_foliage(0.5)
    marched[..., 2] = -0.08 * marched[..., 0]
    parts = np.concatenate([marched, marched[..., :3], np.ones((*at.shape, 1))], axis=-1).astype(np.float32)
    made = composite.compose(found, at, parts, white)
    assert made.fire[3, 4, 2] < -0.01
    assert made.smoke == pytest.approx(np.zeros_like(made.smoke), abs=1e-5)


def soften(light):
    return composite.soften_highlights(composite.Layers(light, light, 0.0 * light), 1.0).picture


def test_a_gap_in_foliage_is_a_soft_spot_and_keeps_its_light():
    light = np.full((*SIZE, 3), 0.1, np.float32)
    light[2:5, 3:6] = 6.0
    soft = soften(light)
    assert soft.sum() == pytest.approx(light.sum(), rel=0.02)
    assert soft[3, 4, 0] > 1.3 * soft[2, 3, 0] > 2.0 * soft[1, 2, 0]
    dark = np.minimum(light, 0.5)
    assert np.array_equal(soften(dark), dark)


@pytest.mark.parametrize(("distance", "seen"), [(100.0, 1.0), (300.0, 0.0)])
def test_text_is_in_front_of_what_is_farther_away(distance, seen):
    scene = surfaces(3.0, 200.0)
    light = np.full((*SIZE, 3), 0.5 * 7.0, np.float32)  # half of each pixel
    text = light, np.full(SIZE, 0.5, np.float32), np.full(SIZE, distance, np.float32)
    front = np.zeros((*SIZE, 4), np.float32)
    front[..., 3] = 1.0
    shown = composite.place_over(
        scene.colour, composite.text_layer(scene, composite.taps(scene), text, front)
    )
    assert shown == pytest.approx(seen * 5.0 + (1.0 - seen) * 3.0)


def test_smoke_in_front_dims_text_as_it_does_surfaces():
    found = surfaces(3.0, 200.0)
    text = np.full((*SIZE, 3), 7.0, np.float32), np.ones(SIZE, np.float32), np.full(SIZE, 100.0, np.float32)
    front = even_smoke(np.full(SIZE, 100.0))
    through = np.exp(-0.1)
    shown = composite.place_over(
        found.colour, composite.text_layer(found, composite.taps(found), text, front)
    )
    assert shown == pytest.approx(7.0 * through + 2.0 * (1.0 - through), rel=1e-5)


def test_hot_spots_smaller_than_pixels_are_averaged_and_cold_ground_is_exact():
    """3 rays a pixel on ground of which a third is hot: closer to the mean; cold pixels do not change."""
    random = np.random.default_rng(5)
    radiance = np.full((60, 60), 55.0, np.float32)
    radiance[:, 30:] += 300.0 * random.binomial(3, 1 / 3, (60, 30)).astype(np.float32) / 3.0
    found = composite.average_hot(radiance, 3, 112.0)
    assert np.array_equal(found[:, :28], radiance[:, :28])
    inner = slice(2, -2), slice(32, -2)
    assert found[inner].mean() == pytest.approx(radiance[inner].mean(), rel=0.02)
    assert (found[inner] - 155.0).std() < 0.6 * (radiance[inner] - 155.0).std()
    many = composite.average_hot(radiance, 10**9, 112.0)
    assert many == pytest.approx(radiance, rel=1e-5)


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_layers_add_up_and_are_positive(seed, white):
    random = np.random.default_rng(seed)
    fire, sun, firelight, sky = random.exponential(1.0, (4, *SIZE, 3)).astype(np.float32)
    noisy = fire + sun + firelight + sky
    scene = surfaces(
        0.0,
        random.choice([100.0, 900.0, FAR], SIZE),
        colour=noisy * random.uniform(0.5, 2.0, (*SIZE, 1)).astype(np.float32),
        noisy=noisy,
        fire=fire,
        fire_distance=np.full(SIZE, 200.0, np.float32),
    )
    at = composite.taps(scene)
    smoke = even_smoke(at)
    flames = smoke[..., :3] * random.uniform(0.0, 1.0, (*SIZE, 1, 1)).astype(np.float32)
    marched = np.concatenate([smoke, flames, smoke[..., 3:]], axis=-1)
    composed = composite.compose(scene, at, marched, 1.0 if white else None)
    lights = composite.split_light(scene, composed.solid, sun, firelight, sky * (sky > 1.0))
    if white:
        spread = composite.softening(composed.picture, 2.0)
        composed, lights = composite.soften_highlights(composed, 2.0), [*map(spread, lights)]
    assert composed.solid + composed.fire + composed.smoke == pytest.approx(
        composed.picture, rel=1e-5, abs=1e-5
    )
    assert sum(lights) == pytest.approx(composed.solid, rel=1e-5, abs=1e-5)
    for layer in (composed.solid, composed.fire, composed.smoke, *lights):
        assert layer.min() > -1e-4
    without = composite.compose(scene, at, smoke, 1.0 if white else None)
    without = composite.soften_highlights(without, 2.0) if white else without
    assert without.picture == pytest.approx(composed.picture, rel=1e-5, abs=1e-5)


def test_lights_have_the_shares_of_their_groups():
    noisy, solid, sun, firelight, flames = (
        np.full((*SIZE, 3), value, np.float32) for value in (8.0, 12.0, 3.0, 1.0, 2.0)
    )
    sun, sky, fire = composite.split_light(
        surfaces(12.0, 100.0, noisy=noisy, fire=flames), solid, sun, firelight, np.zeros_like(sun)
    )
    assert [each.mean() for each in (sun, sky, fire)] == pytest.approx([6.0, 4.0, 2.0])


def test_embers_leave_the_light_of_the_sky_next_to_them():
    glow = np.zeros((*SIZE, 3), np.float32)
    glow[SIZE[0] // 2, SIZE[1] // 2] = 50.0, 20.0, 2.0
    sun, firelight = np.full_like(glow, 0.05), np.full_like(glow, 0.02)
    noisy = glow + sun + firelight + 0.1
    scene = surfaces(0.0, 100.0, noisy=noisy, fire=np.zeros_like(glow))
    lights = composite.split_light(scene, noisy, sun, firelight, glow)
    for light, expected in zip(lights, (0.05, 0.1, firelight + glow), strict=True):
        assert light == pytest.approx(np.broadcast_to(expected, light.shape), rel=1e-3, abs=1e-4)


def test_opacity_is_of_smoke_alone():
    found = surfaces(1.0, 100.0)
    at = composite.taps(found)
    marched = np.zeros((*at.shape, 8), np.float32)
    marched[..., 7] = 0.25  # behind opaque flames
    assert composite.smoke_opacity(found, at, marched) == pytest.approx(np.full(SIZE, 0.75))
