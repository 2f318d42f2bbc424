"""Smoke of HRRR as haze of a scene: known fields on its Lambert grid, and fields that are not smoke."""

from dataclasses import replace

import grib_files
import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run import maps
from firetwin.run.models import grib2
from firetwin.shot.light import smoke_forecast

pytest.importorskip("rasterio")
pytest.importorskip("pyproj")


class Run:
    """Model grid of 20 km around the centre of the forecast's grid."""

    latitude = grib_files.CENTRE[0] + np.linspace(-0.1, 0.1, 9)
    longitude = grib_files.CENTRE[1] + np.linspace(-0.1, 0.1, 11)


def plane(east: float, north: float):
    """Return a field that is a plane in the projection, which bilinear interpolation keeps exact."""
    import pyproj

    projection = pyproj.Proj(grib_files.LAMBERT)
    centre = projection(*grib_files.CENTRE[::-1])

    def values(latitude, longitude):
        x, y = projection(longitude, latitude)
        return 1.0 + (x - centre[0]) * east + (y - centre[1]) * north

    return values


def smoke(scale=1.0):
    """Return 80 ug/m3 and 160 mg/m2 at the centre, so 2000 m high, denser to the east."""
    shape = plane(5e-6, 2e-6)
    return {
        "MASSDEN": lambda *at: 80e-9 * scale * shape(*at),
        "COLMD": lambda *at: 160e-6 * scale * shape(*at),
    }


def test_smoke_is_read_in_place_and_time(tmp_path):
    files = [grib_files.write(tmp_path / f"f{hour}.grib2", smoke(1.0 + hour), hour) for hour in (0, 1)]
    forecasts = smoke_forecast.read(Run, files[::-1])
    assert [each.valid for each in forecasts] == [grib_files.valid(0), grib_files.valid(1)]
    latitude, longitude = np.meshgrid(Run.latitude, Run.longitude, indexing="ij")
    np.testing.assert_allclose(forecasts[0].density, 80.0 * plane(5e-6, 2e-6)(latitude, longitude), rtol=1e-5)
    np.testing.assert_allclose(forecasts[0].column, 2.0 * forecasts[0].density, rtol=1e-5)
    assert forecasts[0].height == pytest.approx(2000.0)
    half = smoke_forecast.at(forecasts, grib_files.valid(0.5))
    np.testing.assert_allclose(half.density, 1.5 * forecasts[0].density)
    with pytest.raises(
        InputError, match="no smoke is valid at this time; the files have 2014-09-17T00:00:00Z"
    ):
        smoke_forecast.at(forecasts, grib_files.valid(2))
    text = smoke_forecast.page(forecasts, half, "UTC")
    assert text.endswith("mean of the run\nsmoke = 120.0\nsmoke_height = 2000.0")
    assert "80.0 (" in text
    assert f"{3.912 / (80e-9 * 4000) / 1e3:.3g}" in text  # visual range: 12.2 km


def constant(value: float):
    return lambda *_: np.array(value)


SOME, NONE = constant(1e-8), constant(0.0)


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"MASSDEN": NONE, "COLMD": SOME}, "MASSDEN of 0 everywhere, and a field of zeros is not"),
        ({"MASSDEN": SOME, "COLMD": NONE}, "COLMD of 0 everywhere, and a field of zeros is not"),
        ({"MASSMR": SOME}, "smoke as a mixing ratio .* ug/kg times the density of air is ug/m3"),
        ({"MASSDEN": SOME}, "no pair of MASSDEN at 8 m and COLMD"),
        ({"MASSDEN": constant(-1e-8), "COLMD": SOME}, "MASSDEN that is negative"),
        ({"MASSDEN": constant(np.nan), "COLMD": SOME}, "MASSDEN that is negative or not a number"),
        ({"MASSDEN": constant(45.0), "COLMD": SOME}, "up to 45 kg/m3 of smoke, most likely in another"),
    ],
)
def test_fields_that_are_not_smoke_are_one_line(tmp_path, fields, reason):
    path = grib_files.write(tmp_path / "f.grib2", fields)
    with pytest.raises(InputError, match=rf"f\.grib2: has {reason}"):
        smoke_forecast.read(Run, [path])


def test_another_unit_is_named(tmp_path):
    box = (38.7, -120.7, 38.8, -120.5)
    path = grib_files.write(tmp_path / "f.grib2", smoke())
    field = grib2.read([path], {"MASSDEN"}, {"8-HTGL"}, box)[0]
    with pytest.raises(InputError, match=r"has MASSDEN in ug/kg, not kg/\(m\^3\); a mixing ratio is not"):
        smoke_forecast._check(replace(field, unit="ug/kg"))


def test_clean_air_at_the_run_in_a_smoky_forecast_is_clean(tmp_path):
    far = lambda latitude, _: np.where(latitude > latitude.max() - 0.02, 1e-7, 0.0)  # noqa: E731
    path = grib_files.write(tmp_path / "f.grib2", {"MASSDEN": far, "COLMD": far})
    found = smoke_forecast.read(Run, [path])
    assert found[0].density.max() == found[0].height == 0.0
    assert smoke_forecast.page(found, found[0], "UTC").endswith("smoke = 0.0")


def test_the_map_has_the_column(make_run):
    from firetwin.run import opening as runs

    run = runs.open(make_run())
    column = np.full(run.elevation.shape, 150.0)
    figure = maps.smoke_map(run, column, "forecast")
    assert figure.texts[0].get_text() == "Smoke above the ground"
    assert figure.axes[-1].get_ylabel() == "smoke, mg/m$^2$"
