"""What a study keeps: one SQLite file, written by one process and read by many.

Pseudonymous at most, since motion can identify people. A participant who withdraws is deleted.
"""

from rigid.study.store.shapes import (
    ConflictError,
    Export,
    GoneError,
    Invitation,
    ParticipantProgress,
    Progress,
    Standing,
)
from rigid.study.store.store import Store

__all__ = [
    "ConflictError",
    "Export",
    "GoneError",
    "Invitation",
    "ParticipantProgress",
    "Progress",
    "Standing",
    "Store",
]
