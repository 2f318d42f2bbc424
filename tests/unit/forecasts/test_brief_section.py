"""The section of a forecast: times by counts of members, places without fire, drawings, and escaped names."""

from datetime import UTC, datetime, timedelta
from xml.etree import ElementTree

import numpy as np
import pytest
import small_stations
import whole_run
from firetwin.brief import briefing, page
from firetwin.brief.sheet_options import SheetOptions
from firetwin.errors import InputError
from firetwin.forecasts import brief_chart, brief_section, forecast
from firetwin.forecasts.ensemble import ensemble, place_arrivals, write
from firetwin.forecasts.ensemble.manifest import Manifest, Member
from page_parts import PageParts

ISSUED = datetime(2014, 9, 17, 4, 0, tzinfo=UTC)
HOSTILE = '</script><b onload="x">'
HOURS = 3600.0


@pytest.fixture(autouse=True)
def _any_run(monkeypatch):
    """Accept the run of a page as a member: `test_forecast` has the check."""
    monkeypatch.setattr(forecast, "shown_by", lambda *_: "The run is member 00 of the forecast.")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A run of 6 hours."""
    path = tmp_path_factory.mktemp("forecast") / "run"
    times = tuple(np.arange(0.0, 21601.0, 3600.0))
    return whole_run.write(path, cell=60.0, cells=40, times=times, start="2014-09-17T04:00:00Z", speed=0.1)


@pytest.fixture(scope="module")
def stations(tmp_path_factory):
    places = [("Alpha", 38.9, -120.6), ("Bravo", 38.902, -120.598)]
    return small_stations.briefed(tmp_path_factory.mktemp("stations") / "stations.gpkg", places)


def brief(made, run, stations=None, **options):
    """Gather a briefing with the section of an ensemble."""
    return brief_section.add(briefing.gather(briefing.Request(run, stations, **options)), made)


def section(run, stations, made):
    sheet = SheetOptions(prepared=ISSUED + timedelta(hours=2))
    return "".join(brief(made, run, stations, sheet=sheet).sections)


def members(folder, run, arrivals, **head):
    """Write an ensemble on the run's fuel grid whose members arrive everywhere at one time (s) each."""
    axes = [np.load(run / f"fuel_{name}.npy") for name in ("latitude", "longitude")]
    shape = tuple(axis.size for axis in axes)
    each = [(Member(f"{i:02}"), np.full(shape, time, np.float32)) for i, time in enumerate(arrivals)]
    made = Manifest("Many", "made up", ISSUED, 6 * HOURS, (), **head)
    write.write(folder / "ensemble", made, *axes, each)
    return folder / "ensemble"


def rows(text: str) -> list[list[str]]:
    """Return the cells of the table's body as texts."""
    start = text.index("<tbody>", text.index('class="arrivals"'))
    body = ElementTree.fromstring(text[start : text.index("</tbody>", start) + 8].replace("<br>", ""))
    return [["".join(cell.itertext()) for cell in row] for row in body]


def test_times_are_counts_of_members(folder, stations, tmp_path):
    """20 members: 2 before the issue time, 8 by the second hour, 3 by the fifth, 7 not at all."""
    arrivals = [-60.0] * 2 + [2 * HOURS] * 8 + [5 * HOURS] * 3 + [np.inf] * 7
    made = members(tmp_path, folder, arrivals)
    text = section(folder, stations, made)
    assert "Issued 16 Sep 2014 20:00 -08, valid until 17 Sep 2014 02:00 -08<br>2.0 h old" in text
    assert "20 of 20 members" in text
    assert "Areas are of cells of 60 m." in text
    assert [cells[0] for cells in rows(text)] == ["Alpha", "Bravo"]
    for cells in rows(text):
        assert cells[1:5] == ["burned before", "16 Sep 22:00", "later or never", "7 of 20"]
    assert "2 of 20<br>burn it by" in text


def test_shares_of_many_members_are_percentages(folder, stations, tmp_path):
    made = members(tmp_path, folder, [HOURS] * 60)
    text = section(folder, stations, made)
    assert "10% of members<br>burn it by" in text
    assert "of 20<br>" not in text


