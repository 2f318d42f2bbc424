"""Rendering: view layers, engine, frame plan, pictures, films, and the store of finished files."""
