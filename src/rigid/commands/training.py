"""`rigid train`: making humans and robots."""

from __future__ import annotations

from rigid.commands.groups import Group
from rigid.commands.training_clone import CloneCommand
from rigid.commands.training_palm import PalmCommand
from rigid.commands.training_robots import CoOptimizeCommand, GleaveCommand, VanillaCommand
from rigid.commands.training_robust import RobustCommand

TRAIN = Group(
    "Make humans and robots.",
    {
        "co-optimize": CoOptimizeCommand,
        "vanilla": VanillaCommand,
        "gleave": GleaveCommand,
        "palm": PalmCommand,
        "clone": CloneCommand,
        "robust-gt": RobustCommand,
    },
)
