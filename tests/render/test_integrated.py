"""A frame of one render and of marched smoke, against the same frame with smoke traced by Cycles."""

from dataclasses import replace
from datetime import UTC, datetime
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.imaging import cryptomatte
from firetwin.jobs import first_picture
from firetwin.passes import masks as masks_pass
from firetwin.render import engine, integrated, layers, pictures
from firetwin.render.picture import Picture
from firetwin.render.sharing import open_session
from firetwin.scene import build, infrared
from firetwin.scene.smoke import shadow
from firetwin.shot import passes
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.sections import Time
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin.smoke import bake, close_up, hot_gas, sources
from firetwin_core import sensor

KEY = CameraKey(0.0, 38.815, -120.56, 500.0, "point", 38.842, -120.552, 300.0)
START = datetime(2014, 9, 17, 21, 30, tzinfo=UTC)


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return tmp_path_factory.mktemp("cache")


@pytest.fixture
def film(near_settings, run, few_cells, cache, tmp_path):
    """Render passes of a frame, after a coarse picture in a folder if wanted; returns its EXRs by pass."""

    def make(*names, draw="integrated", grain=0, coarse=None):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        stage = owned.adopt(bpy.context.scene)
        settings = replace(
            near_settings,
            cache=cache,
            time=Time(start=START, end=START, frames=1),
            smoke=replace(near_settings.smoke, enabled=True, spin_up=900.0, draw=draw),
            cameras=(Camera("drone", Drone(keys=(KEY,))),),
            render=replace(near_settings.render, resolution=(96, 54), samples=4, seed=grain),
        )
        shot = Shot(settings, run)
        ready = lambda frame, ahead: None  # noqa: E731
        if draw == "volume":
            bake.bake(shot)
        else:
            smoke = sources.select(shot)
            ready = lambda frame, ahead: smoke.bricks(frame)  # noqa: E731
        build.build(shot, stage.scene)
        layers.build(settings, stage)
        engine.apply(settings, stage.scene)
        wanted = [Picture("drone", 1, name) for name in names]
        if coarse:
            assert first_picture.write(shot, stage, 1, coarse) == coarse / first_picture.NAME
        out = tmp_path / f"{draw}_{grain}_{'_'.join(names)}"
        out.mkdir()
        with open_session(out, {("drone", name): {"pass": name} for name in passes.known()}) as here:
            pictures.render(shot, stage, here, wanted, ready=ready)
        return {each.name: sensor.read_image(out / each.file("exr")) for each in wanted}

    return make


def uniform_sky(shot, _air, _place, sine):
    """Return the radiance of the sky that Cycles draws alone."""
    return np.full(sine.shape, infrared.sky_radiance(shot))


@pytest.fixture
def both(film, monkeypatch):
    monkeypatch.setattr(close_up, "window", lambda *asked: None)  # which no volume has
    monkeypatch.setattr(hot_gas, "layers", lambda *asked: [])  # nor has it hot gas
    monkeypatch.setattr(infrared, "clear_sky", uniform_sky)  # nor a graded sky
    names = "rgb", "thermal", "depth", "masks"
    return film(*names), film(*names, draw="volume")


def test_marched_smoke_is_the_smoke_that_cycles_walks_through(both):
    ours, theirs = both
    clear, same = ours["masks"][..., 1], theirs["masks"][..., 1]
    assert (same < 0.1).mean() > 0.1, "of the picture, so that there is smoke to compare"
    assert np.abs(clear - same).mean() < 0.01
    smoke, surface = ours["masks"][..., 3], ours["depth"][..., 1]
    assert (smoke[clear < 0.5] < 1.1 * surface[clear < 0.5]).mean() > 0.95
    assert (smoke[clear > 0.995] == np.float32(1.0e10)).all()
    thick = (clear < 0.02) & (same < 0.02)
    light, reference = (found["rgb"][thick].mean(axis=0) for found in both)
    assert light == pytest.approx(reference, rel=0.05)
    away = clear > 0.98
    assert ours["rgb"][away].mean() == pytest.approx(theirs["rgb"][away].mean(), rel=0.05)


