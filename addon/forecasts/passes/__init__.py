"""Passes of forecasts: pictures of one member, or of several, with fronts, shares and names."""

REQUIRES = "forecast.ensemble", "an ensemble; name its folder as forecast.ensemble"
"""Key that the passes need."""
CODE = ("forecasts/ensemble", "forecasts/forecast.py")
"""Code on which their pictures depend."""
ASPECTS = frozenset({"time", "camera", "film", "picture", "forecast"})
"""Settings on which their pictures depend; those that tint the ground also depend on the terrain."""
