"""Commands of the page on stations run as they are written there, on the sample run and invented files."""

import re
import shlex
from pathlib import Path

import pytest
from firetwin import cli

pytest.importorskip("scipy")

PAGE = Path(__file__).parents[2] / "docs" / "stations.md"
FILES = {
    "Fire_Stations.csv": "X,Y,Station_Name,Type\n-13413597.6,4707000.1,Exercise Station Alpha,Lookout\n",
    "county.csv": "X,Y,Station_Name\n-120.5,38.9,Exercise Station Bravo\n",
    "layer.geojson": '{"type": "Feature", "properties": {"Name": "Exercise Station Charlie"}, '
    '"geometry": {"type": "Point", "coordinates": [-120.6, 38.8]}}',
}


def commands():
    """The lines of the page's code blocks of the shell."""
    blocks = re.findall(r"^```sh\n(.*?)^```", PAGE.read_text("utf-8"), re.M | re.S)
    return [line for block in blocks for line in block.splitlines() if line.startswith("firetwin ")]


def test_the_commands_of_the_page_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text)
    assert cli.main(["sample", "RUN", "--frames", "2"]) == 0
    ran = []
    for line in commands():
        assert cli.main(shlex.split(line)[1:]) == 0, line
        ran.append(line.split()[1])
    assert sorted(set(ran)) == ["allocate", "brief", "resources", "stations"]
    said = capsys.readouterr().out
    assert "Exercise: not operational advice" in said
    assert "stations   3" in said
    assert re.search(r"division [A-D], .*: contained at hour", said)
    assert "nearest feasible plan: " in said
