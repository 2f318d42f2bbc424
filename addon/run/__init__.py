"""Model runs: times, areas, maps, readers of foreign formats, models, observations, and scores."""
