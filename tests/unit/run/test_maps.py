"""`firetwin info` and `firetwin maps` on the small run."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.run import areas, blocks, content, fact_cache, info, maps, measure, thumbnails
from firetwin.run import opening as runs
from PIL import Image
from small_run import FX, FY, RUN_TOML, small_fields

ZONE = "America/Los_Angeles"


@pytest.fixture
def run(make_run):
    arrival = np.full((FY, FX), np.nan, np.float32)
    arrival[0, 0], arrival[3, 4], arrival[5, 5] = -10.0, 60.0, 100.0
    return runs.open(make_run(fuel_arrival_time=arrival))


def test_cells_cover_the_ellipsoid():
    latitude, longitude = np.linspace(-89.5, 89.5, 180), np.linspace(179.5, -179.5, 360)
    area = areas.cell_areas(latitude, longitude)
    assert area.shape == (180, 360)
    # Area of the WGS84 ellipsoid (NIMA TR8350.2, table 3.3 derives 510 065 621.7 km2).
    assert area.sum() == pytest.approx(510_065_621.7e6, rel=1e-10)


def test_a_small_cell_is_as_large_as_the_radii_of_curvature_say():
    latitude, longitude = 38.9 + np.array([-1, 0, 1]) * 1e-3, -120.5 + np.array([-1, 0, 1]) * 1e-3
    dx, dy = areas.spacing(latitude, longitude)
    assert areas.cell_areas(latitude, longitude)[1, 1] == pytest.approx(dx * dy, rel=1e-9)
    assert dy == pytest.approx(111.011, abs=0.01)  # 111.0 km per degree at 38.9 N


def test_burned_area_energy_and_flux(run):
    facts = info.gather(run, ZONE)
    cell = areas.cell_areas(run.fuel_latitude, run.fuel_longitude)
    assert facts["burned"]["first"] == pytest.approx(cell[0, 0])
    assert facts["burned"]["last"] == pytest.approx(cell[0, 0] + cell[3, 4] + cell[5, 5])
    flux, area = small_fields()["heat_flux"].astype(float), areas.cell_areas(run.latitude, run.longitude)
    power = (flux * area).sum((1, 2))
    assert facts["energy"] == pytest.approx(60 * (power[0] / 2 + power[1] + power[2] / 2), rel=1e-12)
    assert facts["heat_flux"] == {"min": 0.0, "max": 2000.25}


def test_facts_do_not_depend_on_how_many_rows_are_read_at_once(run, monkeypatch):
    facts = info.gather(run, ZONE)
    monkeypatch.setattr(blocks, "CELLS", 1)
    again = info.gather(run, ZONE)
    for fuel in ("surface_fuel", "canopy_fuel", "fuel_energy"):
        assert again.pop(fuel) == pytest.approx(facts.pop(fuel), rel=1e-12)
    assert again.pop("burned") == facts.pop("burned")
    assert again == facts


def test_reported_acreages_stand_beside_those_of_the_run(run):
    rows = [row for row in info.gather(run, ZONE)["reported"] if row["run"] is not None]
    assert [row["time"] for row in rows] == ["2014-09-17T04:45:00Z"]  # the run lasts two minutes
    cell = areas.cell_areas(run.fuel_latitude, run.fuel_longitude)[0, 0]
    assert rows[0]["reported"] == pytest.approx(11_520 * 4046.8564224)
    assert rows[0]["difference"] == pytest.approx(cell / (11_520 * 4046.8564224) - 1)


def test_the_page_says_what_is_needed(run):
    page = info.page(info.gather(run, ZONE))
    assert "Small  (SYNTHETIC" in page
    assert "16 Sep 2014 21:45 PDT" in page
    assert "17 Sep 04:45 UTC" in page
    assert "11,520" in page
    assert "4 x 5 cells" in page
    assert all(len(line) == len(line.rstrip()) for line in page.splitlines())


def test_assumptions_are_listed_of_a_run_without_a_model(run):
    facts = info.gather(run, ZONE) | {"source": {"assumptions": ["terrain: invented"]}}
    assert info.page(facts).endswith("\nAssumptions\n  - terrain: invented")


def test_a_fire_that_is_not_known_has_no_reports(make_run):
    run = runs.open(make_run(toml=RUN_TOML.replace('event = "king_fire"\n', "")))
    facts = info.gather(run, ZONE)
    assert facts["reported"] == []
    assert "reported" not in info.page(facts)


def test_maps_are_drawn(run, tmp_path):
    out = tmp_path / "new" / "maps"
    assert maps.draw(run, out, ZONE) == [out / "fuel.png", out / "intensity.png"]
    assert sorted(path.name for path in out.glob("[!.]*")) == ["fuel.png", "intensity.png"]
    for path in out.glob("*.png"):
        pixels = np.asarray(Image.open(path).convert("RGB")).astype(int)
        assert pixels.shape[1] == round(8.8 * maps.DPI)
        assert pixels.std() > 20
    green = np.asarray(Image.open(out / "fuel.png").convert("RGB")).astype(int)
    assert ((green[..., 1] > green[..., 0] + 30) & (green[..., 1] > green[..., 2] + 30)).mean() > 0.1


def test_thumbnails_are_north_up_and_in_proportion(make_run):
    wide = runs.open(make_run())
    squares = thumbnails.draw(wide)
    assert {picture.shape for picture in squares.values()} == {(thumbnails.SIDE, thumbnails.SIDE, 4)}
    flux = thumbnails.strongest(wide)
    hottest = np.unravel_index(flux.argmax(), flux.shape)
    colours, covered = squares["intensity"][..., :3], squares["intensity"][..., 3]
    most = thumbnails.coloured(np.ones(1), thumbnails.INTENSITY)
    row, column = np.isclose(colours, most).all(-1).nonzero()
    assert row.size
    rows, columns = (np.ptp(np.nonzero(covered.any(axis))[0]) + 1 for axis in (1, 0))
    north = np.sort(wide.latitude).searchsorted(wide.latitude[hottest[0]])
    east = np.sort(wide.longitude).searchsorted(wide.longitude[hottest[1]])
    first_row, first_column = (covered.any(axis).argmax() for axis in (1, 0))
    assert ((row - first_row) * len(wide.latitude) // rows == north).all()
    assert ((column - first_column) * len(wide.longitude) // columns == east).all()
    shape = np.ptp(wide.latitude), np.ptp(wide.longitude) * np.cos(np.radians(wide.latitude.mean()))
    assert rows / columns == pytest.approx(shape[0] / shape[1], rel=0.02)


def test_maps_of_a_single_cell(make_run, tmp_path):
    one = {
        name: field[..., :1, :1] if field.ndim > 1 else field[:1] for name, field in small_fields().items()
    }
    run = runs.open(make_run(**one))
    for path in maps.draw(run, tmp_path, ZONE):
        assert path.stat().st_size > 10_000


@pytest.mark.parametrize("scale", [0.002, 0.02, 0.3, 5.0])
def test_labels_tell_ticks_apart(make_run, scale):
    """A run whose cells are smaller or larger than the small run's."""
    fields = small_fields()
    axes = {
        name: fields[name][0] + (fields[name] - fields[name][0]) * scale
        for name in ("latitude", "longitude", "fuel_latitude", "fuel_longitude")
    }
    (map_of_fuel, *_) = maps.fuel_map(runs.open(make_run(**axes))).axes
    for axis, limits in (
        (map_of_fuel.xaxis, map_of_fuel.get_xlim()),
        (map_of_fuel.yaxis, map_of_fuel.get_ylim()),
    ):
        ticks = [tick for tick in axis.get_majorticklocs() if limits[0] <= tick <= limits[1]]
        labels = [axis.get_major_formatter()(tick) for tick in ticks]
        assert len(set(labels)) == len(labels) >= 2
        for tick, label in zip(ticks, labels, strict=True):
            assert float(label[:-2]) == pytest.approx(abs(tick), abs=1e-9)


