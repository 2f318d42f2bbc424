"""Firetwin: fly through and film the output of a coupled fire-atmosphere model."""
