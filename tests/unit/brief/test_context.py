"""Map features of the user on the map sheet: order, styles and symbols."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from firetwin.brief import context, line_labels, sheet_map
from firetwin.brief.map_frame import MapFrame
from firetwin.brief.mercator import Box
from firetwin.errors import InputError, UsageError
from firetwin.geometry.rectangles import overlap
from firetwin.imaging import map_symbols

FRAME = MapFrame.fitted(Box(38.7, -120.7, 39.1, -120.2), (0.0, 0.0, 200.0, 150.0))


def write(path, *features):
    path.write_text(
        json.dumps(
            {
                "type": "FeatureCollection",
                "features": [
                    {"type": "Feature", "properties": more, "geometry": {"type": kind, "coordinates": where}}
                    for kind, where, more in features
                ],
            }
        )
    )
    return path


ROAD = ("LineString", [[-120.6, 38.8], [-120.4, 38.9]], {"name": "Road"})
ZONE = ("Polygon", [[[-120.5, 38.8], [-120.4, 38.8], [-120.4, 38.9], [-120.5, 38.8]]], {"zone": "E101"})


def content(found):
    made = sheet_map.Content(FRAME, 1.0)
    for each in found:
        sheet_map._outlines(made, each)
        sheet_map._symbols(made, each)
    return made


def test_names_and_files_are_read_in_the_order_of_their_priority(tmp_path):
    road, zone = write(tmp_path / "a.geojson", ROAD), write(tmp_path / "b.geojson", ZONE)
    found = context.read([("zones", zone), ("escape", road), ("roads", road), ("water", zone)])
    assert [each.name for each in found] == ["water", "roads", "escape", "zones"]
    made = content(found)
    assert list(made.legend) == ["Water", "Road", "escape", "Evacuation zone"]
    assert "E101" in "".join(made.labels)


def test_categories_of_the_standard_choose_the_symbol(tmp_path):
    line = [[-120.6, 38.8], [-120.4, 38.9]]
    file = write(
        tmp_path / "ops.geojson",
        ("LineString", line, {"FeatureCategory": "completed dozer line"}),
        ("LineString", line, {"FeatureCategory": "Completed Hand Line"}),
        ("Point", [-120.5, 38.85], {"FeatureCategory": "Fire Origin", "Label": "Sep 13"}),
        ("Point", [-120.4, 38.95], {"FeatureCategory": "Something new"}),
        ("Point", [-100.0, 38.95], {"FeatureCategory": "Helibase"}),
    )
    drawn = content(context.read([("operations", file)]))
    assert list(drawn.legend) == ["Completed Dozer Line", "Completed Hand Line", "Fire Origin", "operations"]
    crosses = [each for each in drawn.lines if "rotate" in each and "L0.9,0.8" in each]
    x, y = FRAME.place([38.8, 38.9], [-120.6, -120.4])
    assert len(crosses) == pytest.approx(np.hypot(np.ptp(x), np.ptp(y)) / 1.9, abs=1)
    assert ">H</text>" in "".join(drawn.lines)
    assert "Sep 13" in "".join(drawn.labels)


@pytest.mark.parametrize("name", map_symbols.POINTS)
def test_symbols_stay_in_their_box(name):
    numbers = [float(each) for each in re.findall(r'(?<=[ "ML,HVQ])-?\d+\.\d+', map_symbols.POINTS[name])]
    assert max(map(abs, numbers), default=0.0) <= 1.8


def test_labels_do_not_overlap():
    made = sheet_map.Content(FRAME, 1.0)
    for k in range(40):
        made.point("Named place", 38.9 + 0.002 * k, -120.45, "Named place", [f"Place {k}"])
    assert 5 < len(made.labels) < 40
    boxes = made.taken
    labels = [box for box in boxes if box[2] - box[0] > 5.0]
    assert not any(overlap(a, b) for i, a in enumerate(labels) for b in labels[:i])


def test_a_line_has_its_label_once_where_there_is_space(tmp_path):
    road = ("LineString", [[-120.6, 38.8], [-120.4, 38.8]], {"name": "Wentworth Springs Road"})
    short = ("LineString", [[-120.6, 38.8], [-120.59, 38.8]], {"name": "Wentworth Springs Road"})
    (each,) = context.read([("roads", write(tmp_path / "a.geojson", road, short))])
    made = content([each])
    line_labels.write(made, each)
    assert sum(">Wentworth Springs Road<" in part and "aria-hidden" not in part for part in made.labels) == 1
    full = content([each])
    full.taken.append((0.0, 0.0, 200.0, 150.0))  # no space
    line_labels.write(full, each)
    assert full.labels == []


def test_routes_have_the_numbers_of_the_tables_in_place_of_names(tmp_path):
    def sent(division, name, north):
        about = {"kind": "resource", "division": division, "name": name, "origin": "exercise"}
        return "LineString", [[-120.6, north], [-120.4, north]], about

    file = write(
        tmp_path / "a.geojson",
        *(sent("B", f"Long name {k}", 38.8) for k in range(3)),
        sent("A", "First", 38.9),
        sent("B", "Elsewhere", 38.85),
        sent("B", "At the first station", 38.8),
    )
    found = context.read([("allocation", file)])
    made = content(found)
    line_labels.write(made, found[0])
    shown = {part.partition(">")[2].partition("<")[0] for part in made.labels}
    assert shown == {"1", "2-4, 6", "5"}
    assert list(made.legend) == ["Resource, number as in the table Divisions"]


def test_a_hostile_label_stays_a_text(tmp_path):
    file = write(tmp_path / "a.geojson", ("Point", [-120.5, 38.85], {"name": "<script>"}))
    made = content(context.read([("<b>", file)]))
    assert "<script" not in "".join(made.labels)


def test_what_cannot_be_used_is_named(tmp_path):
    with pytest.raises(UsageError, match="--context: 'roads' is not NAME=FILE"):
        context.parse("roads")
    assert context.parse("roads=a=b.gpkg") == ("roads", Path("a=b.gpkg"))
    with pytest.raises(InputError, match="is not a file of map features"):
        context.read([("roads", tmp_path / "a.txt")])
    with pytest.raises(InputError, match="has no features"):
        context.read([("roads", write(tmp_path / "none.geojson"))])
