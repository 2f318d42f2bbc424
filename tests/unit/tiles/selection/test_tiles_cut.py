"""The choice for a whole shot, from JSON to contents, against brute force over frames, views and tiles."""

import numpy as np
import pytest
import tile_views
from firetwin.tiles import cut
from firetwin.tiles.cut import Budget, Views
from firetwin.tiles.loader import Loader
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples
from tile_views import HERE, looking, names
from tilesets import GLB, Memory, box, load, subtree, tile, tileset


def random_tileset(rng, files, depth=0, place=(0.0, 0.0, 0.0), half=40.0):
    """A tile and its descendants; some of them go into separate files."""
    name = f"{len(files)}.glb"
    child = tile(half * rng.uniform(0.05, 0.3), None, volume=box(*place, half=half))
    if rng.random() < 0.85:
        child["content"] = {"uri": name}
        files[name] = GLB
    if rng.random() < 0.7 or depth == 0:
        child["refine"] = str(rng.choice(["ADD", "REPLACE"]))
    if rng.random() < 0.1:
        child["viewerRequestVolume"] = {"sphere": [*place, float(rng.uniform(10, 120))]}
    if depth < 4 and rng.random() < 0.85:
        child["children"] = [
            random_tileset(rng, files, depth + 1, tuple(place + rng.uniform(-0.5, 0.5, 3) * half), half / 2)
            for _ in range(rng.integers(1, 4))
        ]
    if depth and rng.random() < 0.15:
        inner = f"{len(files)}.json"
        files[inner] = tileset(child | {"refine": child.get("refine", "REPLACE")})
        return tile(child["geometricError"] * 1.5, inner, volume=child["boundingVolume"])
    return child


def brute(files, views, eyes, target):
    """Names of the contents that the shot needs, by recursion over the JSON; None: that is not certain."""
    certain = True

    def sees(each):
        nonlocal certain
        numbers = np.array(each["boundingVolume"]["box"])
        volume = (numbers[None, :3], np.eye(3)[None], numbers[None, [3, 7, 11]], np.zeros(1))
        least, most = tile_views.errors(volume, np.array([each["geometricError"]]), views)
        certain &= bool(least[0] == most[0] and abs(least[0] - target) > 1e-9)
        return most[0]

    def inside(each):
        request = each.get("viewerRequestVolume")
        if request is None:
            return True
        *place, radius = request["sphere"]
        return any(np.linalg.norm(eye - place) <= radius for eye in eyes)

    def visit(each, above, inherited, forced):
        """Contents of a requested tile; None if it is omitted."""
        error = sees(each)
        if not inside(each) or (error < 0 and not forced):
            return None
        uri = each.get("content", {}).get("uri")
        replaces = each.get("refine", inherited) == "REPLACE"
        if uri and uri.endswith(".json"):
            root = files[uri]["root"]
            return visit(root, each["geometricError"], "REPLACE" if replaces else "ADD", forced) or set()
        empty = uri is None and each["geometricError"] >= above and "children" in each
        below = []
        if empty or error > target:
            force = replaces or (empty and forced)
            word = "REPLACE" if replaces else "ADD"
            below = [
                found
                for child in each.get("children", [])
                if (found := visit(child, each["geometricError"], word, force)) is not None
            ]
        mine = {uri} if uri and not (below and replaces) else set()
        return mine.union(*below)

    found = visit(files["tileset.json"]["root"], np.inf, "REPLACE", False) or set()
    return sorted(found) if certain else None


@settings(deadline=None, max_examples=examples(60))
@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.sampled_from([4.0, 16.0, 64.0]))
def test_a_choice_is_what_brute_force_over_frames_and_views_finds(seed, count, target):
    rng = np.random.default_rng(seed)
    files = {}
    files["tileset.json"] = tileset(random_tileset(rng, files))
    shown = tile_views.random_views(rng, count)
    eyes = shown[0][~shown[3]]
    wanted = brute(files, shown, eyes, target)
    assume(wanted is not None)
    loader = Loader(Memory(files))
    views = Views(tile_views.view_set(shown), shown[-1], eyes)
    choice = cut.select_tiles(loader, views, HERE, target)
    assert sorted(names(loader, choice)) == wanted
    again = cut.select_tiles(Loader(Memory(files)), views, HERE, target)
    assert again.contents.tolist() == choice.contents.tolist()


def test_nothing_more_is_read_than_the_shot_shows():
    files = {"near.json": tileset(tile(1.0, "n.glb", volume=box(100.0))), "n.glb": GLB, "a.glb": GLB}
    files["behind.json"] = tileset(tile(1.0, "b.glb", volume=box(-100.0)))
    below = [
        tile(5.0, "near.json", volume=box(100.0)),
        tile(5.0, "behind.json", volume=box(-100.0)),
    ]
    loader = load(tile(50.0, "a.glb", below, volume=box(half=200.0), refine="ADD"), files)
    choice = cut.select_tiles(loader, looking(0.0), HERE, 16.0)
    assert names(loader, choice) == ["a.glb", "n.glb"]
    assert loader.source.reads == ["tileset.json", "near.json", "a.glb", "n.glb"]
    assert choice.message() == ""


