"""The long jobs, for the command line and for Blender's window alike: each has a process of its own.

`build`, `bake` and `render` are called in the process where people are; the functions `in_blender` of their
modules run in the worker process, where Blender is.
"""
