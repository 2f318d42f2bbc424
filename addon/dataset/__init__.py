"""Training data: labelled samples of many short scenes, from one plan."""
