"""Forecast pass: classes, lines, places and words by hand, and scene files that are refused."""

from dataclasses import replace
from datetime import UTC, datetime
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError, UsageError
from firetwin.forecasts import forecast as shot_forecast
from firetwin.forecasts import scene_inputs as ensemble_inputs
from firetwin.forecasts.ensemble import ensemble, write
from firetwin.forecasts.ensemble.choice import LINES
from firetwin.forecasts.ensemble.manifest import LeftOut, Manifest, Member
from firetwin.forecasts.ensemble.places import Places
from firetwin.forecasts.passes import _drawing, _labels, _text, outcomes
from firetwin.imaging import split_screen
from firetwin.render import fingerprint, plan
from firetwin.shot import passes, scene_inputs
from firetwin.shot.sections.forecast import ForecastSettings
from firetwin.shot.source import ShotSource
from firetwin_core import sensor
from small_run import RUN_TOML, small_fields, write_field

ISSUED = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)
NEVER, NONE = np.inf, np.nan


def make(out: Path, latitude, longitude, arrival, ends=None, **head) -> ensemble.Ensemble:
    """Write arrival times (m, ny, nx) of members, s, and open the ensemble."""
    ends = ends or [NEVER] * len(arrival)
    members = [Member(f"{i:02}", end=end) for i, end in enumerate(ends)]
    about = Manifest("made up", "stripes", ISSUED, 120.0, (), **head)
    write.write(out, about, latitude, longitude, zip(members, np.asarray(arrival, np.float32), strict=True))
    return ensemble.open(out)


def stripes(columns, reached):
    """Arrival times (8, columns): the front goes east a column in 10 s, and stops after `reached` columns."""
    times = np.where(np.arange(columns) < reached, 10.0 * np.arange(columns), NEVER)
    return np.broadcast_to(times, (8, columns)).copy()


@pytest.fixture
def scene(tmp_path):
    """A scene of a run that burns 6 of 10 columns, member 01 of four that burn 3, 6, 9 and 10."""
    fields = small_fields()
    run = tmp_path / "run"
    run.mkdir()
    (run / "run.toml").write_text(RUN_TOML.replace("[units]", '[units]\nfuel_arrival_time = "s"'))
    mine = stripes(10, 6).astype(np.float32)
    mine[mine == NEVER] = NONE
    for name, values in (fields | {"fuel_arrival_time": mine}).items():
        write_field(run, name, values, "npy")
    every = [stripes(10, reached) for reached in (3, 6, 9, 10)]
    every[3][:3] = NONE
    make(tmp_path / "ens", fields["fuel_latitude"], fields["fuel_longitude"], every)
    file = tmp_path / "scene.toml"
    file.write_text(
        'run = "run"\n[time]\nframes = 3\n[terrain]\napron = 0.0\nnear_radius = 0.0\n'
        '[smoke]\nenabled = false\n[forecast]\nensemble = "ens"\nmember = "01"\n'
        '[render]\nresolution = [64, 48]\npasses = ["forecast"]\n'
        '[[cameras]]\nkeys = [{latitude = 38.904, longitude = -120.592, height = 900, target = "point", '
        "target_latitude = 38.9041, target_longitude = -120.592}]\n"
    )
    return file


@pytest.mark.parametrize("members", [*range(1, 30), 100, 999])
def test_classes_are_as_wide_as_each_other_and_the_legend_names_their_counts(members):
    counts = np.arange(members + 1)
    kinds, colours = _drawing.classes(counts, members), _drawing.palette(members)
    assert kinds[0] == 0
    assert set(kinds[1:]) == set(range(1, len(colours) + 1))
    assert len(colours) == min(members, 5)
    sizes = np.bincount(kinds)[1:]
    assert np.ptp(sizes) <= 1
    found = []
    for each in _text.ranges(members, len(colours)):
        low, _, high = each.partition(" to ")
        found.append(range(int(low), int(high or low) + 1))
    assert [int(kinds[k]) for part in found for k in part] == kinds[1:].tolist()
    assert [kinds[part[0]] for part in found] == list(range(1, len(colours) + 1))


def test_twenty_members_have_five_classes_of_four():
    assert _text.ranges(20, 5) == ["1 to 4", "5 to 8", "9 to 12", "13 to 16", "17 to 20"]
    assert _text.ranges(3, 3) == ["1", "2", "3"]


