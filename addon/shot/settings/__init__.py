"""Every setting once, and the scene file that it is written in: schema, reader, writer, JSON Schema."""
