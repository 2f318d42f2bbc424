"""Results do not hang on the rounding mode, and nothing is built with unsafe arithmetic."""

import os
import platform
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[3]
ROUNDING = {"upwards": 0x800, "downwards": 0x400, "to zero": 0xC00}  # <fenv.h> on x86-64
MACHINE = platform.machine()
if MACHINE == "aarch64":
    ROUNDING = {"upwards": 0x400000, "downwards": 0x800000, "to zero": 0xC00000}

EVERYTHING = """
import ctypes, ctypes.util, sys, tempfile
import numpy as np
from firetwin_core import forest, lod, sensor
from firetwin_core.flux import emitters
from firetwin_core.geo import LocalFrame
from firetwin_core.run import read_grid

out, mode = sys.argv[1], int(sys.argv[2])
rng = np.random.default_rng(13)
latitude, longitude = np.linspace(38.6, 39.2, 40), np.linspace(-121, -120, 50)
height = rng.uniform(200, 3000, (40, 50)).astype("f4")
flux = rng.lognormal(8, 2, (40, 50)).astype("f4")
fuel = rng.uniform(0, 3, (40, 50)).astype("f4")
kelvin = np.linspace(250, 1500, 100)
text = "\\n".join(" ".join(f"{v:.7e}" for v in row) for row in rng.lognormal(0, 20, (40, 50)))
with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
    file.write(text)
    file.flush()
    libm = ctypes.CDLL(ctypes.util.find_library("m"))
    assert libm.fesetround(mode) == 0 and libm.fegetround() == mode
    frame = LocalFrame(38.93, -120.55)
    position = frame.forward_grid(latitude, longitude, height)
    places = frame.reverse(position.reshape(-1, 3))
    fires = emitters(flux, position, 0.0, float(flux.max()))
    trees = forest.trees(fuel, latitude, longitude, height, frame, seed=3)
    radiance = sensor.radiance(kelvin)
    result = {
        "text": read_grid(file.name), "enu": position, "scattered": frame.forward(*places),
        "intensity": fires.intensity, "cell": trees.cell, "tree": trees.position, "scale": trees.scale,
        "model": trees.model, "level": lod.levels(np.linspace(0, 5000, 777)), "radiance": radiance,
        "brightness": sensor.brightness_temperature(radiance),
        "near": lod.select_nearest(position.reshape(-1, 3), [[0., 0, 0]], 500),
    }
    libm.fesetround(0)
np.savez(out, **result)
"""


def under(path, mode):
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    subprocess.run([sys.executable, "-c", EVERYTHING, path, str(mode)], check=True, env=environment)
    return dict(np.load(path))


@pytest.fixture(scope="module")
def to_nearest(tmp_path_factory):
    return under(tmp_path_factory.mktemp("nearest") / "nearest.npz", 0)


@pytest.mark.skipif(MACHINE not in ("x86_64", "aarch64"), reason="numbers of <fenv.h> unknown")
@pytest.mark.parametrize("mode", ROUNDING)
def test_rounding_modes(to_nearest, tmp_path, mode):
    """Choices are the same; numbers differ by a few units in the last place: 20 nm in positions."""
    other = under(tmp_path / "other.npz", ROUNDING[mode])
    for name in ("cell", "model", "level", "near"):
        np.testing.assert_array_equal(other[name], to_nearest[name], name)
    for name in ("enu", "scattered", "tree"):
        np.testing.assert_allclose(other[name], to_nearest[name], rtol=0, atol=20e-9, err_msg=name)
    for name, tolerance in (
        ("text", 2**-23),
        ("scale", 2**-22),
        ("intensity", 1e-14),
        ("radiance", 1e-12),
        ("brightness", 1e-12),
    ):
        np.testing.assert_allclose(other[name], to_nearest[name], rtol=tolerance, atol=0, err_msg=name)


def test_no_build_asks_for_unsafe_arithmetic():
    unsafe = re.compile(r"fast-math|Ofast|unsafe-math|associative-math|finite-math|reciprocal-math|fp:fast")
    files = [ROOT / "CMakeLists.txt", ROOT / "pyproject.toml", *ROOT.glob("cpp/**/*.?pp")]
    assert len(files) > 50
    assert [str(f) for f in files if unsafe.search(f.read_text())] == []
    assert "-ffp-contract=off" in (ROOT / "CMakeLists.txt").read_text()


def test_loading_the_core_keeps_denormals():
    """A library linked with unsafe arithmetic turns denormals into zeros in the whole process."""
    code = "import firetwin_core, numpy; numpy.float32(1e-45) * numpy.float32(1) > 0 or exit(1)"
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
