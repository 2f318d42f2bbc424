"""Run lengths of masks: the same characters as pycocotools."""

import numpy as np
import pytest
from firetwin.dataset import rle


def ragged(height, width, seed, share=0.5):
    return np.random.default_rng(seed).random((height, width)) < share


def test_lengths_are_by_columns_from_the_background():
    """0 1 / 0 1: two pixels of background, two of the mask; a first pixel of the mask has no background."""
    assert rle.encode(np.array([[0, 1], [0, 1]], bool)) == {"size": [2, 2], "counts": "22"}
    assert rle.encode(np.array([[1, 0], [1, 0]], bool)) == {"size": [2, 2], "counts": "022"}


@pytest.mark.parametrize("share", [0.0, 0.02, 0.5, 0.98, 1.0])
def test_characters_equal_those_of_pycocotools(share):
    coco = pytest.importorskip("pycocotools.mask")
    plume = np.zeros((480, 640), bool)
    plume[100:400, 200:500] = True
    for mask in (ragged(48, 64, 1, share), plume, plume & ragged(480, 640, 2, share)):
        expected = coco.encode(np.asfortranarray(mask, np.uint8))
        assert rle.encode(mask) == {"size": list(mask.shape), "counts": expected["counts"].decode()}