def test_colours_differ_by_lightness_alone_and_are_not_those_of_flames():
    shades = np.array([_drawing.values(each) for each in _drawing.COLOURS])
    linear = np.where(shades > 0.04045, ((shades + 0.055) / 1.055) ** 2.4, shades / 12.92)
    lightness = 116.0 * np.cbrt(linear @ [0.2126, 0.7152, 0.0722]) - 16.0  # CIELAB
    assert (np.diff(lightness) > 10.0).all()
    assert (shades[:, 2] > shades[:, 0]).all()
    drawn = np.array([_drawing.values(each) for each in _drawing.swatches(20)])
    assert (np.diff(drawn @ [0.2126, 0.7152, 0.0722]) > 0.03).all()


def test_the_lines_of_a_scene_file_are_the_usual_number():
    assert ForecastSettings().lines == LINES


@pytest.mark.parametrize("turned", [False, True])
def test_places_count_the_members_that_have_burned_them(tmp_path, turned):
    rng = np.random.default_rng(3)
    times = rng.uniform(0.0, 100.0, (7, 5, 6))
    times[2, 1, 4] = NONE
    latitude, longitude = 38.0 + 0.01 * np.arange(5), -120.0 + 0.01 * np.arange(6)
    order = slice(None, None, -1 if turned else 1)
    made = make(tmp_path / "e", latitude[order], longitude[order], times[:, order, order])
    north, east = (each.ravel() for each in np.meshgrid(latitude, longitude, indexing="ij"))
    places = Places(made, np.append(north, [37.99, 38.0]), np.append(east, [-120.0, -120.006]))
    counts = sum(places.burned(member, 50.0).astype(int) for member in range(7))
    assert counts[:-2].tolist() == (times <= 50.0).sum(0).ravel().tolist()
    assert counts[-2:].tolist() == [0, 0]
    assert places.inside.tolist() == [True] * 30 + [False] * 2
    known = places.simulated(np.arange(7))
    assert np.flatnonzero(~known).tolist() == [10, 30, 31]
    assert places.simulated(np.array([0, 1]))[10]


def test_a_line_is_the_border_of_the_burned_area_and_not_of_a_hill():
    burned = np.zeros((9, 12), np.bool_)
    burned[:, :6] = True
    line = _drawing.outline(burned)
    assert line[:, [5, 6]].min() > 0.8
    assert line[:, [0, 1, 2, 3, 4, 7, 8, 9, 10, 11]].max() == 0.0
    planar = np.full((9, 12), 1000.0, np.float32)
    planar[:5, 6:] = 5000.0  # a hill in front of far ground
    flat = _drawing.smooth_ground(planar)
    assert not flat[:4, [5, 6]].any()
    assert flat[7:].all()


def layers(**values):
    """Layers of a 1 x 1 picture."""
    names = [f"{name}.{c}" for name in ("fire", "light_fire") for c in "RGB"] + [*"RGB", "smoke.A"]
    return {name: np.full((1, 1), values.get(name.partition(".")[0], 0.0), np.float32) for name in names}


def test_the_tint_fades_as_the_ground_does_behind_smoke_and_leaves_flames():
    lit = {"R": 1.0, "G": 1.0, "B": 1.0}
    assert _drawing.clearness(layers(**lit)) == 1.0
    assert _drawing.clearness(layers(**lit, smoke=0.75)) == 0.25
    assert _drawing.clearness(layers(**lit, fire=1.0)) == 0.0
    assert _drawing.clearness(layers(**lit, light_fire=0.5)) == 0.5
    rgb, kinds = np.full((1, 1, 3), 0.5, np.float32), np.array([[1]])
    clear = np.zeros((1, 1), np.float32)
    assert np.array_equal(_drawing.tint(rgb, kinds, ("#0000ff",), clear), rgb)
    assert np.array_equal(_drawing.tint(rgb, 0 * kinds, ("#0000ff",), clear + 1.0), rgb)
    assert _drawing.tint(rgb, kinds, ("#0000ff",), clear + 1.0)[0, 0].argmax() == 2


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('member = "01"', 'member = "7"', 'there is no "7"; the forecast has 00, 01, 02, 03'),
        ('member = "01"', 'member = "00"', "does not show member 00 .* 67% burned .* agrees with member 01"),
        ('ensemble = "ens"', 'ensemble = "run"', r"ensemble\.toml"),
        ('ensemble = "ens"\nmember = "01"', "", "without an ensemble; name its folder as forecast.ensemble"),
        ('"forecast"]', '"forecast"]\nengine = "eevee"', "cannot record forecast with EEVEE"),
        ("[[cameras]]", '[[runs]]\nname = "b"\npath = "b"\n[[cameras]]', 'run "b" is not a member'),
    ],
)
def test_what_is_not_a_film_of_a_member_is_refused_with_its_line(scene, old, new, words):
    other = scene.with_name("b")
    other.mkdir()
    for file in scene.with_name("run").iterdir():
        (other / file.name).write_bytes(file.read_bytes())
    times = np.load(other / "fuel_arrival_time.npy")
    np.save(other / "fuel_arrival_time.npy", times[:, ::-1])
    text = scene.read_text()
    assert old in text
    scene.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=words):
        ShotSource(scene=str(scene)).shot()


