"""Strata: shares that are exact in every prefix of a data set."""

from collections import Counter

import small_plan
from firetwin.dataset.plan import CAMERAS, NEGATIVES, PlanRun
from firetwin.dataset.strata import Strata
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

WEIGHT = st.floats(0.05, 1.0)
COUNT = 120


@given(
    seed=st.integers(0, 2**31),
    positives=st.floats(0.2, 0.9),
    night=st.floats(0.1, 0.6),
    runs=st.lists(WEIGHT, min_size=1, max_size=5),
    cameras=st.lists(WEIGHT, min_size=4, max_size=4),
)
@settings(max_examples=examples(40))
def test_each_prefix_has_the_shares_of_the_plan(seed, positives, night, runs, cameras):
    plan = small_plan.plan(
        seed=seed,
        positives=positives,
        night=night,
        runs=tuple(PlanRun("P", f"r{k}", weight, run=small_plan.Path("r")) for k, weight in enumerate(runs)),
        cameras=dict(zip(CAMERAS, cameras, strict=True)),
    )
    known = Strata(plan)
    strata = [known.of(index) for index in range(1, COUNT + 1)]
    assert Strata(plan).of(COUNT) == strata[-1]
    least_night = (1.0 - positives) / 7.0
    shares = {
        "run": {f"r{k}": weight / sum(runs) for k, weight in enumerate(runs)},
        "camera": {name: weight / sum(cameras) for name, weight in plan.cameras.items()},
        "kind": {"fire": positives} | dict.fromkeys(NEGATIVES, (1.0 - positives) / 7.0),
        "night": {True: max(night, least_night)},
    }
    for factor, wanted in shares.items():
        seen = Counter()
        for number, stratum in enumerate(strata, start=1):
            seen[getattr(stratum, factor)] += 1
            off = {name: abs(seen[name] - number * share) for name, share in wanted.items()}
            assert max(off.values()) < 2.0, (factor, number, off)


def test_kinds_of_one_time_of_day_have_no_other():
    known = Strata(small_plan.plan(positives=0.3))
    found = [known.of(index) for index in range(1, 400)]
    assert {each.night for each in found if each.kind == "night_lights"} == {True}
    assert {each.night for each in found if each.kind == "low_sun"} == {False}
    assert {each.night for each in found if each.kind == "fire"} == {True, False}


def test_kinds_and_cameras_are_not_tied_to_each_other():
    known = Strata(small_plan.plan("a", "b", "c"))
    found = [known.of(index) for index in range(1, 1001)]
    pairs = Counter((each.kind == "fire", each.camera) for each in found)
    shares = dict(zip(CAMERAS, (0.4, 0.4, 0.15, 0.05), strict=True))
    wanted = {
        (fire, name): (0.6 if fire else 0.4) * share
        for name, share in shares.items()
        for fire in (True, False)
    }
    assert max(abs(pairs[each] - 1000 * share) for each, share in wanted.items()) < 4.0
