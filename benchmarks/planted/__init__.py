"""Does the search find what is there? Robots with a weakness that was planted, and without one.

The task is a hand-over, small enough that everything about it is known: how people move, which
motions make a robot give up, how often they occur, how natural they are.
"""
