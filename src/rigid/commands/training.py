"""`rigid train`: making humans and robots."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import Annotated

import tyro

from rigid.commands.training_clone import CloneCommand
from rigid.commands.training_palm import PalmCommand
from rigid.commands.training_robots import CoOptimizeCommand, GleaveCommand, VanillaCommand
from rigid.commands.training_robust import RobustCommand


@dataclass(frozen=True)
class TrainCommand:
    """Make humans and robots."""

    recipe: (
        Annotated[
            CoOptimizeCommand,
            tyro.conf.subcommand("co-optimize", description=inspect.getdoc(CoOptimizeCommand)),
        ]
        | Annotated[
            VanillaCommand,
            tyro.conf.subcommand("vanilla", description=inspect.getdoc(VanillaCommand)),
        ]
        | Annotated[
            GleaveCommand,
            tyro.conf.subcommand("gleave", description=inspect.getdoc(GleaveCommand)),
        ]
        | Annotated[
            PalmCommand,
            tyro.conf.subcommand("palm", description=inspect.getdoc(PalmCommand)),
        ]
        | Annotated[
            CloneCommand,
            tyro.conf.subcommand("clone", description=inspect.getdoc(CloneCommand)),
        ]
        | Annotated[
            RobustCommand,
            tyro.conf.subcommand("robust-gt", description=inspect.getdoc(RobustCommand)),
        ]
    )
    """What to train."""

    def run(self) -> int:
        """Runs the chosen recipe."""
        return self.recipe.run()