def test_shares_of_other_kinds_are_refused_and_their_lines_are_not(scene):
    manifest = scene.with_name("ens") / "ensemble.toml"
    manifest.write_text(manifest.read_text().replace('kind = "forecast"', 'kind = "scenarios"'))
    with pytest.raises(InputError, match=r"scenarios are not a probability; set forecast.shares = false"):
        ShotSource(scene=str(scene)).shot()
    scene.write_text(scene.read_text().replace('member = "01"', 'member = "01"\nshares = false'))
    shot = ShotSource(scene=str(scene)).shot()
    forecast = shot_forecast.of(shot.settings)
    counts = _text.Counts(forecast, shot.utc(2), 1, 4, (0, 2, 3), False)
    assert _text.caption(shot, counts)[1].startswith("burning: scenario 01 of 4")
    outlier = shot_forecast.outlier(forecast)
    assert _text.legend(shot, counts) == [
        ("line " + _text.SHOWN, "front of scenario 01, burning"),
        ("line " + _text.OUTLIER, f"front of scenario {forecast.members[outlier].name}, outlier"),
        ("line " + _text.LINE, "fronts of 2 other scenarios"),
    ]


def test_a_shot_after_the_end_of_its_member_is_refused(scene):
    manifest = scene.with_name("ens") / "ensemble.toml"
    manifest.write_text(manifest.read_text().replace("horizon_s = 120.0", "horizon_s = 90.0"))
    with pytest.raises(InputError, match="01 has 2014-09-17T04:45:00Z to 2014-09-17T04:46:30Z, and the shot"):
        ShotSource(scene=str(scene)).shot()


def test_captions_and_legend_name_member_times_and_counts(scene):
    shot = ShotSource(scene=str(scene)).shot()
    forecast = shot_forecast.of(shot.settings)
    roles = shot_forecast.roles(forecast, 1)
    counts = _text.Counts(forecast, shot.utc(2), 1, 3, (2,), True)
    assert _text.caption(shot, counts) == [
        "synthetic",
        f"burning: member 01 of 4{f' ({roles[0]})' if roles else ''}, stripes",
        "issued 16 Sep 2014 21:45 PDT",
        "valid 16 Sep 2014 21:46 PDT",
    ]
    forecast = replace(forecast, manifest=replace(forecast.manifest, left_out=(LeftOut("04", "empty"),)))
    words = [text for _, text in _text.legend(shot, replace(counts, ensemble=forecast))]
    assert words == [
        *(
            "burned by 21:46 in",
            "3 of 3 members",
            "2 of 3",
            "1 of 3",
            "front of member 01, burning",
            "front of 1 other member",
            "1 of 2 others drawn, colours count all",
            "not simulated",
        ),
        *("1 of 4 ended before 21:46", "1 failed, not counted"),
    ]


def rendered(folder: Path) -> dict[str, dict[str, Path]]:
    """Write the files of passes that show even ground 900 m from the camera."""
    planar = np.full((48, 64), 900.0, np.float32)
    sensor.write_image(folder / "rgb.png", np.full((48, 64, 3), 0.2, np.float32))
    sensor.write_image(folder / "depth.exr", planar)
    names = [f"{name}.{c}" for name in ("fire", "light_fire") for c in "RGB"] + [*"RGB", "smoke.A"]
    pixels = np.zeros((48, 64, len(names)), np.float32)
    pixels[..., 6:9] = 1.0
    sensor.write_image(folder / "comp.exr", pixels, None, names)
    return {"rgb": {"png": folder / "rgb.png"}} | {
        name: {"exr": folder / f"{name}.exr"} for name in ("depth", "comp")
    }


