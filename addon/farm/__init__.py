"""Farm jobs: a film as tasks of Slurm, PBS, HTCondor, Open Job Description and other schedulers.

A job has three stages: bake (smoke flows), render (cameras x chunks of frames) and assemble. A task is one
command that can safely run more than once. Each attempt writes pictures and one log of entries under a unique
name, so that no two tasks write to the same file. `assemble` enters all pictures in the store.
"""
