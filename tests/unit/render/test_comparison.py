"""Several runs in one scene file: same cameras and clock, where each has burned, and what compares them."""

import numpy as np
import pytest
import shapely
from firetwin.data import sample, stored
from firetwin.errors import InputError, UsageError
from firetwin.imaging import split_screen
from firetwin.passes import difference
from firetwin.render import fingerprint, plan
from firetwin.run import arrival_grid, front
from firetwin.run.score import shapes
from firetwin.shot import comparison, passes
from firetwin.shot.cameras import path
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.runs import scene_runs
from firetwin.shot.settings import Camera
from firetwin.shot.source import ShotSource
from firetwin.shot.surface import fronts
from small_run import RUN_TOML, small_fields, write_field

FIRST = (slice(2, 6), slice(2, 8))  # fuel cells that burn
OTHER_START = "2014-09-16T21:43:00-07:00"  # two minutes earlier


def write_run(folder, toml, **fields):
    folder.mkdir()
    (folder / "run.toml").write_text(toml)
    for name, values in fields.items():
        write_field(folder, name, values, "npy")
    return folder


def arrival(shape, cells, first=0.0, step=10.0):
    """s; the front goes east a column in `step` s."""
    time = np.full(shape, np.nan, np.float32)
    time[cells] = first + step * np.arange(time[cells].shape[1])
    return time


@pytest.fixture
def scene(tmp_path):
    """Two runs of equal fires, on other grids and with other starts: the second burns two columns less."""
    toml = RUN_TOML.replace("[units]", '[units]\nfuel_arrival_time = "s"')
    fields = small_fields()
    write_run(tmp_path / "a", toml, **fields, fuel_arrival_time=arrival((8, 10), FIRST))
    more, less = 3, 1  # cells to the south and west, and to the north and east, of the model's grid
    pad, fine = ((more, less),) * 2, ((2 * more, 2 * less),) * 2
    wide = {
        "latitude": fields["latitude"][0] + 0.003 * np.arange(-more, 4 + less),
        "longitude": fields["longitude"][0] + 0.004 * np.arange(-more, 5 + less),
        "elevation": np.pad(fields["elevation"], pad, "edge"),
        "fuel_latitude": fields["fuel_latitude"][0] + 0.0015 * np.arange(-2 * more, 8 + 2 * less),
        "fuel_longitude": fields["fuel_longitude"][0] + 0.002 * np.arange(-2 * more, 10 + 2 * less),
        "surface_fuel": np.pad(fields["surface_fuel"], fine, "edge"),
        "canopy_fuel": np.pad(fields["canopy_fuel"], fine, "edge"),
        "heat_flux": np.zeros((6, 4 + more + less, 5 + more + less), np.float32),
    }
    cells = (slice(2 + 2 * more, 6 + 2 * more), slice(2 + 2 * more, 6 + 2 * more))
    wide["fuel_arrival_time"] = arrival((8 + 2 * (more + less), 10 + 2 * (more + less)), cells, 120.0)
    other = toml.replace("2014-09-16T21:45:00-07:00", OTHER_START).replace('name = "Small"', 'name = "Wide"')
    write_run(tmp_path / "b", other, **wide)
    file = tmp_path / "scene.toml"
    file.write_text(
        'run = "a"\n[time]\nframes = 3\n[terrain]\napron = 0.0\nnear_radius = 0.0\n[smoke]\nenabled = false\n'
        '[render]\npasses = ["rgb"]\n[[runs]]\nname = "wide"\npath = "b"\n[[cameras]]\n'
        'keys = [{latitude = 38.904, longitude = -120.594, height = 900, target = "point", '
        "target_latitude = 38.906, target_longitude = -120.592}]\n"
        '[[cameras]]\nname = "ir"\nkind = "mounted"\nfollows = "drone"\n'
    )
    return file


