"""Files about a complete data set: table, card, Croissant metadata, report and hashes."""

import csv
import hashlib
import json
from dataclasses import replace
from html.parser import HTMLParser

import labelled
import numpy as np
import pytest
from firetwin import written
from firetwin.dataset import about, card, croissant, finish, histogram, report, sums, table, truth
from firetwin.errors import InputError

FACTS = about.About(title='Fires "A" <b>', count=9, seed=7, split_by="place", licence="CC-BY-4.0")
VOID = {"meta", "img", "path", "rect"}


class Balanced(HTMLParser):
    """Fails if a tag is not closed; keeps the texts."""

    def __init__(self):
        super().__init__()
        self.open, self.texts = [], []

    def handle_starttag(self, tag, attrs):
        if tag not in VOID or tag == "rect":
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        pass

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("set")
    samples = labelled.data_set(folder)
    rejected = replace(samples[0], draw=samples[0].draw | {"rejects": ["under the ground"]})
    sources = {"licences": {"orthophoto": "LicenseRef-Copernicus"}, "credits": ["Copernicus 2026"]}
    truth.write(folder, replace(rejected, source=sources))
    about.write(folder, FACTS)
    finish.write(folder, ["yolo", "hf"])
    return folder, finish.read_samples(folder)


def test_the_table_has_a_row_for_each_sample(made):
    folder, samples = made
    with (folder / table.NAME).open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [int(row["index"]) for row in rows] == [each.index for each in samples]
    assert [row["smokes"] for row in rows] == ["1", "1", "0"] * 3
    assert rows[2]["kind"] == "before_ignition"
    assert rows[2]["distance_m"] == ""
    assert rows[0]["distance_m"] == "1234.5"


def test_hashes_cover_all_files(made):
    folder, _ = made
    found = sums.read(folder)
    present = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert set(found) == present - {sums.NAME, written.NAME}
    for path, value in found.items():
        assert hashlib.sha256((folder / path).read_bytes()).hexdigest() == value


def test_the_card_has_splits_licences_and_rejects(made):
    folder, _ = made
    text = (folder / card.NAME).read_text()
    header = text.split("---\n")[1]
    assert 'pretty_name: "Fires \\"A\\" <b>"' in header
    assert "license: cc-by-4.0" in header
    assert "path: imagefolder/train/**" in header
    assert "| train | 6 | 2 | 4 | 4 | ridge, valley |" in text
    assert "No place is in two splits." in text
    assert "- orthophoto: LicenseRef-Copernicus" in text
    assert "- credit: Copernicus 2026" in text
    assert "1 draw: under the ground (1)" in text
    assert "`imagefolder/`" in text
    assert "`colmap/`" not in text


def test_croissant_names_the_table_and_the_folders(made):
    folder, _ = made
    content = json.loads((folder / croissant.NAME).read_text())
    objects = {each["@id"]: each for each in content["distribution"]}
    assert objects[table.NAME]["sha256"] == sums.digest(folder / table.NAME)
    assert objects["masks"]["includes"] == "masks/*.png"
    assert "depth" not in objects
    columns = [each["source"]["extract"]["column"] for each in content["recordSet"][0]["field"]]
    assert columns == (folder / table.NAME).read_text().splitlines()[0].split(",")
    assert len(content["license"]) == 2


def test_croissant_is_valid(made):
    """Needs mlcroissant, which is not a member of any extra."""
    library = pytest.importorskip("mlcroissant")
    folder, samples = made
    found = library.Dataset(folder / croissant.NAME)
    assert not found.metadata.ctx.issues.errors
    assert [record["samples/index"] for record in found.records("samples")] == [
        each.index for each in samples
    ]


def test_the_report_is_one_intact_page(made):
    folder, samples = made
    text = (folder / report.NAME).read_text()
    parser = Balanced()
    parser.feed(text)
    assert not parser.open
    assert "http" not in text.replace("http-equiv", "")
    assert text.count("data:image/jpeg") == len(samples)
    assert "<b>" not in text
    assert {"visibility", "distance", "fire", "smoke", "share of the picture"} <= set(parser.texts)


def test_bars_count_each_value_once():
    bars = histogram.numeric({"a": [1.0, 2.0, 2.0, np.nan], "b": [10.0, 0.0]})
    assert [sum(found) for found in bars.counts.values()] == [3, 2]
    assert bars.counts["b"][0] == bars.counts["b"][-1] == 1
    words = histogram.categorical({"a": [str(n) for n in range(20)], "b": ["0", "0"]})
    assert [sum(found) for found in words.counts.values()] == [20, 2]
    assert words.names[0] == "0"
    assert words.names[-1] == "others"


def test_skewed_values_have_a_logarithmic_axis():
    even = histogram.numeric({"a": np.geomspace(10.0, 1000.0, 200)})
    assert max(even.counts["a"]) <= 12
    assert even.ticks[1][1] == "100"
    flat = histogram.numeric({"a": np.linspace(1.0, 360.0, 200)})
    assert max(flat.counts["a"]) <= 12


@pytest.mark.parametrize("values", [[], [3.0, 3.0], [np.inf]])
def test_bars_of_few_values_are_drawn(values):
    bars = histogram.numeric({"a": values})
    assert sum(bars.counts["a"]) == sum(np.isfinite(values))
    assert histogram.svg(bars, {"a": "#000"}, "title").endswith("</svg>")


def test_a_folder_without_samples_is_explained(tmp_path):
    with pytest.raises(InputError, match="has no samples"):
        finish.read_samples(tmp_path)


def test_damaged_facts_are_explained(tmp_path):
    assert about.read(tmp_path) == about.About()
    (tmp_path / about.NAME).write_text("{")
    with pytest.raises(InputError, match="is damaged"):
        about.read(tmp_path)
