"""Settings and scene files: reader, writer and the list of all keys."""
