"""Live scene: the shot in a form that a 3D view and a headset draw fast, in the same timeline."""
