"""Credits of tiles in pictures: all of them are there, within the picture, at a size that can be read."""

import pytest
from firetwin.imaging import credits
from firetwin.imaging.credits import Credits
from firetwin.render import manifest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

MANY = Credits(
    ("Data SIO, NOAA, U.S. Navy, NGA, GEBCO", "Landsat / Copernicus", "Airbus", "Maxar Technologies") * 2,
    ("Google Maps",),
)


def said(block):
    return " ".join((*block.at_left, *block.at_right))


def letters(text):
    return "".join(text.split())


@pytest.mark.parametrize(("width", "height"), [(640, 360), (1280, 720), (1920, 1080), (3840, 2160)])
def test_a_strip_along_the_bottom_names_all(width, height):
    (block,) = credits.blocks(MANY, width, height)
    assert block.top + block.height == height
    assert (block.left, block.width) == (0, width)
    assert block.at_left == ("Google Maps",)
    assert " ".join(block.at_right) == "; ".join(MANY.data)
    assert len(block.at_right) <= 3
    assert block.size >= 11
    assert block.height < 0.15 * height
    assert credits.strip_height(MANY, width, height) == block.height


def test_large_pictures_have_larger_text_and_a_smaller_strip():
    small, large = (credits.blocks(MANY, *size)[0] for size in ((640, 360), (1920, 1080)))
    assert large.size > small.size
    assert large.height / 1080 < small.height / 360


def test_a_panorama_has_a_block_below_the_horizon_of_each_eye():
    upper, lower = credits.blocks(MANY, 2048, 2048, around=True)
    assert lower.top - upper.top == 1024
    for block, horizon in ((upper, 512), (lower, 1536)):
        assert horizon < block.top < block.top + block.height <= horizon + 512
        assert block.left + block.width // 2 == 1024
        assert letters(said(block)) == letters("Google Maps" + "; ".join(MANY.data))


@settings(max_examples=examples(60), deadline=None)
@given(
    st.lists(st.text(st.characters(codec="utf-8", exclude_categories=["C", "Z"]), max_size=40), max_size=30),
    st.lists(st.text("abc XYZ", min_size=1, max_size=12), max_size=2),
    st.integers(64, 2000),
    st.integers(36, 1200),
)
def test_no_credit_is_left_out(data, logo, width, height):
    """Credits of any text: every letter is drawn, in lines that fit, or the text is rejected."""
    words = Credits(tuple(data), tuple(logo))
    try:
        found = credits.blocks(words, width, height)
    except ValueError as error:
        assert "do not fit" in str(error)  # noqa: PT017
        return
    for block in found:
        assert letters("".join(block.at_right)) == letters("; ".join(data))
        assert letters("".join(block.at_left)) == letters("  ·  ".join(logo))
        assert 0 <= block.top < block.top + block.height == height
        left = max((credits.estimate_width(each, block.size) for each in block.at_left), default=0.0)
        right = max((credits.estimate_width(each, block.size) for each in block.at_right), default=0.0)
        signs = [len(each) for each in (*block.at_left, *block.at_right)]
        assert left + right <= block.width or min(signs, default=0) <= 1


def test_a_picture_that_is_too_small_is_refused():
    with pytest.raises(ValueError, match="64 x 36 pixels; choose a larger resolution"):
        credits.blocks(MANY, 64, 36)
    assert credits.blocks(Credits(), 64, 36) == []


def test_an_entry_of_the_manifest_names_credits_and_what_is_missing():
    made_with = {
        "tiles": {"chosen": "1", "missing": ["c.glb"]},
        "credits": {"data": ["A"], "logo": ["B"]},
    }
    assert manifest.read_credits(made_with) == Credits(("A",), ("B",))
    assert manifest.credit_entry(made_with, Credits(("A", "D"))) == {
        "credits": ["A", "D"],
        "services": ["B"],
        "missing_tiles": ["c.glb"],
    }
    assert manifest.credit_entry({}) == {}
