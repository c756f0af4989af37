"""Does the number predict? Headline numbers of robots against their failures with unseen humans.

`python -m benchmarks.prediction --help` says how to run it; `results/prediction/` holds what it
found.
"""
