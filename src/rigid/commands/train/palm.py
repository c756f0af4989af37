"""`rigid train palm`: a robot that embeds how the human moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import tyro

from rigid.commands.parsing import at_least
from rigid.commands.terminal.stopping import goes_on
from rigid.commands.train.progress import show_stages
from rigid.commands.train.robots import RobotOptions


@dataclass(frozen=True, kw_only=True)
class PalmCommand(RobotOptions):
    """Train a robot that embeds how the human moves, with diverse humans (PALM; He et al.).

    A second pair is co-optimised with the itch anywhere along the arm, then a robot is trained with
    the humans of both pairs, and to predict how they move.

    Example:
      rigid train palm --pair runs/pair-1 --seed 1 --out runs/palm-1
    """

    diverse_iterations: Annotated[int | None, tyro.conf.arg(metavar="INT")] = None
    """Iterations of 19,200 steps of the diverse pair; by default 160."""

    def run(self) -> int:
        """Trains the diverse pair and the robot."""
        from dataclasses import replace

        from rigid.robots.palm import PalmRecipe, train_palm

        self.check()
        recipe = PalmRecipe()
        diverse, palm = recipe.diverse, recipe.palm
        if self.iterations is not None:
            training = replace(palm.personalisation, iterations=self.iterations)
            palm = replace(palm, personalisation=training)
        if self.diverse_iterations is not None:
            at_least("--diverse-iterations", self.diverse_iterations, 1)
            diverse = replace(diverse, iterations=self.diverse_iterations)
        with (
            goes_on(self.out),
            show_stages(
                ("diverse pair", diverse.iterations),
                ("palm", palm.personalisation.iterations),
            ) as (report_diverse, report),
        ):
            error = train_palm(
                self.open_task(), replace(recipe, diverse=diverse, palm=palm),
                pair=self.pair, seed=self.seed, out=self.out, canonical_episodes=self.episodes,
                report_diverse=report_diverse, report=report,
            )  # fmt: skip
        print(
            f"robot: {self.out}\nerror of its prediction of motion: {error.palm:.3g}, of constant "
            f"velocity: {error.constant_velocity:.3g} (fresh episodes, root mean square of a "
            "coordinate)"
        )
        return 0
