"""Smoke without Blender: the solved flow, its snapshots and cache, and the volumes painted from them."""