def test_places_without_fire_are_named_once(folder, stations, tmp_path):
    axes = [np.load(folder / f"fuel_{name}.npy") for name in ("latitude", "longitude")]
    here = np.full((axes[0].size, axes[1].size), np.inf, np.float32)
    here[0, 0] = 60.0  # more than 1 km away
    head = Manifest("Few", "", ISSUED, 6 * HOURS, ())
    write.write(tmp_path / "e", head, *axes, [(Member("a"), here), (Member("b"), here)])
    text = section(folder, stations, tmp_path / "e")
    assert 'class="arrivals"' not in text
    said = (
        "No member reaches these places by 17 Sep 02:00, when the forecast ends: Alpha, Bravo. They may burn"
    )
    assert text.count(said) == 1
    row, column = (int(np.abs(axis - at).argmin()) for axis, at in zip(axes, (38.9, -120.6), strict=True))
    here[row, column - 8] = 60.0  # 480 m from Alpha
    write.write(tmp_path / "near", head, *axes, [(Member("a"), here), (Member("b"), here)])
    text = section(folder, stations, tmp_path / "near")
    assert (
        "No member burns these places, but fire comes within 1 km by 17 Sep 02:00: Alpha (in 2 of 2)" in text
    )


def test_the_page_escapes_the_names_of_an_ensemble(folder, tmp_path):
    made = members(tmp_path, folder, [HOURS, np.inf], perturbed=HOSTILE, synthetic=True)
    content = brief(made, folder)
    assert PageParts(page.html(content, 10_000_000))
    text = "".join(content.sections)
    assert HOSTILE not in text
    assert "SYNTHETIC" in text


def test_other_kinds_are_refused(folder, tmp_path):
    made = members(tmp_path, folder, [HOURS], kind="scenarios")
    with pytest.raises(InputError, match="holds named cases, such as best and worst; the page needs"):
        brief(made, folder)


def test_two_groups_of_members_are_two_outcomes(folder, stations, tmp_path):
    """Of 12 members, 5 burn all within the first hour and 7 a corner; the places burn in the 5 alone."""
    axes = [np.load(folder / f"fuel_{name}.npy") for name in ("latitude", "longitude")]
    each = []
    for i in range(12):
        burned = np.full((axes[0].size, axes[1].size), HOURS + 60.0 * i, np.float32)
        if i >= 5:
            burned[5:] = np.inf
        each.append((Member(f"{i:02}"), burned))
    write.write(tmp_path / "e", Manifest("Two", "", ISSUED, 6 * HOURS, ()), *axes, each)
    text = section(folder, stations, tmp_path / "e")
    assert "<b>Two outcomes:</b> 7 of 12 members burn" in text
    assert "acres, and 5 of 12 members burn" in text
    one = section(folder, stations, members(tmp_path, folder, [HOURS] * 12))
    assert "Two outcomes" not in one
    times = [HOURS + 60.0 * i for i in range(6)] + [5 * HOURS + 60.0 * i for i in range(6)]
    late = section(folder, stations, members(tmp_path / "late", folder, times))
    said = "two outcomes: 6 from 16 Sep 21:00 to 16 Sep 21:05; 6 from 17 Sep 01:00 to 17 Sep 01:05"
    assert late.count(said) == 2


def test_drawings_have_tables_and_descriptions(folder, stations, tmp_path):
    text = section(folder, stations, members(tmp_path, folder, [HOURS] * 3 + [np.inf]))
    assert text.count('<details class="as-table">') == 2
    assert "at least one of them" in text
    assert "the smallest, the median and the largest have 0, " in text
    assert text.count("epsilon inclusion depth") == 1
    assert "weights" not in text


def test_dots_count_the_members_that_do_not_arrive(folder, tmp_path):
    made = place_arrivals.sample(ensemble.open(members(tmp_path, folder, [60.0, np.inf])), [38.9], [-120.6])
    times = np.array([0.0, 60.0, np.inf, np.inf])
    drawn = ElementTree.fromstring(brief_chart.dots(times, made, "A & B", "UTC"))
    circles = [each for each in drawn if each.tag == "circle"]
    assert len(circles) == 2
    assert float(circles[0].get("cx")) < float(circles[1].get("cx"))
    assert [each.text for each in drawn if each.tag == "text"] == ["2 not yet"]
    assert drawn.get("aria-label") == "A & B: 2 of 4 members arrive, on 17 Sep 04:00, 17 Sep 04:01"
