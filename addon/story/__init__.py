"""Stories: one film that tells a fire, from a storyboard that is chosen from the run.

A storyboard is a list of shots (`storyboard`), which `choose` selects and `story_file` reads and writes. The
timeline gives each shot its frames, and `captions` their captions.
"""
