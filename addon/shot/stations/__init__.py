"""Station signs, routes and labels of a shot."""