def test_heat_and_depth_are_what_renders_of_their_own_give(both):
    ours, theirs = both
    kelvin, reference = (layers["thermal"][..., 0] for layers in both)
    cold = (kelvin < 330.0) & (reference < 330.0)
    off = (kelvin - reference)[cold]
    assert cold.mean() > 0.5
    assert np.sqrt(np.mean(off**2)) < 3.0, "pixels near flames are means of more rays"
    assert abs(off.mean()) < 0.4
    near, far = (layers["depth"][..., 0] for layers in both)
    assert np.mean(np.abs(near - far) < 1e-3 * far) > 0.98
    assert np.array_equal(ours["masks"][..., 2], theirs["masks"][..., 2])


def test_a_pass_is_the_same_whatever_is_made_with_it(film, tmp_path, monkeypatch):
    """Also after the coarse first picture."""
    monkeypatch.setattr(first_picture, "_COLUMNS", 48)
    together = film("rgb", "thermal", "depth", coarse=tmp_path)
    for name in ("thermal", "depth"):
        assert np.array_equal(film(name)[name], together[name])
    coarse = sensor.read_image(tmp_path / first_picture.NAME)
    assert coarse.shape == (28, 48, 3)
    upper, lower = coarse[:9].mean(axis=(0, 1)), coarse[-9:].mean(axis=(0, 1))
    assert upper[2] > lower[2] > 0.02, "the sky is bluer than the ground"


def test_geometry_is_seen_by_the_rays_of_classes():
    assert {name: integrated._centre_layer(name) for name in ("normal", "masks")} == {
        "normal": "masks",
        "masks": "masks",
    }


def test_coarse_outlines_find_the_pixels_that_show_flames(film, monkeypatch):
    built, build = [], integrated.flame_volume.build
    monkeypatch.setattr(
        integrated.flame_volume, "build", lambda *how, **more: built.append(more) or build(*how, **more)
    )
    fine = film("thermal", "masks")
    assert len(built) == 1, "both passes show the same flames"
    monkeypatch.setattr(integrated, "_OUTLINE", 32)
    coarse = film("masks", "thermal")
    assert (fine["masks"][..., 0] == masks_pass.FIRE).any()
    assert np.mean(fine["masks"] == coarse["masks"]) > 0.995
    assert np.abs(fine["thermal"][..., 0] - coarse["thermal"][..., 0]).mean() < 0.2


def test_smoke_has_no_grain(film):
    first, second = (film("rgb", "masks", grain=grain) for grain in (0, 1))
    hidden = (first["masks"][..., 1] < 1e-3) & (second["masks"][..., 1] < 1e-3)
    assert hidden.mean() > 0.1
    assert np.abs(first["rgb"] - second["rgb"])[hidden].mean() < 5e-4, "the rest is the bloom of the flames"
    assert np.abs(first["rgb"] - second["rgb"])[~hidden].mean() > 1e-3


def test_hidden_surfaces_are_not_lit_and_the_picture_is_the_same(film, monkeypatch):
    lit = film("rgb", "depth", "thermal")
    pixels = np.array(bpy.data.images["Firetwin Cell Distances"].pixels[:]).reshape(-1, 4)
    hidden = pixels[:, 1] > 0.0
    assert 0.05 < hidden.mean() < 0.95
    monkeypatch.setattr(integrated.opaque_smoke, "measure", lambda *asked: None)
    whole = film("thermal", "depth", "rgb")
    assert np.abs(lit["rgb"] - whole["rgb"]).mean() < 0.002 * whole["rgb"].mean()
    assert np.array_equal(lit["depth"], whole["depth"])
    assert np.array_equal(lit["thermal"], whole["thermal"])


def test_rays_from_surfaces_meet_the_shadow_of_smoke(film):
    film("depth")
    (thing,) = (each for each in bpy.data.objects if each.name == "Firetwin Smoke Shadow")
    assert thing.visible_shadow
    assert thing.visible_diffuse, "rays that leave the ground find the sky"
    assert thing.visible_transmission, "so do rays through leaves"
    assert not any(getattr(thing, f"visible_{ray}") for ray in ("camera", "glossy", "volume_scatter"))


def test_smoke_dims_skylight_on_the_ground(film, monkeypatch):
    cast = shadow.Shadow.cast

    def ground(skylight, *names):
        def dim(surface, stage, smoke):
            cast(surface, stage, smoke)
            pixels = np.zeros((*surface.places.shape[:2], 4), np.float32)
            pixels[..., 1] = skylight
            surface.image.pixels.foreach_set(pixels.ravel())
            surface.image.update()

        monkeypatch.setattr(shadow.Shadow, "cast", dim)
        made = film(*names)
        clear = (made["masks"][..., 1] > 0.95) & (made["masks"][..., 0] == masks_pass.GROUND)
        assert clear.any()
        return made["rgb"][clear].mean()

    assert ground(0.0, "rgb", "masks") < 0.98 * ground(1.0, "masks", "rgb"), "haze is most of it"


