"""The assistive tasks, and what the tests of their common rules have to know of each."""

from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any

from rigid.tasks import bed_bathing_v0, feeding_v0, itch_scratching_v0
from rigid.tasks.bed_bathing.starts import STARTS as BED_BATHING_STARTS
from rigid.tasks.feeding.food import Piece
from rigid.tasks.feeding.starts import STARTS as FEEDING_STARTS
from rigid.tasks.itch_scratching.reward import SUCCESS_CONTACTS
from rigid.tasks.itch_scratching.starts import STARTS as ITCH_SCRATCHING_STARTS
from rigid.tasks.physics.starts import Starts
from rigid.tasks.views.gymnasium import BED_BATHING, FEEDING, ITCH_SCRATCHING


@dataclass(frozen=True)
class Case:
    """One task."""

    name: str
    """In the registry."""
    gymnasium_id: str
    pettingzoo: ModuleType
    starts: Starts
    help_all: Callable[[Any], None]
    """Makes every episode of a world one in which the person was helped."""
    poses: tuple[str, ...]
    """Bodies that the human moves."""
    weight: str
    """Of what the robot is there for."""
    wrong: tuple[dict[str, Any], str]
    """A value that a parameter of its own cannot take, and what is said of it."""

    @property
    def folder(self) -> str:
        """Of its code and of its fixture."""
        return self.name.replace("-", "_")


def _scratch(world: Any) -> None:
    world.counted[:] = SUCCESS_CONTACTS


def _feed(world: Any) -> None:
    world.food[:] = Piece.EATEN


def _wipe(world: Any) -> None:
    world.wiped[:] = True


_ARM = ("right_shoulder", "right_upper_arm", "right_forearm", "right_hand")
CASES = (
    Case(
        "itch-scratching", ITCH_SCRATCHING, itch_scratching_v0, ITCH_SCRATCHING_STARTS, _scratch,
        _ARM, "scratch", ({"itch_spread": 1.5}, "itch_spread is 1.5, but must be in [0, 1]"),
    ),
    Case(
        "feeding", FEEDING, feeding_v0, FEEDING_STARTS, _feed,
        ("neck", "head"), "food",
        ({"head_start_deg": 45}, "head_start_deg is 45, but must be in [0, 30]"),
    ),
    Case(
        "bed-bathing", BED_BATHING, bed_bathing_v0, BED_BATHING_STARTS, _wipe,
        _ARM, "wipe",
        ({"arm_start_deg": 45}, "arm_start_deg is 45, but must be in [0, 10]"),
    ),
)  # fmt: skip
