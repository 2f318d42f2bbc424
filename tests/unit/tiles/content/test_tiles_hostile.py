"""Damaged tilesets and subtrees: each is read, or refused by an InputError; nothing else happens."""

import json
import random

import pytest
from firetwin.errors import InputError
from firetwin.tiles import json_text
from firetwin.tiles.loader import Loader
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples
from tile_samples import SAMPLES
from tilesets import Memory, as_bytes

ODD = [
    None,
    True,
    False,
    -1,
    0,
    1,
    0.5,
    1e308,
    -1e308,
    2**70,
    "",
    "x",
    "../x",
    "9" * 400,
    [],
    {},
    [[]],
    [None],
]


def places(value, path=()):
    """Paths of all values within a JSON value."""
    found = [path]
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in inner:
        found += places(each, (*path, key))
    return found


def damaged(value, rng):
    """One value replaced, removed or doubled."""
    value = json.loads(json.dumps(value))
    path = rng.choice(places(value)[1:])
    holder = value
    for key in path[:-1]:
        holder = holder[key]
    what = rng.random()
    if what < 0.6:
        holder[path[-1]] = rng.choice(ODD)
    elif what < 0.8:
        del holder[path[-1]]
    elif isinstance(holder, list):
        holder.append(holder[path[-1]])
    else:
        holder[path[-1]] = [holder[path[-1]]]
    return value


def refusal(files):
    """Return the reason why a tileset is rejected; None if it is read."""
    try:
        loader = Loader(Memory(files))
        loader.expand_all()
        loader.check(range(loader.tree.contents))
        loader.tree.flags()
    except InputError as error:
        return error
    return None


@pytest.mark.parametrize("name", SAMPLES)
def test_damaged_json(name):
    rng = random.Random(name)
    refused = 0
    for _ in range(120):
        files = dict(SAMPLES[name])
        file = rng.choice([each for each, value in files.items() if isinstance(value, dict)])
        files[file] = damaged(files[file], rng)
        error = refusal(files)
        refused += error is not None
        assert error is None or error.path in files
    assert refused > 10


@pytest.mark.parametrize("name", [name for name in SAMPLES if "implicit" in name])
def test_damaged_bytes(name):
    rng = random.Random(name)
    for _ in range(200):
        files = dict(SAMPLES[name])
        file = rng.choice([each for each, value in files.items() if isinstance(value, bytes)])
        data = bytearray(files[file])
        for _ in range(rng.randint(1, 4)):
            data[rng.randrange(len(data))] = rng.randrange(256)
        files[file] = bytes(data[: rng.choice([len(data), rng.randrange(len(data))])])
        error = refusal(files)
        assert error is None or error.path in files


@settings(deadline=None, max_examples=examples(300))
@given(st.binary(max_size=60))
def test_any_bytes_are_json_or_refused(data):
    try:
        value = json_text.parse(data, "x").value
    except InputError:
        return
    assert json.loads(as_bytes(value)) == value
