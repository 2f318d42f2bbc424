"""Ray marching through bricks of smoke, against closed forms."""

import numpy as np
import pytest
from firetwin_core import volume
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples
from march_light import NO_LIGHT

FIELDS = ("density", "fresh", "sun", "sky", "glow")
FAR = np.float32(1e9)


def light(**changes):
    return volume.Illumination(**(NO_LIGHT | changes))


def bricks(density, voxel=10.0, origin=(0.0, 0.0, 0.0), **fields):
    density = np.asarray(density, np.float32)
    full = {name: np.broadcast_to(np.float32(fields.get(name, 0.0)), density.shape) for name in FIELDS[1:]}
    return volume.Bricks(density, **full, voxel_size=voxel, origin=origin)


def slab(thickness, count=(40, 20, 20), **fields):
    """Even smoke that is 390 m long along x."""
    return bricks(np.full(count, thickness), **fields)


def along_x(distances, start=-100.0):
    return ([start, 95.0, 95.0], [[1.0, 0.0, 0.0]], np.reshape(np.float32(distances), (1, -1)))


@given(thickness=st.floats(1e-4, 0.02), end=st.floats(0.0, 600.0))
@settings(max_examples=examples(60), deadline=None)
def test_even_smoke_lets_through_what_beer_and_lambert_say(thickness, end):
    found = volume.march([slab(thickness)], *along_x([end]), light())[0, 0]
    inside = np.clip(end - 100.0, 0.0, 390.0)
    expected = np.exp(-thickness * inside)
    assert found[3] == pytest.approx(expected if expected >= 1e-3 else 0.0, rel=2e-3, abs=1.01e-3)
    assert np.all(found[:3] == 0.0)


def test_smoke_as_bright_all_over_fades_to_its_own_light():
    lit = light(old=(0.5, 0.5, 0.5), sky=(2.0, 1.0, 4.0))
    found = volume.march([slab(0.005, sky=0.8)], *along_x([FAR]), lit)[0, 0]
    through = np.exp(-0.005 * 390.0)
    assert found[3] == pytest.approx(through, rel=1e-3)
    assert found[:3] == pytest.approx(0.5 * 0.8 * np.array([2.0, 1.0, 4.0]) * (1.0 - through), rel=1e-3)


def test_density_that_rises_steadily_is_integrated_as_its_line():
    density = np.broadcast_to(np.linspace(0.0, 0.01, 40)[:, None, None], (40, 20, 20))
    found = volume.march([bricks(density)], *along_x([FAR]), light())[0, 0]
    assert found[3] == pytest.approx(np.exp(-0.005 * 390.0), rel=1e-3)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_light_scattered_once_is_spread_after_henyey_and_greenstein(way):
    lit = light(old=(1.0, 1.0, 1.0), sun=(3.0, 3.0, 3.0), sun_direction=(1.0, 0.0, 0.0), anisotropy=0.4)
    rays = [195.0 - way * 300.0, 95.0, 95.0], [[way, 0.0, 0.0]], [[FAR]]
    found = volume.march([slab(0.02, sun=0.9)], *rays, lit)[0, 0]
    g, cosine = 0.4, way  # of the angle between light's way, away from the sun, and the way to the eye
    phase = (1.0 - g * g) / (1.0 + g * g - 2.0 * g * cosine) ** 1.5 / (4.0 * np.pi)
    assert found[:3] == pytest.approx(3 * [3.0 * 0.9**4 * phase], rel=2e-3)


@pytest.mark.parametrize("sky", [0.0, 0.4, 1.0])
def test_flame_light_follows_the_smoke_around_and_not_the_extinction_of_a_voxel(sky):
    """A share by extinction drew dark lines where smoke is thin between voxels."""
    white = np.array([0.9, 0.8, 0.7])
    lit = light(old=white, fresh=white, glow=(2.0, 1.0, 0.5), thin=0.1)
    for thickness in (0.001, 0.02):
        found = volume.march([slab(thickness, sky=sky, glow=0.5)], *along_x([FAR]), lit)[0, 0]
        share = 1.0 - 0.9 * sky
        assert found[:3] / (1.0 - found[3]) == pytest.approx(
            0.5 * share * white * np.array([2.0, 1.0, 0.5]), rel=2e-3
        )