def test_a_picture_shows_counts_on_the_ground_and_hatches_what_was_not_simulated(scene, tmp_path):
    shot = ShotSource(scene=str(scene)).shot()
    files = {"png": tmp_path / "p.png"}
    needed = rendered(tmp_path)
    given = []
    original = split_screen.sheet
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(split_screen, "sheet", lambda *all, **more: given.append(all) or original(*all, **more))
        passes.finish("forecast", files, needed, shot, "drone", 3)
    (((picture,), (keys,), said, _below),) = given
    assert sensor.read_image(files["png"]).shape[:2] == (48, 64)
    blue = picture[..., 2] - picture[..., 0]
    assert blue[:20].max() > 0.2, "ground that members have burned is tinted"
    rows = blue[:, 32]
    assert rows[-5:].max() < 0.01, "ground that a member has not simulated is not"
    levels = {0.2, 0.2 + 0.35 * (0xD8 / 255.0 - 0.2)}  # of the ground, and of hatching over it
    assert {*np.unique(picture[-12:, :8].astype(float).round(3))} == {round(each, 3) for each in levels}
    assert ("hatched", "not simulated") in keys
    assert said[0] == "synthetic"


def test_an_ensemble_makes_other_forecast_pictures_alone(scene):
    scene.write_text(scene.read_text().replace('["forecast"]', '["rgb", "forecast"]'))

    def inputs():
        shot = ShotSource(scene=str(scene)).shot()
        return fingerprint.compute(shot, plan.pictures(shot))

    before = inputs()
    manifest = scene.with_name("ens") / "ensemble.toml"
    manifest.write_text(manifest.read_text().replace("made up", "renamed"))
    after = inputs()
    changed = {name for (_, name), made in before.items() if made != after[_, name]}
    assert changed == {"forecast"}
    scene.write_text(scene.read_text().replace('member = "01"', 'member = "01"\nlines = 2'))
    assert {name for (_, name), made in after.items() if made != inputs()[_, name]} == {"forecast"}


def test_a_pass_of_the_command_line_needs_an_ensemble_too(scene):
    text = scene.read_text().replace('ensemble = "ens"\nmember = "01"\n', "")
    scene.write_text(text.replace('["forecast"]', '["rgb"]'))
    shot = ShotSource(scene=str(scene)).shot()
    with pytest.raises(UsageError, match=r"name its folder as forecast.ensemble"):
        plan.pictures(shot, names="forecast")
    assert passes.is_marched(passes.known()["forecast"])
    assert not passes.is_marched(passes.known()["edl"])


def test_outcomes_take_turns_of_one_and_a_half_seconds():
    shown = [outcomes.turn(frame, Fraction(12), 3) for frame in range(1, 73)]
    assert shown == [0] * 18 + [1] * 18 + [2] * 18 + [0] * 18
    assert outcomes.turn(2, Fraction(1, 10), 3) == 1
    film = [outcomes.turn(frame, Fraction(24000, 1001), 2) for frame in range(1, 73)]
    assert film == [0] * 36 + [1] * 36


def test_a_front_is_labelled_apart_from_the_others_and_near_the_middle():
    own = np.array([(50, x) for x in range(100)])
    other = np.array([(50, x) for x in range(60)])
    assert _labels._free_point([own, other], (100, 100)) == (50.0, 64.0)
    assert _labels._free_point([own], (100, 100)) == (50.0, 50.0)
    assert _labels._free_point([own[:3]], (100, 100)) is None


def test_places_behind_hills_and_smoke_are_not_named(scene):
    shot = ShotSource(scene=str(scene)).shot()
    (view,) = shot.paths
    middle = view.position[0] - 900.0 * view.rotation[0][:, 2] * [[1.0], [-1.0]]
    far, near = np.full((48, 64), 900.0, np.float32), np.full((48, 64), 300.0, np.float32)
    for planar, clear, seen in ((far, 1.0, True), (near, 1.0, False), (far, 0.0, False)):
        at = _labels.visible(view, 1, planar, np.full((48, 64), clear, np.float32), middle)
        assert np.isfinite(at).all(axis=1).tolist() == [seen, False]
        if seen:
            np.testing.assert_allclose(at[0], [32.0, 24.0], atol=1e-6)
    at = np.array([[1.0, 2.0], [np.nan, np.nan], [3.0, 4.0]])
    words = [mark.text for mark in _labels.names(["A", "B", "C"], np.array([2, 1, 0]), 4, at)]
    assert words == ["A: burned in 2 of 4", "C"]


def test_the_bar_has_a_part_for_each_run():
    grey = np.full((120, 90, 3), 0.5, np.float32)
    picture = outcomes.with_bar(grey, 1, 3)
    assert np.array_equal(picture[2:], grey[2:])
    assert (picture[:2, 31:57] == 1.0).all()
    assert picture[:2, :30].max() < 0.5
    assert picture[:2, 60:].max() < 0.5


