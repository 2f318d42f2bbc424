"""Light without Blender: sky and exposure; the sun and the moon are in `run.sun`."""
