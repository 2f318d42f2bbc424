"""Cell2Fire's messages as members: arrival by hand, and damaged files."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.forecasts import convert as members_convert
from firetwin.forecasts.ensemble import ensemble

FUELS = "ncols 3\nnrows 2\nxllcorner 7e5\nyllcorner 4.3e6\ncellsize 30\nNODATA_value -9999\n1 1 1\n1 1 1\n"
LOG = "simulation,ignition,weather\n1,1,Weather.csv\n2,1,Weather.csv\n3,1,Weather.csv\n"
OPTIONS = ["2014-09-17T04:45Z", "", "EPSG:32610", 0.0, "", ""]


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """Three simulations: two that spread, the second with a repeated message, and one that did not."""
    pytest.importorskip("pyproj")
    folder = tmp_path / "results"
    (folder / "Messages").mkdir(parents=True)
    (folder / "Messages" / "MessagesFile1.csv").write_text("1,2,10,3.0\n2,6,25,2.0\n")
    (folder / "Messages" / "MessagesFile2.csv").write_text("1,4,12,3.0\n1,5,20,1.0\n4,5,15,1.0\n")
    (folder / "Messages" / "MessagesFile3.csv").write_text("")
    (folder / "ignition_and_weather_log.csv").write_text(LOG)
    (folder / "fuels.asc").write_text(FUELS)
    return folder


def run(folder: Path, out: Path) -> list[str]:
    said: list[str] = []
    members_convert.in_process([folder], out, OPTIONS, tell=said.append)
    return said


def test_each_simulation_is_a_member(results, tmp_path):
    said = run(results, tmp_path / "out")
    made = ensemble.open(tmp_path / "out")
    never = np.inf
    minutes = [
        [[0, 10, never], [never, never, 25]],
        [[0, never, never], [12, 15, never]],
        [[0, *[never] * 2], [never] * 3],
    ]
    arrival = np.stack([made.arrival(index) for index in range(3)])
    rows = slice(None, None, -1) if made.latitude[0] < made.latitude[-1] else slice(None)
    np.testing.assert_array_equal(arrival[:, rows], 60.0 * np.array(minutes, np.float32))
    assert made.horizon == 25 * 60.0
    assert made.manifest.kind == "forecast"
    assert said[0] == "3 of 3 members, up to 0.4167 h after 2014-09-17 04:45 UTC"


def test_other_ignitions_do_not_forecast_one_fire(results, tmp_path):
    (results / "ignition_and_weather_log.csv").write_text(LOG.replace("3,1", "3,5"))
    said = run(results, tmp_path / "out")
    assert ensemble.open(tmp_path / "out").manifest.kind == "ignitions"
    assert "the members have 2 ignitions, so they do not forecast one fire" in said


def test_a_simulation_without_an_ignition_is_left_out(results, tmp_path):
    (results / "ignition_and_weather_log.csv").write_text("\n".join(LOG.splitlines()[:3]))
    said = run(results, tmp_path / "out")
    assert said[:2] == [
        "2 of 3 members, up to 0.4167 h after 2014-09-17 04:45 UTC",
        "left out: 003: has no ignition in ignition_and_weather_log.csv",
    ]


@pytest.mark.parametrize(
    ("file", "text", "reason"),
    [
        ("Messages/MessagesFile2.csv", "1,2,3,4\n1,2,x,4\n", r"MessagesFile2.csv:2: is not a message"),
        ("Messages/MessagesFile2.csv", "1,2,-3,4\n", r"MessagesFile2.csv:1: is not a message"),
        ("Messages/MessagesFile2.csv", "1,7,3,4\n", r"names cell 7, and the fuels have 2 x 3 cells"),
        ("ignition_and_weather_log.csv", "a,b\n1,2\n", r"log.csv:1: has no columns simulation, ignition"),
        ("fuels.asc", "", "has no grid; give the model's fuels.asc or fuels.tif too"),
    ],
)
def test_damaged_files_have_one_reason(results, tmp_path, file, text, reason):
    (results / file).write_text(text)
    with pytest.raises(InputError, match=reason):
        run(results, tmp_path / "out")
    assert {each.name for each in tmp_path.iterdir()} == {"results"}