def nobody(*_):
    raise AssertionError("asked again")


@pytest.fixture
def settled(run, monkeypatch):
    """A run whose files count as old."""
    monkeypatch.setattr(content, "_YOUNG", -1.0)
    return run


def test_facts_are_found_once(settled, monkeypatch):
    facts = info.gather(settled, ZONE)
    monkeypatch.setattr(info, "_find", nobody)
    assert info.gather(runs.open(settled.path), ZONE) == facts
    with pytest.raises(AssertionError, match="asked again"):
        info.gather(settled, "Asia/Tokyo")


def test_facts_of_other_files_are_found_anew(settled):
    before = info.gather(settled, ZONE)
    fuel = Path(settled.path) / "surface_fuel.npy"
    np.save(fuel, np.load(fuel) + np.float32(1.0))
    after = info.gather(runs.open(settled.path), ZONE)
    assert after["surface_fuel"]["mean"] == pytest.approx(before["surface_fuel"]["mean"] + 1.0)


def test_facts_of_another_program_are_found_anew(settled, monkeypatch):
    info.gather(settled, ZONE)
    monkeypatch.setattr(fact_cache, "_program", dict)
    monkeypatch.setattr(info, "_find", nobody)
    with pytest.raises(AssertionError, match="asked again"):
        info.gather(settled, ZONE)


def test_files_that_may_still_change_are_not_remembered(run, monkeypatch):
    monkeypatch.setattr(content, "_YOUNG", 3600.0)
    info.gather(run, ZONE)
    assert not (Path(run.path) / fact_cache.NAME).exists()


@pytest.mark.parametrize("damage", ["", "[]", '{"key"', '{"key": 1}', "\x00\xff"])
def test_damaged_facts_count_for_nothing(settled, damage):
    facts = info.gather(settled, ZONE)
    (Path(settled.path) / fact_cache.NAME).write_bytes(damage.encode("latin1"))
    assert info.gather(settled, ZONE) == facts


def test_where_nothing_can_be_remembered_facts_are_found(settled):
    (Path(settled.path) / fact_cache.NAME).mkdir()
    assert info.gather(settled, ZONE)["name"] == "Small"
    assert list((Path(settled.path)).glob(".*.part*")) == []


def test_the_scale_bar_is_a_round_length():
    assert [measure.round_length(most) for most in (730.0, 2100.0, 19999.0, 1.0, 0.6)] == pytest.approx(
        [500.0, 2000.0, 10000.0, 1.0, 0.5]
    )


def test_bounds_of_marked_cells_are_their_middle_and_size():
    latitude, longitude = np.linspace(39.0, 38.9, 11), np.linspace(-120.6, -120.5, 11)
    marked = np.zeros((11, 11), bool)
    marked[2:5, 6:9] = True
    north, east, (wide, tall) = areas.bounds(latitude, longitude, marked)
    assert (north, east) == pytest.approx((38.97, -120.53))
    assert (wide, tall) == pytest.approx((1733.2, 2220.2), rel=1e-3)  # 0.02 degrees each
    assert areas.bounds(latitude, longitude, ~marked & marked)[:2] == pytest.approx((38.95, -120.55))
