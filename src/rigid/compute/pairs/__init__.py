"""Pairs of episodes for people to judge: `rigid pairs`."""
