"""Stories: one film that tells a fire, from a storyboard that is chosen from the run.

A storyboard is a list of shots (`storyboard`), which `choose` and `evidence` select, and `story_file` reads
and writes. The timeline gives each shot its frames, and `captions` their captions. Each shot becomes maps of
the growth (`growth_map`), or a scene file (`scenes`) that the render job renders; `wipe` joins pictures of
two shots. A project of Blender's Video Sequencer has a strip for each shot and text (`sequencer`), and `film`
renders the film from it, and writes its cut.
"""
