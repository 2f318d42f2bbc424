"""ENU against programs that share no code with ours: PROJ's cct and pymap3d."""

import shutil
import subprocess

import numpy as np
import pytest
from firetwin_core.geo import LocalFrame

ORIGINS = [(38.93, -120.55, 0.0), (55.0, 5.0, 200.0), (-33.0, 179.9, 850.0)]
NANOMETRES = 10e-9  # both oracles are within 2.5 nm of exact arithmetic themselves


def points_near(origin):
    rng = np.random.default_rng(7)
    n = 200
    latitude = origin[0] + rng.uniform(-0.4, 0.4, n)
    longitude = origin[1] + rng.uniform(-0.5, 0.05, n)
    return latitude, longitude, rng.uniform(-50, 3500, n)


@pytest.mark.skipif(not shutil.which("cct"), reason="needs proj-bin")
@pytest.mark.parametrize("origin", ORIGINS)
def test_agrees_with_cct(origin):
    latitude, longitude, height = points_near(origin)
    pipeline = "+proj=pipeline +step +proj=cart +ellps=WGS84 +step +proj=topocentric +ellps=WGS84"
    place = "+lat_0={} +lon_0={} +h_0={}".format(*origin)
    lines = [
        f"{x!r} {y!r} {z!r} 0"
        for x, y, z in zip(longitude.tolist(), latitude.tolist(), height.tolist(), strict=True)
    ]
    command = ["cct", "-d", "12", *pipeline.split(), *place.split()]
    output = subprocess.run(
        command, input="\n".join([*lines, ""]), capture_output=True, text=True, check=True
    )
    expected = np.array([line.split()[:3] for line in output.stdout.splitlines()], float)
    enu = LocalFrame(*origin).forward(latitude, longitude, height)
    np.testing.assert_allclose(enu, expected, rtol=0, atol=NANOMETRES)


@pytest.mark.parametrize("origin", ORIGINS)
def test_agrees_with_pymap3d(origin):
    pymap3d = pytest.importorskip("pymap3d")
    points = points_near(origin)
    expected = np.stack(pymap3d.geodetic2enu(*points, *origin), axis=1)
    np.testing.assert_allclose(LocalFrame(*origin).forward(*points), expected, rtol=0, atol=NANOMETRES)
