"""Tests that need pictures: each asks for as few pixels as prove its point."""

from near_fire import *  # noqa: F403
from small_scene import *  # noqa: F403
