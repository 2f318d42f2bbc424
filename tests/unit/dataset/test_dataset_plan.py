"""Plans of data sets: a short plan works, and each error has its line and a remedy."""

import tomllib

import pytest
import small_plan
from firetwin.dataset import imagery, plan_file
from firetwin.dataset.distributions import DEFAULTS, VALUES, Choice, Constant, LogNormal, LogUniform
from firetwin.dataset.plan import Plan
from firetwin.dataset.run_scene import settings_of
from firetwin.errors import InputError
from firetwin.shot.schema import fields
from shown_code import ROOT, blocks

SHORT = """\
count = 200
seed = 54
resolution = [320, 240]
[[runs]]
place = "King"
run = "a"
weight = 2
[[runs]]
place = "Rim"
run = "b"
"""


@pytest.fixture
def read(tmp_path):
    small_plan.write_run(tmp_path / "a", cells=16)
    (tmp_path / "b").mkdir()

    def read(text):
        (tmp_path / "plan.toml").write_text(text)
        return plan_file.read(tmp_path / "plan.toml")

    return read


def test_a_plan_of_ten_lines_has_all_defaults(read, tmp_path):
    plan = read(SHORT)
    assert (plan.count, plan.seed, plan.resolution) == (200, 54, (320, 240))
    assert [(run.place, run.name, run.run, run.weight) for run in plan.runs] == [
        ("King", "a", tmp_path / "a", 2.0),
        ("Rim", "b", tmp_path / "b", 1.0),
    ]
    assert plan.draws == dict(DEFAULTS)
    assert plan.cameras["tower"] == 0.4


def test_distributions_are_replaced_by_name(read):
    plan = read(
        SHORT
        + """\
[draws]
blur = 0.5
netd = { kind = "choice", values = [30, 80], weights = [3, 1] }
visibility = { kind = "log_normal", median = 20, factor = 2.5, low = 5, high = 100 }
distance_drone = { kind = "log_uniform", low = 100, high = 900 }
"""
    )
    assert plan.draws["blur"] == Constant(0.5)
    assert plan.draws["netd"] == Choice((30.0, 80.0), (3.0, 1.0))
    assert plan.draws["visibility"] == LogNormal(20.0, 2.5, 5.0, 100.0)
    assert plan.draws["distance_drone"] == LogUniform(100.0, 900.0)
    assert plan.draws["roll"] == DEFAULTS["roll"]


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("count = 200", "count = 0", "1:1: count must be from 1 to 1,000,000, not 0"),
        (
            "count = 200",
            "counts = 200",
            '1:1: unknown key "counts" in a plan of a data set; did you mean "count"?',
        ),
        ("count = 200", "count = ", "1:9: not valid TOML"),
        ('run = "a"', 'run = "c"', "6:1: runs.run: there is no "),
        ('place = "Rim"\n', "", "8:3: runs.place is missing"),
        ('run = "b"\n', "", "8:3: runs.run is missing"),
        ("weight = 2", 'name = "B"', '8:3: two runs are called "b"'),
        ("weight = 2", 'split = "tests"', '7:1: runs.split must be "any", "train", "val" or "test"'),
        ("weight = 2", "[draws]\nblus = 2", '8:1: unknown value "blus" in [draws]; did you mean "blur"?'),
        (
            "weight = 2",
            '[draws]\nblur = { kind = "normal" }',
            '8:10: draws.blur: kind must be "uniform", "log_uni',
        ),
        (
            "weight = 2",
            '[draws]\nblur = { kind = "uniform", low = 1 }',
            "8:1: draws.blur: a uniform needs high",
        ),
        (
            "weight = 2",
            '[draws]\nblur = { kind = "uniform", low = 2, high = 1 }',
            "8:1: draws.blur has low above",
        ),
        ("weight = 2", '[draws]\nblur = { kind = "log_uniform", low = 0, high = 1 }', "needs a low above 0"),
        ("weight = 2", "[draws]\nblur = -1", "8:1: draws.blur must be from 0 to 50 pixels, not -1 to -1"),
        ("weight = 2", '[draws]\nblur = "much"', '8:1: draws.blur must be a number, not "much"'),
        (
            "weight = 2",
            '[draws]\nroll = { kind = "choice", values = [] }',
            "needs at least one of its values",
        ),
        (
            "weight = 2",
            "[cameras]\ntower=0\ndrone=0\naircraft=0\nnadir=0",
            "7:2: all shares of [cameras] are 0",
        ),
    ],
)
def test_a_wrong_plan_has_a_line_and_a_remedy(read, before, after, message):
    with pytest.raises(InputError) as raised:
        read(SHORT.replace(before, after, 1))
    assert "plan.toml:" in str(raised.value)
    assert message in str(raised.value)
    assert "\n" not in str(raised.value)


def test_a_plan_without_runs_names_the_example(read):
    with pytest.raises(InputError, match=r"there are no \[\[runs\]\]; add one .* examples/dataset.toml"):
        read("count = 3\n")


def test_a_place_with_two_splits_is_refused(read):
    with pytest.raises(InputError, match=r'"King" has two splits'):
        read(SHORT.replace("Rim", "King").replace("weight = 2", 'split = "train"'))


@pytest.mark.parametrize(
    ("license", "word"), [("", "set imagery_license"), ("LicenseRef-Bing", "is not known"), ("CC0-1.0", None)]
)
def test_imagery_needs_a_licence_of_the_list(read, tmp_path, license, word):
    (tmp_path / "b.toml").write_text('run = "a"\nterrain = { photo = "photo.tif" }\n')
    plan = read(SHORT.replace('run = "b"', f'run = "b.toml"\nimagery_license = "{license}"'))
    plain, photographed = plan.runs
    assert imagery.fault(plain, settings_of(plain)) is None
    found = imagery.fault(photographed, settings_of(photographed))
    assert found is None if word is None else word in found


def test_the_example_shows_every_key_with_its_default(tmp_path):
    text = (ROOT / "examples/dataset.toml").read_text()
    example = tomllib.loads(text.replace('run = "out/sample"', f'run = "{tmp_path.as_posix()}"'))
    assert set(example["draws"]) == set(VALUES)
    (tmp_path / "plan.toml").write_text(text.replace("out/sample", tmp_path.as_posix()))
    plan = plan_file.read(tmp_path / "plan.toml")
    bare = Plan(path=plan.path, runs=plan.runs, count=plan.count, seed=plan.seed)
    assert plan == bare
    for kind, table in ((plan_file._File, example), (plan_file._Run, example["runs"][0])):
        assert {part.name for part in fields(kind)} <= {*table}
    for name in ("cameras", "negatives", "splits"):
        assert example[name] == getattr(bare, name)


def test_plans_on_the_page_are_valid(tmp_path):
    shown = [block.code for block in blocks((ROOT / "docs/datasets.md").read_text()) if block.kind == "toml"]
    whole, *parts = shown
    for name in ("RUN", "RUN2"):
        (tmp_path / name).mkdir()
    for part in ("", *parts):
        assert plan_file.parse(whole + part, tmp_path / "PLAN.toml").count == 200


def test_licences_on_the_page_are_those_of_the_list():
    page = (ROOT / "docs/datasets.md").read_text()
    assert [name for name in imagery.ALLOWED if name not in page] == []
