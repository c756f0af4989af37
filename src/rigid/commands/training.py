"""`rigid train`: making humans and robots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from rigid.commands.groups import member
from rigid.commands.training_clone import CloneCommand
from rigid.commands.training_palm import PalmCommand
from rigid.commands.training_robots import CoOptimizeCommand, GleaveCommand, VanillaCommand
from rigid.commands.training_robust import RobustCommand


@dataclass(frozen=True)
class TrainCommand:
    """Make humans and robots."""

    recipe: (
        Annotated[CoOptimizeCommand, member("co-optimize", CoOptimizeCommand)]
        | Annotated[VanillaCommand, member("vanilla", VanillaCommand)]
        | Annotated[GleaveCommand, member("gleave", GleaveCommand)]
        | Annotated[PalmCommand, member("palm", PalmCommand)]
        | Annotated[CloneCommand, member("clone", CloneCommand)]
        | Annotated[RobustCommand, member("robust-gt", RobustCommand)]
    )
    """What to train."""

    def run(self) -> int:
        """Runs the chosen recipe."""
        return self.recipe.run()
