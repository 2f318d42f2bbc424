"""Sentences that name what changed since pictures and films were made."""

from dataclasses import replace

import pytest
from firetwin.render import changes
from firetwin.render.picture import Picture
from firetwin.render.store import Store

NOW = {
    "frames": [[1, "a"], [2, "b"]],
    "fps": "24",
    "codec": "h264",
    "kind": "review",
    "timecode": "01:00:00:00",
    "captions": [0, 1],
}
OLD = {"frames": NOW["frames"], "fps": 24.0, "captions": [0, 1]}  # as the last version recorded films


@pytest.mark.parametrize(
    ("before", "reasons"),
    [
        (None, ["new"]),
        (NOW, ["missing or damaged"]),
        (OLD, ["had no timecode track"]),
        (NOW | {"codec": "prores"}, ["codec was prores"]),
        (NOW | {"fps": "24000/1001"}, ["had 23.976 frames per second"]),
        (NOW | {"captions": [0, 2]}, ["other captions"]),
        (NOW | {"slate": [["", "King"]]}, ["had a slate"]),
        (NOW | {"frames": [[1, "a"], [2, "c"]]}, ["1 of 2 pictures rendered again"]),
        (NOW | {"frames": [[1, "a"]]}, ["had 1 picture, now 2"]),
        (
            OLD | {"fps": 12, "frames": []},
            ["had no timecode track", "had 12 frames per second", "had 0 pictures, now 2"],
        ),
    ],
)
def test_what_changed_in_a_film(before, reasons):
    assert changes.of_film(before, NOW) == reasons


def test_films_with_the_same_reasons_are_named_together():
    films = [
        ("drone/a.mp4", ["new"]),
        ("b.mov", ["new"]),
        ("c.mp4", ["had no timecode track", "other captions"]),
    ]
    assert changes.describe_films(films) == (
        "encoding drone/a.mp4 and b.mov (new), c.mp4 (had no timecode track; other captions)"
    )
    many = [(f"{number}.mp4", ["new"]) for number in range(9)]
    assert changes.describe_films(many) == "encoding 0.mp4, 1.mp4, 2.mp4 and 6 more (new)"


def test_what_changed_in_pictures(tmp_path):
    now = {
        "versions": {"firetwin": "2", "blender": "4.5"},
        "sources": {"render/layers.py": "new"},
        "settings": {"smoke": {"cloud_base": 9.0, "detail": 1.0}, "samples": 3},
        "run": {"heat_flux": "0"},
    }
    before = now | {
        "versions": {"firetwin": "1", "blender": "4.5"},
        "sources": {},
        "settings": {"smoke": {"cloud_base": 8.0, "detail": 1.0}},
    }
    first = Picture("drone", 1, "rgb")
    with Store(tmp_path, create=True) as store:
        store.add(before, {path: {} for path in first.files()})
        damaged = replace(first, name="normal")
        store.add(now, {path: {} for path in damaged.files()})
        pictures = [first, replace(first, frame=2), replace(first, name="depth"), damaged]
        differing = changes.of_pictures(
            store, pictures, {("drone", name): now for name in ("rgb", "depth", "normal")}
        )
    assert differing == [
        "version of Firetwin",
        "code (render/layers.py)",
        "settings (samples and smoke.cloud_base)",
        "missing or damaged files",
    ]
    assert changes.of_picture(now, now | {"further": {"members.npz": "1"}}) == ["other files of the scene"]
