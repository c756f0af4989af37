"""Studies of RIGID itself: does the search find what is there, and does the number predict?

Each study is a folder that runs as a module. It keeps every finished part, so that it can be
interrupted, and writes its table, its figure and its account into `results/`.
"""