@given(st.lists(st.floats(0.0, 700.0, width=32), min_size=1, max_size=8), st.integers(0, 2**31))
@settings(max_examples=examples(50), deadline=None)
def test_taps_are_read_in_any_order_and_what_comes_through_only_falls(distances, seed):
    random = np.random.default_rng(seed)
    density = random.uniform(0.0, 0.01, (30, 20, 20)) * (random.uniform(size=(30, 1, 1)) > 0.5)
    layers = [bricks(density, sky=1.0)]
    lit = light(old=(0.9, 0.8, 0.7), sky=(1.0, 1.0, 1.0))
    found = volume.march(layers, *along_x(distances), lit)[0]
    order = np.argsort(distances, kind="stable")
    assert np.all(np.diff(found[order, 3]) <= 1e-6)
    assert np.all(np.diff(found[order, 0]) >= -1e-4)
    alone = volume.march(layers, *along_x([max(distances)]), lit)[0, 0]
    assert found[order[-1]] == pytest.approx(alone, abs=5e-3)


def test_layers_add_up_and_do_not_know_their_order():
    outer, inner = slab(0.002), bricks(np.full((10, 20, 20), 0.004), origin=(100.0, 0.0, 0.0))
    found = [
        volume.march(layers, *along_x([FAR]), light())[0, 0, 3] for layers in ([outer, inner], [inner, outer])
    ]
    assert found[0] == pytest.approx(np.exp(-0.002 * 390.0 - 0.004 * 90.0), rel=1e-3)
    assert found[0] == pytest.approx(found[1], rel=1e-6)


def test_a_camera_in_geostationary_orbit_sees_what_one_nearby_does():
    random = np.random.default_rng(3)
    layers = [bricks(random.uniform(0.0, 0.01, (40, 40, 40)), sky=1.0)]
    lit = light(old=(0.9, 0.8, 0.7), sky=(1.0, 1.0, 1.0))
    toward = np.array([0.3, -0.5, -0.81])
    toward /= np.linalg.norm(toward)
    place = np.array([195.0, 195.0, 195.0])
    near, far = (
        volume.march(layers, place - toward * away, [toward], [[FAR]], lit)[0, 0] for away in (1000.0, 3.6e7)
    )
    assert far == pytest.approx(near, rel=1e-4)


def test_haze_before_smoke_is_that_of_koschmieder():
    lit = light(air=3 * (1.0,), horizon=3 * (1.0,), haze=(1e-3, 0.0), haze_height=(1e9, 1e9))
    found = volume.march([slab(0.3)], *along_x([FAR], start=-1000.0), lit)[0, 0]
    assert found[:3] == pytest.approx(3 * [1.0 - np.exp(-1.0)], rel=0.01)


@pytest.mark.parametrize(("away", "thick"), [(150.0, 0.0), (700.0, 0.5), (5000.0, 1.0)])
def test_layers_of_haze_add_up_and_take_the_colour_of_the_horizon(away, thick):
    lit = light(air=(1.0, 0.0, 0.0), horizon=(0.0, 1.0, 0.0), haze=(4e-4, 6e-4), haze_height=(1e9, 1e9))
    red, green, _, _ = volume.march([slab(0.3)], *along_x([FAR], start=-away), lit)[0, 0]
    assert red + green == pytest.approx(1.0 - np.exp(-1e-3 * away), rel=0.03)
    assert green / (red + green) == pytest.approx(thick, abs=0.01)


def test_optical_depth_is_the_logarithm_of_what_comes_through():
    random = np.random.default_rng(5)
    layers = [bricks(random.uniform(0.0, 0.004, (40, 20, 20)))]
    start, toward, end = along_x([FAR])
    depth = volume.optical_depth(layers, start, toward, end[:, 0], step=0.5)
    assert np.exp(-depth[0]) == pytest.approx(
        volume.march(layers, start, toward, end, light())[0, 0, 3], rel=1e-3
    )


def test_smoke_is_opaque_where_its_optical_depth_reaches_the_limit():
    thin, thick = bricks(np.full((40, 20, 20), 0.004)), bricks(np.full((40, 20, 20), 0.016))
    start, toward, _ = along_x([FAR])
    block = 8 * 10.0  # m, which counts as a whole
    for layers, extinction in (([thin], 0.004), ([thin, thick], 0.02)):
        away = volume.opaque_distance(layers, start, toward, 0.5, 1.2)[0]
        assert 0.0 <= away - (100.0 + 1.2 / extinction) < block
    assert np.isinf(volume.opaque_distance([thin], start, toward, 0.5, 2.0)).all(), "1.56 in all"
    assert np.isinf(volume.opaque_distance([thin], start, [[-1.0, 0.0, 0.0]], 0.5, 0.1)).all()


