"""Light without Blender: sun and moon, the sky, and what a camera is exposed for."""
