"""Tests of whole processes: commands, kills, shared folders, films, other engines."""

from small_scene import *  # noqa: F403
