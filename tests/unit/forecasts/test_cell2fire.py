"""Cell2Fire's messages as members: arrival by hand, and damaged files."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from small_ensemble import convert

FUELS = "ncols 3\nnrows 2\nxllcorner 7e5\nyllcorner 4.3e6\ncellsize 30\nNODATA_value -9999\n1 1 1\n1 1 1\n"
LOG = "simulation,ignition,weather\n1,1,Weather.csv\n2,1,Weather.csv\n3,1,Weather.csv\n"


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


def test_each_simulation_is_a_member(results, tmp_path):
    forecast, arrival, messages = convert(results, tmp_path / "out")
    never = np.inf
    minutes = [
        [[0, 10, never], [never, never, 25]],
        [[0, never, never], [12, 15, never]],
        [[0, *[never] * 2], [never] * 3],
    ]
    np.testing.assert_array_equal(arrival, 60.0 * np.array(minutes, np.float32))
    assert forecast.horizon == 25 * 60.0
    assert forecast.manifest.kind == "forecast"
    assert messages[0] == "3 of 3 members, up to 0.4167 h after 2014-09-17 04:45 UTC"


def test_other_ignitions_do_not_forecast_one_fire(results, tmp_path):
    (results / "ignition_and_weather_log.csv").write_text(LOG.replace("3,1", "3,5"))
    forecast, _, messages = convert(results, tmp_path / "out")
    assert forecast.manifest.kind == "ignitions"
    assert "the members have 2 ignitions, so they do not forecast one fire" in messages


def test_a_simulation_without_an_ignition_is_left_out(results, tmp_path):
    (results / "ignition_and_weather_log.csv").write_text("\n".join(LOG.splitlines()[:3]))
    messages = convert(results, tmp_path / "out").messages
    assert messages[:2] == [
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
        convert(results, tmp_path / "out")
    assert {each.name for each in tmp_path.iterdir()} == {"results"}