def test_a_camera_is_at_the_same_place_of_the_earth_and_looks_the_same_way(scene):
    shot = ShotSource(scene=str(scene)).shot()
    for name in ("drone", "ir"):
        (here,), other = shot.for_camera(name).paths, comparison.for_view(shot, f"{name}@wide")
        (there,) = other.paths
        assert (other.run.name, there.camera.name) == ("Wide", f"{name}@wide")
        for points in ("position", "target"):
            places = [
                each.local_frame.reverse(getattr(view, points))
                for each, view in ((shot, here), (other, there))
            ]
            np.testing.assert_allclose(*(np.stack(place[:2]) for place in places), rtol=0, atol=1e-11)
            np.testing.assert_allclose(places[0][2], places[1][2], rtol=0, atol=1e-6)
        compass = [
            view.rotation[0].T @ np.stack(path.compass(each.local_frame, view.position[0]), axis=-1)
            for each, view in ((shot, here), (other, there))
        ]
        np.testing.assert_allclose(*compass, atol=1e-7)
        assert shot.utc(2) == other.utc(2)
    assert abs(shot.local_frame.latitude - other.local_frame.latitude) > 0.002


def test_a_run_without_the_shots_moments_is_named_with_its_line(scene):
    text = scene.read_text()
    scene.write_text(text.replace("[time]", "[time]\nstart = 2014-09-16T21:46:00-07:00"))
    ShotSource(scene=str(scene)).shot()
    toml = scene.parent / "b" / "run.toml"
    toml.write_text(toml.read_text().replace("T21:43", "T21:42"))  # it ends at 21:47; the first does so too
    ShotSource(scene=str(scene)).shot()
    toml.write_text(toml.read_text().replace("T21:42", "T21:41"))
    with pytest.raises(InputError) as caught:
        ShotSource(scene=str(scene)).shot()
    assert (caught.value.line, caught.value.column) == (14, 1)
    assert caught.value.reason.startswith('run "wide" has 2014-09-17T04:41:00Z to 2014-09-17T04:46:00Z')
    assert (
        "end within 2014-09-17T04:45:00Z to 2014-09-17T04:46:00Z, which all runs have" in caught.value.reason
    )
    scene.write_text(text.replace('path = "b"', 'path = "gone"'))
    with pytest.raises(InputError, match=r"scene.toml:13:1: runs.path: .*gone"):
        ShotSource(scene=str(scene)).shot()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('name = "wide"\npath = "b"\n', 3 * 'name = "w{}"\n[[runs]]\n', "4 tables; .* at most 3"),
        ('path = "b"\n', 'path = "b"\n[[runs]]\nname = "wide"\n', 'a second run is named "wide"'),
        ('name = "ir"', 'name = "Drone_at_wide"', '"drone@wide" and another view would write the files'),
        ('passes = ["rgb"]\n[[runs]]\nname = "wide"\npath = "b"', 'passes = ["split"]', r"add \[\[runs"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_said(scene, old, new, words):
    for number in range(new.count("{}")):
        new = new.replace("{}", str(number), 1)
    scene.write_text(scene.read_text().replace(old, new))
    with pytest.raises(InputError, match=words):
        ShotSource(scene=str(scene)).shot()


def test_one_of_the_runs_is_built_by_its_name(scene):
    shot = ShotSource(scene=str(scene), beside="wide").shot()
    assert (shot.run.name, scene_runs.views(shot.settings)) == ("Wide", ["drone@wide", "ir@wide"])
    assert shot.other_runs().keys() == {"a"}
    with pytest.raises(UsageError, match=r'--run: there is no "none" in .*; the scene has wide'):
        ShotSource(scene=str(scene), beside="none").shot()


def names(pictures):
    return [f"{each.camera} {each.frame} {each.name}" for each in pictures]


def test_what_compares_is_planned_last_with_all_that_it_is_made_from(scene):
    shot = ShotSource(scene=str(scene)).shot()
    assert names(plan.pictures(shot, "2", "drone")) == ["drone 2 rgb", "drone@wide 2 rgb"]
    assert names(plan.pictures(shot, "2", "ir@wide")) == ["ir@wide 2 rgb"]
    assert names(plan.pictures(shot, "2", "drone", "difference,split")) == [
        "drone 2 rgb", "drone 2 depth", "drone@wide 2 rgb", "drone 2 split", "drone 2 difference",
    ]  # fmt: skip
    with pytest.raises(
        UsageError, match='there is no "drone@no"; the scene has drone, ir, drone@wide, ir@wide'
    ):
        plan.pictures(shot, camera="drone@no")
    scene.write_text(scene.read_text().replace('[[runs]]\nname = "wide"\npath = "b"\n', ""))
    with pytest.raises(UsageError, match='"split" compares runs'):
        plan.pictures(ShotSource(scene=str(scene)).shot(), names="split")


def test_another_run_makes_other_pictures_of_its_own_and_of_what_shows_it(scene):
    pairs = {("drone", "rgb"), ("drone@wide", "rgb"), ("drone", "split"), ("drone", "difference")}

    def changed(edit):
        before = fingerprint.compute_pairs(ShotSource(scene=str(scene)).shot(), pairs)
        edit()
        after = fingerprint.compute_pairs(ShotSource(scene=str(scene)).shot(), pairs)
        return pairs - {pair for pair in pairs if before[pair] == after[pair]}

    def burn(name):
        file = scene.parent / name / "fuel_arrival_time.npy"
        return lambda: np.save(file, np.load(file) + np.float32(1.0))

    assert changed(burn("b")) == pairs - {("drone", "rgb")}
    assert changed(burn("a")) == pairs  # the cameras fly by the first run
    scene.write_text(scene.read_text() + "[fire]\nfronts = true\n")
    assert changed(burn("b")) == pairs


def random_fire(seed, shape=(30, 40)):
    """Arrival times (s) of a run with fronts, holes and cells that never burn."""
    rng = np.random.default_rng(seed)
    y, x = np.indices(shape) / 6.0
    field = sum(
        rng.uniform(0.5, 1) * np.sin(rng.uniform(0.3, 1) * x + a) * np.cos(y + b)
        for a, b in rng.uniform(0, 6, (4, 2))
    )
    field = 600.0 * (field - field.min()) / np.ptp(field)
    field[rng.uniform(size=shape) < 0.05] = np.nan
    return field


@pytest.mark.parametrize("seed", range(2))
def test_a_front_is_the_outline_that_scores_know(seed):
    time = random_fire(seed)
    latitude, longitude = np.arange(30.0), np.arange(40.0)
    shape = shapes.of_front(longitude, latitude, time - 250.0)  # by contourpy
    y, x, after = front.contour(arrival_grid.fill_unburned(np.pad(time - 250.0, 1, constant_values=np.nan)))
    y, x = y - 1.0, x - 1.0
    area = 0.5 * np.sum(x * y[after] - x[after] * y)  # burned ground is left, so holes count negative
    assert area == pytest.approx(shape.area, rel=0.02)  # the two join corners in another way
    away = shapely.distance(shape.boundary, shapely.points(x, y))
    assert np.mean(away < 1e-9) > 0.97
    assert sorted(after) == list(range(len(after)))


def test_what_has_burned_is_within_the_front(scene):
    run = ShotSource(scene=str(scene)).shot().others["wide"]
    reach = front.reach(run)
    rng = np.random.default_rng(5)
    latitude, longitude = rng.uniform(38.89, 38.92, 4000), rng.uniform(-120.62, -120.57, 4000)
    burned = reach.burned(latitude, longitude + 360.0, 135.0)
    y, x, after = reach.line(135.0)
    start, ring = 0, [0]
    while (start := after[start]) != 0:
        ring.append(start)
    shape = shapely.Polygon(np.column_stack([x, y])[ring])
    clear = shapely.distance(shape.boundary, shapely.points(longitude, latitude)) > 2e-4
    inside = shapely.contains_xy(shape, longitude, latitude)
    assert 0.01 < inside.mean() < 0.5
    assert np.array_equal(burned[clear] == 1.0, inside[clear])
    assert np.isnan(reach.burned([0.0], [0.0], 135.0)).all()


def test_the_difference_is_told_by_the_places_that_pixels_show(scene):
    shot = ShotSource(scene=str(scene)).shot()
    latitude = shot.run.fuel_latitude[[3, 3, 3, 0]]
    longitude = shot.run.fuel_longitude[[3, 6, 9, 0]]
    points = shot.local_frame.forward(latitude, longitude, np.full(4, 1000.0)).reshape(1, 4, 3)
    points[0, 3] = np.nan
    (last,) = difference.classes(shot, points, 3)
    assert last.tolist() == [[1, 2, 0, 0]]
    (first,) = difference.classes(shot, points, 1)  # columns 3 and 6 burn 10 and 40 s after it
    assert first.tolist() == [[0, 0, 0, 0]]


def test_lines_of_a_front_lie_over_the_ground_each_for_its_frame(scene):
    shot = ShotSource(scene=str(scene)).shot()
    found = fronts.lines(shot, shot.others["wide"])
    assert set(found.start) == {30.0, 90.0} or set(found.start) == {-np.inf, 30.0, 90.0}
    up = shot.ground.up(*found.points[:, :2].T)
    np.testing.assert_allclose(found.points[:, 2] - up, fronts.ABOVE, atol=0.1)
    _, longitude, _ = shot.local_frame.reverse(found.points[found.end == np.inf])
    edges = shot.run.fuel_longitude[[2, 5]] + [-0.001, 0.001]  # half-way to cells that never burn
    np.testing.assert_allclose([longitude.min(), longitude.max()], edges, atol=1e-5)


def test_halves_show_the_middles_and_quarters_all():
    rng = np.random.default_rng(0)
    pictures = [rng.uniform(size=(180, 320, 3)).astype(np.float32) for _ in range(4)]
    two = split_screen.sheet(pictures[:2], [[], []], [])
    assert two.shape == (180, 320, 3)
    for number in (0, 1):
        here = two[:, 160 * number + 2 : 160 * number + 158]
        assert np.abs(here - pictures[number][:, 82:238]).max() < 0.003
    four = split_screen.sheet(pictures, [[]] * 4, [])
    small = pictures[3].reshape(90, 2, 160, 2, 3).mean((1, 3))
    assert np.abs(four[92:, 162:] - small[2:, 2:]).max() < 0.003


def test_names_and_time_are_written_where_they_should_be():
    dark = np.zeros((180, 320, 3), np.float32)
    sheet = split_screen.sheet([dark, dark], [[("#ff0000", "one")], [("#00ff00", "two")]], ["later"])
    red, green = sheet[..., 0] - sheet[..., 1] > 0.5, sheet[..., 1] - sheet[..., 0] > 0.5
    for chip, half, other in (
        (red, np.s_[:20, :160], np.s_[:, 160:]),
        (green, np.s_[:20, 160:], np.s_[:, :160]),
    ):
        assert chip[half].any()
        assert not chip[other].any()
    assert sheet[160:, 4:60].max() > 0.5
    assert sheet[60:150, 4:150].max() == 0.0


def test_marks_are_written_next_to_their_places_and_never_over_each_other():
    dark = np.zeros((180, 320, 3), np.float32)

    def shown(*marks, keys=()):
        found = split_screen.sheet([dark], [list(keys)], [], marks=[marks])
        return found.max(axis=-1) > 0.5

    one = shown(split_screen.Mark(100, 90, "Alpha"))
    assert one[85:95, 100:130].any()
    assert not one[:, :95].any()
    edge = shown(split_screen.Mark(310, 90, "Alpha"))
    assert edge[85:95, 280:305].any(), "at the left of its place"
    both = shown(split_screen.Mark(100, 90, "Alpha"), split_screen.Mark(90, 90, "Bravo"))
    assert both[85:95, 60:86].any(), "the second is at its left"
    third = shown(*[split_screen.Mark(100 - 9 * k, 90, "Alpha") for k in range(3)])
    assert np.array_equal(third, shown(*[split_screen.Mark(100 - 9 * k, 90, "Alpha") for k in range(2)]))
    quarters = split_screen.sheet([dark] * 3, [[]] * 3, [], marks=[[], [], [split_screen.Mark(100, 90, "A")]])
    assert quarters[128:142, 50:60].max() > 0.5


def test_a_sample_at_half_its_pace_is_twice_as_late():
    original = stored.load()
    slow = sample.at_pace(original, 0.5)
    burns = original.arrival > 0.0
    late = burns & np.isfinite(slow.arrival)
    np.testing.assert_allclose(slow.arrival[late], 2.0 * original.arrival[late])
    assert np.isnan(slow.arrival[original.arrival > 60_000.0]).all()
    before = original.arrival <= 0.0
    assert np.array_equal(slow.arrival[before], original.arrival[before])


def test_in_another_run_a_camera_records_what_comparing_needs():
    assert comparison._renamed(Camera("a", Drone(), passes=("split",)), "b").passes == ("rgb",)
    assert passes.in_other_runs(("difference", "thermal", "split")) == ("rgb", "thermal")
