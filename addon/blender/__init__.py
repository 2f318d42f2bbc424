"""Blender compatibility: versions, node trees, devices, and marks on the data that Firetwin owns."""
