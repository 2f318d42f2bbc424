"""Time zone of a run."""

import numpy as np
import pytest
from firetwin.errors import InputError, UsageError
from firetwin.run import readers, zone
from firetwin.run.models.model import Options
from firetwin.shot.sections import Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from small_run import RUN_TOML

UNKNOWN = RUN_TOML.replace('event = "king_fire"\n', "")


@pytest.mark.parametrize(
    ("text", "name"),
    [
        (f'zone = "Europe/Paris"\n{RUN_TOML}', "Europe/Paris"),
        (RUN_TOML, "America/Los_Angeles"),
        (UNKNOWN, "Etc/GMT+7"),
        (UNKNOWN.replace("-07:00", "+02:00"), "Etc/GMT-2"),
        (UNKNOWN.replace("-07:00", "Z"), "Etc/GMT+8"),
    ],
)
def test_of_what_a_run_says_the_plainest_word_counts(make_run, text, name):
    """A zone, a known fire, the start's offset; else the longitude."""
    assert zone.time_zone(readers.open(make_run(toml=text))) == name


def test_a_zone_that_is_not_known_names_the_file(make_run):
    run = readers.open(make_run(toml=f'zone = "Europe/Corsica"\n{RUN_TOML}'))
    with pytest.raises(InputError, match=r'run\.toml.*"Europe/Corsica" is not a time zone'):
        zone.time_zone(run)


@pytest.mark.parametrize(("asked", "name"), [("", "Asia/Kathmandu"), ("UTC", "UTC")])
def test_a_shot_that_names_no_zone_has_the_runs(make_run, asked, name):
    run = readers.open(make_run(toml=f'zone = "Asia/Kathmandu"\n{RUN_TOML}'))
    assert Shot(Settings(time=Time(zone=asked)), run).settings.time.zone == name


@pytest.mark.parametrize(
    ("start", "asked", "name"),
    [
        ("2020-07-18T14:00:00+02:00", "", "Etc/GMT-2"),
        ("2020-07-18T14:00:00+02:00", "Europe/Paris", "Europe/Paris"),
        ("2020-07-18T14:00:00Z", "", ""),
        ("", "", ""),
    ],
)
def test_what_is_converted_is_told_as_asked(start, asked, name):
    assert Options.of(start, "", "", 0.0, [], "", asked).zone == name


def test_a_zone_that_is_asked_for_has_to_be_known():
    with pytest.raises(UsageError, match=r"--zone: 'CEST' is not a time zone; give one such as"):
        Options.of("", "", "", 0.0, [], "", "CEST")


def test_zones_of_all_longitudes_are_known():
    assert all(zone.known(zone.of_hours(east)) for east in np.arange(-12, 13).tolist())
