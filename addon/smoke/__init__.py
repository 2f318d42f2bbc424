"""Smoke without Blender: flow solver runs, snapshots, volume cache, and painting of OpenVDB volumes."""
