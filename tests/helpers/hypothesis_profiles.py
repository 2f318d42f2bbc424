"""Hypothesis profiles: how many examples a property test draws.

A test states the number of examples of the profile ``thorough``, which tests/slow.sh uses. The default
profile draws 30 % of them, and ``quick`` (tests/quick.sh) 10 %, but at least `LEAST`. Examples are random, so
repeated runs draw different ones, and Hypothesis repeats those that failed.
"""

from hypothesis import settings

LEAST = 8

for name, percent in (("thorough", 100), ("firetwin", 30), ("quick", 10)):
    settings.register_profile(name, deadline=None, max_examples=percent)  # no deadline: machines differ


def examples(count: int) -> int:
    """Scale a number of examples to the profile of this run; call it when a test module loads."""
    return max(min(count, LEAST), round(count * settings.default.max_examples / 100))
