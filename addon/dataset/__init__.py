"""Training data: labelled pictures of fires for detectors, drawn from a plan, with splits and a card."""