def test_settings_decide_how_smoke_is_drawn(near_settings, run):
    def drawn(engine="cycles", **smoke):
        settings = replace(
            near_settings,
            smoke=replace(near_settings.smoke, **({"enabled": True} | smoke)),
            render=replace(near_settings.render, engine=engine),
        )
        return sources.is_integrated(Shot(settings, run))

    assert drawn()
    assert drawn(enabled=False)
    assert drawn(method="preview")
    for other in ({"draw": "volume"}, {"engine": "eevee"}):
        assert not drawn(**other)


def test_layers_of_the_picture_add_up(film, tmp_path):
    layered = film("rgb", "comp")
    channels = sensor.read_channels(
        tmp_path / "integrated_0_rgb_comp" / Picture("drone", 1, "comp").file("exr")
    )

    def layer(name):
        return np.stack([channels[name + channel] for channel in "RGB"], axis=-1)

    names = "", "solid.", "fire.", "smoke.", "light_sun.", "light_sky.", "light_fire.", "bloom."
    assert set(channels) == {name + channel for name in names for channel in "RGB"} | {"A", "smoke.A"}
    picture, solid, fire, smoke, sun, sky, firelight, bloom = map(layer, names)
    half = {"rel": 2e-3, "abs": 1e-4}
    assert solid + fire + smoke == pytest.approx(picture, **half)
    assert sun + sky + firelight == pytest.approx(solid, **half)
    assert min(each.min() for each in (solid, fire, smoke, sun, firelight)) > -1e-3
    assert bloom.min() > -0.01 * picture.max()
    assert np.array_equal(film("rgb")["rgb"], layered["rgb"]), "layers change nothing"
    ground = (channels["A"] > 0.99) & (channels["smoke.A"] < 0.02)
    assert sun[ground].mean() > sky[ground].mean() > 0.0
    assert channels["smoke.A"].max() > 0.9
    assert fire[..., 0].max() > 1.0


def test_one_module_adds_a_marched_pass(film, monkeypatch):
    def march(eye, _frame):
        return {"opacity": eye.smoke_opacity[..., None], "glow.": eye.channels["Firetwin Glow"]}

    veil = passes.MarchedPass(name="veil", files=("exr",), aovs=("Firetwin Glow",))
    known = passes.known() | {"veil": veil}
    modules = passes.modules() | {"veil": SimpleNamespace(march=march)}
    monkeypatch.setattr(passes, "modules", lambda: modules)
    monkeypatch.setattr(passes, "known", lambda: known)
    made = film("veil")["veil"]
    assert made.shape == (54, 96, 4)
    assert made.max() > 0.9


def test_data_agrees_with_the_passes_that_it_is_made_from(film, tmp_path):
    film("masks", "data")
    out = tmp_path / "integrated_0_masks_data"
    channels, masks = (
        sensor.read_channels(out / Picture("drone", 1, name).file("exr")) for name in ("data", "masks")
    )
    hashes = dict(zip(masks_pass.NAMES, cryptomatte.identify(masks_pass.NAMES), strict=True))

    def matte(name):
        ranks = [(f"CryptoClass{layer:02d}.", pair) for layer in range(3) for pair in ("rg", "ba")]
        return sum(
            np.where(channels[layer + pair[0]] == hashes[name], channels[layer + pair[1]], 0.0)
            for layer, pair in ranks
        )

    for name in ("ground", "tree", "smoke", "fire"):
        here = masks["class"] == masks_pass.NAMES.index(name)
        assert matte(name)[here].mean() > 0.5 > 4.0 * matte(name)[~here].mean()
    assert sum(matte(name) for name in hashes) == pytest.approx(1.0, abs=1e-5)
    trees = sum(channels[f"CryptoTree{layer:02d}.{part}"] for layer in range(3) for part in "ga")
    assert 0.0 < trees.max() <= 1.0 + 1e-5
    solid = channels["Z"] < 1.0e9
    assert np.hypot(channels["N.X"], np.hypot(channels["N.Y"], channels["N.Z"]))[solid] == pytest.approx(
        1.0, abs=1e-3
    )
    assert not channels["forward.u"].any(), "a film of one frame"
    assert channels["thermal.kelvin"].max() > 600.0
