"""The two-player world: protocol, bodies, tasks and their views in other libraries."""
