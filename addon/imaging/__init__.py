"""Pictures drawn from arrays: colour bar, panel sheet, and split screen."""
