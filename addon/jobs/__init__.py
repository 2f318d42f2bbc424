"""Jobs: build, bake, render and convert, each in a separate worker process.

`build`, `bake` and `render` are called in the user's process. The functions `in_blender` of their modules run
in the worker process, which has Blender.
"""
