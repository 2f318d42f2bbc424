"""Run lengths of masks: the same characters as pycocotools, and lossless."""

import numpy as np
import pytest
from firetwin.dataset import rle
from hypothesis import given
from hypothesis import strategies as st


def ragged(height, width, seed, share=0.5):
    return np.random.default_rng(seed).random((height, width)) < share


@given(
    st.integers(1, 40), st.integers(1, 40), st.integers(0, 99), st.sampled_from([0.0, 0.01, 0.5, 0.99, 1.0])
)
def test_masks_come_back(height, width, seed, share):
    mask = ragged(height, width, seed, share)
    np.testing.assert_array_equal(rle.decode(rle.encode(mask)), mask)


def test_lengths_are_by_columns_from_the_background():
    """0 1 / 0 1: two pixels of background, two of the mask; a first pixel of the mask has no background."""
    assert rle.encode(np.array([[0, 1], [0, 1]], bool)) == {"size": [2, 2], "counts": "22"}
    assert rle.encode(np.array([[1, 0], [1, 0]], bool)) == {"size": [2, 2], "counts": "022"}


@pytest.mark.parametrize("share", [0.02, 0.5, 0.98])
def test_characters_equal_those_of_pycocotools(share):
    coco = pytest.importorskip("pycocotools.mask")
    plume = np.zeros((480, 640), bool)
    plume[100:400, 200:500] = True
    for mask in (ragged(48, 64, 1, share), plume, plume & ragged(480, 640, 2, share)):
        expected = coco.encode(np.asfortranarray(mask, np.uint8))
        assert rle.encode(mask) == {"size": list(mask.shape), "counts": expected["counts"].decode()}


@pytest.mark.parametrize("counts", ["", "22o", "23", "2", "é", "\n2"])
def test_damaged_lengths_are_refused(counts):
    with pytest.raises(ValueError, match=r"run lengths|ascii"):
        rle.decode({"size": [2, 2], "counts": counts})
