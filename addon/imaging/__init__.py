"""Pictures drawn from arrays: colour bar, sheet of panels, split screen."""
