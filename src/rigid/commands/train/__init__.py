"""`rigid train`: making humans and robots."""

from __future__ import annotations

from rigid.commands.groups import Group
from rigid.commands.train.clone import CloneCommand
from rigid.commands.train.palm import PalmCommand
from rigid.commands.train.robots import CoOptimizeCommand, GleaveCommand, VanillaCommand
from rigid.commands.train.robust import RobustCommand

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
