"""One small frame of every pass of one run, rendered as the worker process does, and what each must show."""

import levels_run
import numpy as np
import pytest
import rendered
from firetwin.passes import masks
from firetwin.render import manifest, plan
from firetwin.render.picture import Picture
from firetwin.render.store import Store
from firetwin.shot import passes
from firetwin.shot.light import exposure
from firetwin_core import sensor

NAMES = [
    name
    for name, each in passes.known().items()
    if not passes.compares(name)
    and not isinstance(each, passes.MarchedPass)  # Cycles draws this scene's smoke
    and "forecast" not in each.aspects  # and has no ensemble
]

SCENE = """\
run = "{run}"
[time]
start = 2014-09-17T21:30:00Z
frames = 1
[terrain]
near_radius = 0.0
apron = 20000.0
[forest]
density = "paper"
budget = 2000
[smoke]
voxel_size = 120.0
[render]
resolution = [64, 36]
samples = 2
denoise = false
passes = {passes}
[[cameras]]
name = "drone"
keys = [{{at = 0, latitude = 38.825, longitude = -120.56, height = 500, target = "fire"}}]
"""


@pytest.fixture(scope="module")
def film(run_folder, tmp_path_factory):
    """Render it: (shot, folder of its files, messages)."""
    folder, names = tmp_path_factory.mktemp("frame"), "[" + ", ".join(f'"{name}"' for name in NAMES) + "]"
    text = SCENE.format(run=levels_run.write(run_folder, folder / "levels"), passes=names)
    said = []
    return *rendered.everything(folder, text, said.append), said


@pytest.fixture(scope="module")
def frame(film):
    """Return (image of a pass by name and suffix, files that the plan says)."""
    shot, out, _ = film

    def image(name, suffix="exr"):
        return np.asarray(sensor.read_image(out / Picture("drone", 1, name).file(suffix)))

    return image, [out / path for each in plan.pictures(shot) for path in each.files()]


def test_every_file_is_there(frame):
    _image, files = frame
    assert {path.parent.name for path in files} == set(NAMES)
    assert not [path for path in files if not path.exists()]


def test_the_exposure_of_the_picture_is_in_exr_store_and_log(film):
    openexr = pytest.importorskip("OpenEXR")
    shot, out, said = film
    stops = exposure.at(shot, np.array([1]))[0]
    header = openexr.File(str(out / Picture("drone", 1, "rgb").file("exr"))).header()
    assert header["exposureStops"] == pytest.approx(stops, abs=1e-3)
    assert header["worldOrigin"].split()[0] == str(shot.local_frame.latitude)
    assert f"drone is exposed by {stops:.1f} stops" in said
    with Store(out) as store:
        store.export()
    entries = manifest.read(out)["files"].values()
    exposed = {each["pass"]: each["exposure"] for each in entries if "exposure" in each}
    assert exposed == dict.fromkeys(exposed, pytest.approx(stops, abs=1e-3))
    assert exposed.keys() == {name for name in NAMES if passes.known()[name].is_exposed} > {"rgb"}
    assert not {"depth", "masks", "thermal"} & exposed.keys()


def test_flames_are_brighter_and_redder_than_the_rest(frame):
    image, _files = frame
    picture, fire = image("rgb"), image("masks")[..., 0] == masks.FIRE
    assert 5 <= fire.sum() <= 60
    assert picture[fire, 0].mean() > 8.0 * picture[~fire, 0].mean()
    assert picture[fire, 0].mean() > 2.0 * picture[fire, 1].mean() > 4.0 * picture[fire, 2].mean()


def test_temperatures_are_those_of_sky_ground_and_flames(frame):
    image, _files = frame
    kelvin, radiance = np.moveaxis(image("thermal"), -1, 0)
    kind = image("masks")[..., 0]
    assert np.median(kelvin[kind == masks.SKY]) == pytest.approx(250.0, abs=2e-3)
    assert 290.0 < np.median(kelvin[kind == masks.GROUND]) < 320.0
    assert np.median(kelvin[kind == masks.BURNED]) > np.median(kelvin[kind == masks.GROUND]) + 10.0
    assert np.median(kelvin[kind == masks.FIRE]) > 400.0
    assert radiance == pytest.approx(sensor.radiance(kelvin), rel=1e-5)
    grey = image("thermal", "png")
    assert np.array_equal(grey[..., 0], grey[..., 2])
    assert grey[kelvin > 600.0].min() > grey[kelvin < 320.0].max()


def test_depth_normals_and_classes_agree_on_where_the_sky_is(frame):
    image, _files = frame
    depth, normal, kind = image("depth")[..., 0], image("normal"), image("masks")[..., 0]
    sky, clear = kind == masks.SKY, kind != masks.SMOKE
    length = np.linalg.norm(normal, axis=2)
    assert clear.mean() > 0.3
    assert np.mean(((depth > 1e9) == sky)[clear]) > 0.98
    assert np.mean(((length == 0.0) == sky)[clear]) > 0.98
    assert length[~sky & (length > 0.0)] == pytest.approx(1.0, abs=0.02)  # bent by filtering at edges alone
    assert 500.0 < depth[depth < 1e9].min() < 1000.0  # the drone is 500 m above the ground, and looks ahead
    assert depth[depth < 1e9].max() < 40_000.0


def test_every_class_is_there_in_its_colour(frame):
    image, _files = frame
    kind = image("masks")[..., 0].astype(int)
    assert set(np.unique(kind)) == {
        masks.SKY,
        masks.GROUND,
        masks.BURNED,
        masks.TREE,
        masks.SMOKE,
        masks.FIRE,
    }
    colour = np.rint(255.0 * image("masks", "png")).astype(int)
    assert np.array_equal(colour, np.array(masks.COLOURS)[kind])


def test_pictures_made_of_others_show_them(frame):
    image, _files = frame
    kelvin, kind = image("thermal")[..., 0], image("masks")[..., 0]
    hot, cold = kelvin > 600.0, (kelvin < 320.0) & (kind == masks.GROUND)  # smoke and sky are bright
    plain = image("rgb", "png")
    over = image("overlay", "png")
    assert np.abs(over - plain)[hot].mean() > np.abs(over - plain)[cold].mean()
    for name in ("imager_short", "imager_long", "thermal_map"):
        assert image(name, "png")[hot].mean() > image(name, "png")[cold].mean()
    assert image("edl", "png")[cold].mean() > 0.05
    assert image("fused", "png").shape == (720, 1280, 3)
    assert image("fused", "png").std() > 0.1
