"""Bodies from which assistive tasks are assembled: robot arm, seated human, furniture, tools.

Each module adds one entity to a `mujoco.MjSpec` and returns the names that a task needs. Lengths
are in [m], masses in [kg], angles in [rad] unless a name says `_deg`. World frame: z up, the person
faces -y, their right is -x.
"""
