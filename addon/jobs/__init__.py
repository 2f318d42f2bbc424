"""Long jobs of the command line and of Blender's window; each runs in a worker process of its own.

`build`, `bake` and `render` are called in the user's process. The functions `in_blender` of their modules run
in the worker process, which has Blender.
"""
