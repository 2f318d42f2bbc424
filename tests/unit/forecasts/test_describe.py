"""Sources of an ensemble, and its sentence on methods."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
from firetwin import cli
from firetwin.forecasts.ensemble import describe, write
from firetwin.forecasts.ensemble.manifest import LeftOut, Manifest, Member

HEAD = Manifest("Many", "PROPAGATOR", datetime(2024, 1, 1, tzinfo=UTC), 3600.0, (), source="20 grids")


def test_the_command_lists_the_sources_of_an_ensemble(tmp_path, capsys):
    axes = np.array([38.8]), np.array([-120.6])
    write.write(tmp_path / "e", HEAD, *axes, [(Member("1"), np.zeros((1, 1)))])
    assert cli.main(["cite", str(tmp_path / "e")]) == 0
    assert "PROPAGATOR; 20 grids" in capsys.readouterr().out


def test_the_sentence_counts_members_and_names_their_differences():
    told = replace(HEAD, model="", members=(Member("1"), Member("2")), left_out=(LeftOut("3", "failed"),))
    assert describe.sentence(replace(told, perturbed="wind", synthetic=True)) == (
        "The synthetic forecast Many (model not named) has 2 of 3 members, issued 2024-01-01 00:00 UTC; "
        "members differ in wind."
    )
