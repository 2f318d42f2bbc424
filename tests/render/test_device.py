"""The picture of one sample that loads the kernels of Cycles."""

import bpy
from firetwin.jobs import device


def test_one_sample_is_drawn_and_nothing_remains():
    before = len(bpy.data.scenes), len(bpy.data.objects), len(bpy.data.cameras)
    device.draw_sample(None, lambda text: None)
    assert (len(bpy.data.scenes), len(bpy.data.objects), len(bpy.data.cameras)) == before
