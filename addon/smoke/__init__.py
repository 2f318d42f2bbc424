"""Smoke: domains, flow solver runs, snapshots, cache, and OpenVDB volumes."""
