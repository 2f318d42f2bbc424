"""Growing runs: output of a model that is still running, read time by time.

`firetwin watch` (`watch`) keeps a folder: ``times.json`` lists the accepted times, ``status.json`` and
``index.html`` have the state, and ``generation_1/000012`` is a run of the first 12 times. A model that starts
again begins ``generation_2``. The folder itself can be opened as a run: its newest revision is read.
"""