def test_outcomes_are_made_of_the_forecast_pictures_of_all_runs(scene, tmp_path, monkeypatch):
    text = scene.read_text().replace('passes = ["forecast"]', 'passes = ["outcomes"]')
    scene.write_text(text.replace("[[cameras]]", '[[runs]]\nname = "same"\npath = "run"\n[[cameras]]'))
    shot = ShotSource(scene=str(scene)).shot()
    wanted = {(picture.camera, picture.name) for picture in plan.pictures(shot)}
    assert wanted == {("drone", "forecast"), ("drone@same", "forecast"), ("drone", "outcomes")}
    needed, corners = {}, []
    original = split_screen.sheet
    monkeypatch.setattr(
        split_screen, "sheet", lambda *all, **more: corners.append(more["corner"]) or original(*all, **more)
    )
    for level, name in ((0.2, "forecast"), (0.7, "forecast@same")):
        needed[name] = {"png": tmp_path / f"{level}.png"}
        sensor.write_image(needed[name]["png"], np.full((48, 64, 3), level, np.float32))
    for frame, level in ((1, 0.2), (40, 0.7)):
        passes.finish("outcomes", {"png": tmp_path / "o.png"}, needed, shot, "drone", frame)
        assert sensor.read_image(tmp_path / "o.png")[40, 20, 0] == pytest.approx(level, abs=0.01)
    assert [corner[:2] for corner in corners] == [
        ["outcome 1 of 2 shown", "member 01 of 4"],
        ["outcome 2 of 2 shown", "member 01 of 4"],
    ]


def test_a_split_names_each_member_with_its_area_and_has_one_legend(scene, tmp_path, monkeypatch):
    text = scene.read_text().replace('passes = ["forecast"]', 'passes = ["forecast_split"]')
    more = "".join(f'[[runs]]\nname = "{name}"\npath = "run"\n' for name in ("b", "c"))
    scene.write_text(text.replace("[[cameras]]", f"{more}[[cameras]]"))
    shot = ShotSource(scene=str(scene)).shot()
    files = rendered(tmp_path)
    needed = {f"{name}{run}": file for name, file in files.items() for run in ("", "@b", "@c")}
    given = []
    original = split_screen.sheet
    monkeypatch.setattr(
        split_screen, "sheet", lambda *all, **more: given.append(all) or original(*all, **more)
    )
    passes.finish("forecast_split", {"png": tmp_path / "s.png"}, needed, shot, "drone", 3)
    (((*pictures, last), keys, said, _below),) = given
    assert len(pictures) == 3
    assert np.ptp(last) == 0.0
    for picture, key in zip(pictures, keys, strict=False):
        assert (picture[..., 2] - picture[..., 0]).max() > 0.2, "the ground is tinted"
        assert next(words for _, words in key).startswith("member 01")
        assert key[1][1].endswith(" ha) burned")
    assert keys[3][0] == ("", "burned by 21:47 in")
    assert not any("front" in words for _, words in keys[3])
    assert ("", "3 of 4 members shown, colours count all") in keys[3]
    assert ("", "typical and extreme ones, not equally likely") in keys[3]
    assert said[-2:] == ["issued 16 Sep 2014 21:45 PDT", "valid 16 Sep 2014 21:47 PDT"]


def test_members_of_other_weights_are_said_to_count_equally(scene):
    shot = ShotSource(scene=str(scene)).shot()
    forecast = shot_forecast.of(shot.settings)
    counts = _text.Counts(forecast, shot.utc(2), 1, 4, (), False)
    said = ("", "members count equally, weights not used")
    assert said not in _text.legend(shot, counts)
    members = (replace(forecast.members[0], weight=0.5), *forecast.members[1:])
    weighted = replace(forecast, manifest=replace(forecast.manifest, members=members))
    assert said in _text.legend(shot, replace(counts, ensemble=weighted))


def test_the_ensemble_is_an_input_of_the_scene(scene):
    settings = ShotSource(scene=str(scene)).shot().settings
    assert {path.name for path in ensemble_inputs.files(settings)} == {
        "ensemble.toml",
        "arrival.npy",
        "latitude.npy",
        "longitude.npy",
    }
    assert "forecast arrival.npy" in scene_inputs.inputs(settings, {"forecast"})
    assert scene_inputs.inputs(settings, {"camera"}) == {}
    assert scene_inputs.sources(settings)[-1]["text"].startswith("stripes; ")
    assert scene_inputs.sentences(settings)[0].startswith("The forecast made up (stripes) has 4 of 4 members")
