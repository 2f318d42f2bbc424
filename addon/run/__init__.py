"""Model runs: times, areas, maps, readers of foreign formats, models, observations, and scores."""

from .from_arrays import write

__all__ = ["write"]
