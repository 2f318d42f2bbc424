"""Jobs for render farms: an engine that exists schedules them, one file per engine in `engines`.

A job has three stages: bake (flows of smoke), render (cameras x chunks of frames) and assemble. Each task is
one command that may run twice. A task writes its own pictures and one file of entries under a name of its
own, and nothing that another task writes. `assemble` enters all pictures in the store.
"""
