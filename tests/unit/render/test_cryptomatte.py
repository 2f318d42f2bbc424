"""Cryptomatte: hashes against known ones, and ranks of overlapping names."""

import json

import numpy as np
import pytest
from firetwin.imaging import cryptomatte


def test_known_identifiers():
    # Blender 4.5 writes both for a layer "ViewLayer.CryptoObject" with an object "Cube".
    assert cryptomatte.manifest({"Cube": cryptomatte.identify(["Cube"])[0]}) == '{"Cube":"a8fce865"}'
    assert "cryptomatte/542cafa/name" in cryptomatte.attributes("ViewLayer.CryptoObject", "{}")


def test_hashes_are_those_of_mmh3():
    mmh3 = pytest.importorskip("mmh3")
    random = np.random.default_rng(1)
    names = ["", "fire", "Bäume", *("".join(map(chr, random.integers(1, 900, n % 23))) for n in range(400))]
    expected = [mmh3.hash(name.encode(), signed=False) for name in names]
    assert cryptomatte.hash_names(names).tolist() == expected


def test_identifiers_are_finite_and_normal():
    found = cryptomatte.identify([f"tree_{number:08d}" for number in range(20_000)])
    assert np.isfinite(found).all()
    assert (np.abs(found) >= np.finfo(np.float32).tiny).all()
    assert len(np.unique(found)) > 19_990  # one exponent of 128 is moved to its neighbour


def test_equal_names_add_up_and_the_greatest_coverage_comes_first():
    numbers = np.array([[5.0, 7.0, 5.0, 9.0]], np.float32)
    found = cryptomatte.ranked(numbers.T, np.array([[0.25], [0.375], [0.25], [0.0]], np.float32))
    assert found[0].tolist() == [5.0, 0.5, 7.0, 0.375, *[0.0] * 8]


def test_the_least_coverages_beyond_the_ranks_are_dropped():
    cover = np.arange(1, 9, dtype=np.float32) / 36
    found = cryptomatte.ranked(np.arange(1, 9, dtype=np.float32), cover[:, None])
    assert found[0, ::2].tolist() == [8.0, 7.0, 6.0, 5.0, 4.0, 3.0]
    assert found[0, 1::2] == pytest.approx(cover[:1:-1])


def test_a_manifest_is_in_the_header_or_in_a_file():
    inside = cryptomatte.attributes("CryptoClass", '{"fire":"00000001"}')
    beside = cryptomatte.attributes("CryptoTree", "a.json", is_file=True)
    assert [json.loads(text) for name, text in inside.items() if name.endswith("/manifest")] == [
        {"fire": "00000001"}
    ]
    assert [text for name, text in beside.items() if name.endswith("/manif_file")] == ["a.json"]
    assert len({name.split("/")[1] for name in (*inside, *beside)}) == 2
