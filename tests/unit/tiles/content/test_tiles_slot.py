"""Places of pictures in tiled images: each has one, and a rebuild moves as few as it can."""

import numpy as np
from firetwin.scene.tiles.slot import Slot, arrange


def test_pictures_have_parts_of_their_own():
    names = [f"{k}.jpg" for k in range(1001)] + ["a.png", "0.jpg"]
    slots = arrange(names)
    assert len(set(slots.values())) == len(slots) == 1002
    assert {slots["0.jpg"].image, slots["1000.jpg"].image, slots["a.png"].image} == {0, 1, 2}
    uv = slots["13.jpg"].moved(np.array([[-0.2, 0.5], [1.0, 1.0]], np.float32))
    assert np.allclose(uv, [[3.0, 1.5], [4.0, 2.0]], atol=1e-4)
    assert (np.floor(uv) == [3.0, 1.0]).all()


def test_what_has_a_place_keeps_it():
    before = arrange([f"{k}.jpg" for k in range(5)] + ["a.png"])
    after = arrange(["4.jpg", "new.jpg", "0.jpg", "3.jpg", "a.png", "newer.jpg"], before)
    assert all(after[name] == before[name] for name in ("0.jpg", "3.jpg", "4.jpg", "a.png"))
    assert after["new.jpg"] == before["1.jpg"]
    assert after["newer.jpg"] == before["2.jpg"]


def test_an_image_never_lacks_its_first_part():
    before = arrange(["0.jpg", "1.jpg", "2.jpg"])
    assert arrange(["1.jpg", "2.jpg"], before) == {"1.jpg": Slot(0, 0), "2.jpg": Slot(0, 1)}
    assert arrange(["a.png"], {"0.jpg": Slot(0, 0), "a.png": Slot(1, 0)}) == {"a.png": Slot(0, 0)}


def test_places_that_contradict_one_another_are_given_anew():
    known = {"0.jpg": Slot(0, 0), "1.jpg": Slot(0, 0)}
    assert set(arrange(["0.jpg", "1.jpg"], known).values()) == {Slot(0, 0), Slot(0, 1)}
    mixed = {"0.jpg": Slot(0, 0), "a.png": Slot(0, 1)}
    assert set(arrange(["0.jpg", "a.png"], mixed).values()) == {Slot(0, 0), Slot(1, 0)}
