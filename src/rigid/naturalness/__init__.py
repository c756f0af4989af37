"""What "natural" means: discriminators that hold an adversary close, and the referee that judges.

One sign rule everywhere: a low score (towards -1) says canonical, a high score (towards +1) says
adversary.
"""
