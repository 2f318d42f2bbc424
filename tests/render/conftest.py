"""Tests that need pictures: each asks for as few pixels as prove its point."""

from importlib.util import find_spec

from near_fire import *  # noqa: F403
from small_scene import *  # noqa: F403

collect_ignore = [] if find_spec("firetwin.forecasts") else ["test_comparison.py"]
