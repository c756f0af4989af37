"""Canonical episodes: natural human behaviour on disk, and how it is recorded."""
