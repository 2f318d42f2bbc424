"""Tests that need pictures: each asks for as few pixels as prove its point."""

from small_scene import *  # noqa: F403
