"""Passes of forecasts: the pictures of a member with fronts, shares and names, alone or beside others."""

REQUIRES = "forecast.ensemble", "an ensemble; name its folder as forecast.ensemble"
"""Key that the passes need."""
CODE = ("forecasts/ensemble", "forecasts/forecast.py")
"""Code on which their pictures depend."""
