"""Farm jobs: a film as tasks of Slurm, PBS, HTCondor, Open Job Description and other engines.

A job has three stages: bake (flows of smoke), render (cameras x chunks of frames) and assemble. Each task is
one command that may run twice. A task writes its own pictures and one file of entries under a name of its
own, and nothing that another task writes. `assemble` enters all pictures in the store.
"""
