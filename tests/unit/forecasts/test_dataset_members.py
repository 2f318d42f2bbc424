"""Members of ensembles as runs of a plan: names, weights, splits, and a conversion that is done once."""

from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.dataset import members, plan_file, record
from firetwin.dataset.splits import Splits
from firetwin.errors import InputError
from firetwin.forecasts.ensemble import write
from firetwin.forecasts.ensemble.manifest import Manifest, Member

PLAN = """\
split_by = "run"
splits = { train = 0.5, test = 0.5 }
[[runs]]
place = "King"
run = "E"
members = ["all"]
weight = 3
[[runs]]
place = "King"
run = "E2"
members = ["02"]
"""


@pytest.fixture
def read(tmp_path):
    for name in ("E", "E2"):
        write.write(
            tmp_path / name,
            Manifest(name, "made up", datetime(2014, 9, 17, tzinfo=UTC), 24.0, ()),
            38.8 + 1e-3 * np.arange(2),
            -120.6 + 1e-3 * np.arange(3),
            [(Member(f"{number:02}"), np.ones((2, 3), np.float32)) for number in range(3)],
        )
    return lambda text: plan_file.parse(text, tmp_path / "plan.toml")


def test_each_member_is_a_run_with_its_part_of_the_weight(read, tmp_path):
    runs = read(PLAN).runs
    assert [(run.name, run.member, run.weight) for run in runs] == [
        ("E-00", "00", 1.0),
        ("E-01", "01", 1.0),
        ("E-02", "02", 1.0),
        ("E2-02", "02", 1.0),
    ]
    assert [run.run for run in runs[2:]] == [tmp_path / "E_members/02", tmp_path / "E2_members/02"]


def test_members_of_one_ensemble_are_in_one_split(read):
    splits = Splits(read(PLAN))
    assert len({splits.of(f"E-0{number}", "tower-1") for number in range(3)}) == 1
    assert splits.of("E2-02", "tower-1") != splits.of("E-02", "tower-1")


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ('members = ["02"]', "", r'E2 is an ensemble; choose its members: members = \["all"\]'),
        ('"02"', '"2"', r'E2 has no member "2"'),
        ('run = "E2"', 'run = "."', r"is not an ensemble; leave out members"),
        ('["02"]', '["02", "02"]', r'two runs are called "E2-02"'),
    ],
)
def test_members_that_do_not_exist_have_a_line_and_a_remedy(read, before, after, message):
    with pytest.raises(InputError, match=r"plan.toml:\d+.*" + message):
        read(PLAN.replace(before, after, 1))


def test_members_are_converted_once(read, monkeypatch):
    plan, conversions = read(PLAN), []

    def convert(paths, out, **named):
        out.mkdir()
        conversions.append((paths[0].name, named["member"]))

    monkeypatch.setattr(members.job, "run", convert)
    plan.runs[1].run.mkdir(parents=True)
    members.convert(plan)
    assert conversions == [("E", "00"), ("E", "02"), ("E2", "02")]
    members.convert(plan)
    assert len(conversions) == 3


def test_the_record_of_a_member_has_no_path_of_this_machine(read, monkeypatch, tmp_path):
    plan = read(PLAN)
    monkeypatch.setattr(record, "settings_of", lambda run: run)
    monkeypatch.setattr("firetwin.run.readers.open", lambda run: None)
    monkeypatch.setattr(record.content, "inputs", lambda run, cache: {})
    found = record.describe(plan, tmp_path)["plan"]["runs"]
    assert found[3]["member"] == "02"
    assert str(tmp_path) not in str(found)
