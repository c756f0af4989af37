"""The search of one seed: groups of adversaries, from training to scored points."""
