"""Settings and the scene file format: schema, reader, writer, JSON Schema."""
