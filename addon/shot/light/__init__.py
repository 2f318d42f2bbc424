"""Light without Blender: sun and moon, sky, and exposure."""