def warmth(kelvin=300.0, lapse=0.0, absorption=0.1):
    return {
        "kelvin": np.full((3, 3), kelvin),
        "elevation": np.zeros((3, 3)),
        "corner": (-500.0, -500.0),
        "spacing": (500.0, 500.0),
        "lapse": lapse,
        "radiance": np.arange(0.0, 161.0),
        "coldest": 200.0,
        "kelvin_step": 1.0,
        "absorption": absorption,
    }


def test_in_the_infrared_smoke_glows_as_the_air_and_absorbs_its_part():
    start, toward, end = along_x([FAR])
    found = volume.march_infrared([slab(0.01)], start, toward, end[:, 0], **warmth())[0]
    through = np.exp(-0.1 * 0.01 * 390.0)
    assert found == pytest.approx([100.0 * (1.0 - through), through], rel=1e-3)


def test_in_the_infrared_air_is_colder_higher_up():
    start, toward, end = along_x([FAR])
    found = volume.march_infrared([slab(0.01)], start, toward, end[:, 0], **warmth(lapse=0.1))[0]
    through = np.exp(-0.1 * 0.01 * 390.0)
    assert found[0] == pytest.approx((100.0 - 0.1 * 95.0) * (1.0 - through), rel=1e-3)


def test_only_blocks_with_smoke_take_memory():
    density = np.zeros((65, 65, 65), np.float32)
    density[40, 20, 12] = 0.01
    found = bricks(density)
    assert found.used == 2  # the voxel lies on the face between two blocks
    assert found.bytes == found.used * 9**3 * 8 * 2


@given(st.floats(0.0, 70_000.0))
def test_half_floats_are_those_of_numpy(value):
    thick = bricks(np.full((9, 9, 9), np.float32(value)))
    depth = volume.optical_depth(
        [thick], [-10.0, 40.0, 40.0], [[1.0, 0.0, 0.0]], [FAR], step=0.25, max_depth=1e30
    )
    expected = float(np.float16(min(value, 65504.0))) if value > 2.5e-5 else 0.0
    assert depth[0] == pytest.approx(80.0 * expected, rel=1e-5)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"origins": [[0.0, 0.0, 0.0]] * 3}, "origin"),
        ({"distances": [[1.0], [1.0]]}, "distances"),
        ({"directions": [1.0, 0.0, 0.0]}, "directions"),
        ({"layers": 5}, "four layers"),
    ],
)
def test_what_does_not_fit_is_refused(change, text):
    given = {"origins": [0.0, 0.0, 0.0], "directions": [[1.0, 0.0, 0.0]] * 4, "distances": [[1.0]] * 4}
    given |= {name: value for name, value in change.items() if name != "layers"}
    with pytest.raises(ValueError, match=text):
        volume.march([slab(0.01)] * change.get("layers", 1), **given, light=light())


def test_fields_of_smoke_have_one_shape():
    with pytest.raises(ValueError, match="fresh"):
        volume.Bricks(
            *(np.zeros(shape) for shape in ((4, 4, 4), (4, 4, 5))), *3 * [np.zeros((4, 4, 4))], 1.0, (0, 0, 0)
        )


def test_any_number_of_threads_gives_the_same():
    import firetwin_core

    random = np.random.default_rng(7)
    layers = [bricks(random.uniform(0.0, 0.01, (40, 40, 40)), sky=1.0)]
    lit = light(old=(0.9, 0.8, 0.7), sky=(1.0, 1.0, 1.0))
    toward = random.normal(size=(500, 3))
    toward /= np.linalg.norm(toward, axis=1, keepdims=True)
    found = []
    for threads in (1, 0):
        firetwin_core.set_threads(threads)
        found.append(volume.march(layers, [195.0, 195.0, 195.0], toward, np.full((500, 1), FAR), lit))
    assert np.array_equal(*found)


def test_parts_are_the_same_march_without_flames():
    lit = light(old=(0.5, 0.5, 0.5), sky=(2.0, 1.0, 4.0))
    ends = np.float32([200.0, FAR])
    found = volume.march([slab(0.005, sky=0.8)], *along_x([ends]), lit, parts=True)[0]
    assert np.array_equal(found[:, :4], volume.march([slab(0.005, sky=0.8)], *along_x([ends]), lit)[0])
    assert np.all(found[:, 4:7] == 0.0)
    assert np.array_equal(found[:, 7], found[:, 3])