def test_the_error_is_that_of_the_nearest_point_in_pixels_of_the_picture():
    """A box whose nearest face is 100 m away; 1080 pixels over 1 m at 1 m."""
    root = tile(1.0, "a.glb", [tile(0.1, "b.glb", volume=box(101.0))], volume=box(101.0), refine="REPLACE")
    files = {"a.glb": GLB, "b.glb": GLB}
    for target, wanted in ((10.79, ["b.glb"]), (10.81, ["a.glb"])):
        loader = load(root, files)
        assert names(loader, cut.select_tiles(loader, looking(0.0), HERE, target)) == wanted
    scaled = np.diag([0.5, 0.5, 0.5, 1.0])  # half as large, half as far
    for target, wanted in ((10.79, ["b.glb"]), (10.81, ["a.glb"])):
        loader = load(root, files)
        assert names(loader, cut.select_tiles(loader, looking(0.0), scaled, target)) == wanted


def test_a_budget_is_kept_and_the_price_said():
    below = [tile(1.0, f"{i}.glb", volume=box(50.0 + 40 * i, half=2.0)) for i in range(4)]
    root = tile(30.0, "r.glb", below, volume=box(100.0, half=80.0), refine="REPLACE")
    files = {f"{i}.glb": GLB for i in range(4)} | {"r.glb": GLB}
    loader = load(root, files)
    free = cut.select_tiles(loader, looking(0.0), HERE, 2.0)
    assert len(free.tiles) == 4
    kept = cut.select_tiles(loader, looking(0.0), HERE, 2.0, Budget(tiles=3))
    assert names(loader, kept) == ["r.glb"]
    assert kept.error > 1000.0
    assert "not 2, to stay in the budget" in kept.message()
    by_bytes = cut.select_tiles(load(root, files), looking(0.0), HERE, 2.0, Budget(bytes=30))
    assert (by_bytes.bytes, by_bytes.fits) == (12, True)
    none = cut.select_tiles(load(root, files), looking(0.0), HERE, 2.0, Budget(tiles=0))
    assert "even the coarsest" in none.message()
    known = dict.fromkeys(range(5), 1000)
    by_triangles = cut.select_tiles(loader, looking(0.0), HERE, 2.0, Budget(triangles=2000), triangles=known)
    assert by_triangles.triangles == 1000


def test_contents_are_handed_over_once():
    got = []
    loader = load(tile(1.0, "a.glb", volume=box(50.0)), {"a.glb": GLB})
    for _ in range(2):
        cut.select_tiles(
            loader, looking(0.0), HERE, 2.0, on_content=lambda number, data: got.append((number, data))
        )
    assert got == [(0, GLB)]
    unread = load(tile(1.0, "a.glb", volume=box(50.0)), {})
    assert names(unread, cut.select_tiles(unread, looking(0.0), HERE, 2.0, fetch=False)) == ["a.glb"]


def test_an_added_content_out_of_sight_is_left_out():
    both = [
        {"uri": "a.glb", "boundingVolume": box(50.0)},
        {"uri": "b.glb", "boundingVolume": box(-50.0)},
    ]
    wide = tile(0.0, volume=box(0.0, half=60.0), contents=both)
    files = {"a.glb": GLB, "b.glb": GLB}
    for word, wanted in (("ADD", ["a.glb"]), ("REPLACE", ["a.glb", "b.glb"])):
        loader = load(tile(50.0, None, [wide], volume=box(0.0, half=60.0), refine=word), files)
        assert names(loader, cut.select_tiles(loader, looking(0.0), HERE, 2.0)) == wanted


def test_a_request_volume_asks_for_an_eye_of_any_frame():
    inner = tile(1.0, "p.glb", volume=box(50.0), viewerRequestVolume={"sphere": [0, 0, 0, 15]})
    root = tile(30.0, "r.glb", [inner], volume=box(50.0, half=20.0), refine="ADD")
    for x, wanted in ((0.0, ["r.glb", "p.glb"]), (-20.0, ["r.glb"])):
        loader = load(root, {"p.glb": GLB, "r.glb": GLB})
        assert names(loader, cut.select_tiles(loader, looking(x), HERE, 2.0)) == wanted


def test_subtrees_are_read_as_they_are_reached():
    own = {"subdivisionScheme": "QUADTREE", "subtreeLevels": 1, "availableLevels": 4}
    own["subtrees"] = {"uri": "{level}.{x}.{y}"}
    root = tile(64.0, "{level}_{x}_{y}", implicitTiling=own, volume=box(half=100.0), refine="REPLACE")
    files = {f"{n}.{x}.{y}": subtree(1, [1], 1) for n in range(4) for x in range(8) for y in range(8)}
    files |= {f"{n}_{x}_{y}": GLB for n in range(4) for x in range(8) for y in range(8)}
    loader = load(root, files)
    few = cut.select_tiles(loader, looking(-1000.0), HERE, 50.0)
    assert names(loader, few) == ["1_0_0", "1_1_0", "1_0_1", "1_1_1"]
    assert [uri for uri in loader.source.reads if "." in uri] == [
        *("tileset.json", "0.0.0", "1.0.0", "1.1.0", "1.0.1", "1.1.1"),
    ]
    assert len(cut.select_tiles(loader, looking(-1000.0), HERE, 1.0).tiles) == 64


@pytest.mark.parametrize("count", [10_000])
def test_ten_thousand_tiles_are_chosen_in_few_passes(count):
    """Work, not time: the tree is measured once, and the choice is one pass over it."""
    below = [tile(1.0, f"{i}.glb", volume=box(50.0 + i % 100, i // 100 - 50.0)) for i in range(count)]
    loader = load(tile(30.0, None, below, volume=box(100.0, half=80.0), refine="ADD"))
    choice = cut.select_tiles(loader, looking(0.0), HERE, 2.0, fetch=False)
    assert 5_000 < len(choice.tiles) < count
    assert loader.source.reads == ["tileset.json"]
