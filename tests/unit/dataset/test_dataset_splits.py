"""Splits: every group in one split, shares as near as the groups allow."""

import dataclasses

import pytest
import small_plan
from firetwin.dataset.splits import Splits, assign
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

SHARES = {"train": 0.7, "val": 0.1, "test": 0.2}


@given(weights=st.lists(st.floats(0.1, 10.0), min_size=3, max_size=40), seed=st.integers(0, 1000))
@settings(max_examples=examples(60))
def test_every_split_has_a_group_and_about_its_share(weights, seed):
    named = {f"g{k}": weight for k, weight in enumerate(weights)}
    found = assign(named, SHARES, {}, seed)
    assert set(found) == set(named)
    assert set(found.values()) == set(SHARES)
    for split, share in SHARES.items():
        got = sum(named[group] for group, each in found.items() if each == split)
        assert abs(got - share * sum(weights)) <= 2.0 * max(weights)


def test_a_given_split_is_kept_and_counts():
    found = assign(dict.fromkeys("abcd", 1.0), {"train": 0.75, "test": 0.25}, {"c": "test"}, 0)
    assert found == {"a": "train", "b": "train", "c": "test", "d": "train"}


@pytest.mark.parametrize(("names", "by"), [(("a", "b", "c"), "place"), (("a",), "camera")])
def test_the_first_kind_of_group_that_is_enough_is_chosen(names, by):
    assert Splits(small_plan.plan(*names)).by == by


def test_runs_of_one_place_are_split_by_run():
    plan = small_plan.plan("a", "b", "c")
    runs = tuple(dataclasses.replace(run, place="One place") for run in plan.runs)
    assert Splits(dataclasses.replace(plan, runs=runs)).by == "run"


def test_places_of_several_runs_are_never_in_two_splits():
    plan = small_plan.plan("a", "b", "c", "d", "e", "f")
    runs = tuple(dataclasses.replace(run, place=f"P{k // 2}") for k, run in enumerate(plan.runs))
    splits = Splits(dataclasses.replace(plan, runs=runs))
    assert splits.by == "place"
    assert [
        splits.of(name, "drone-1") == splits.of(other, "tower-2") for name, other in ("ab", "cd", "ef")
    ] == [True] * 3
    assert sum(splits.shares().values()) == pytest.approx(1.0)


def test_a_camera_site_of_a_single_run_is_in_one_split():
    splits = Splits(small_plan.plan("a", sites=6, moments=8))
    assert splits.of("a", "tower-1") in SHARES
    assert len(splits.of_group) == 6 + 3 * 8
    assert splits.shares()["train"] == pytest.approx(0.7, abs=0.07)
