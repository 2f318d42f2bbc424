"""Deliveries: versions of a film's finished files, with chosen names and hashes, never overwritten."""
