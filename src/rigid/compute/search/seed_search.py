"""The search of one seed (paper, Alg. 1): which group comes next, given those that are done."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from rigid.compute.listening import Listener
from rigid.compute.run.clock import Clock
from rigid.compute.search.group import read_finished
from rigid.compute.search.group_plan import GroupInputs, GroupPlan, all_steps, begun_steps
from rigid.frontier.search import next_round
from rigid.presets import Preset


class Round(NamedTuple):
    """A group that is done."""

    plan: GroupPlan
    points: list[dict[str, Any]]
    """Its entries of `frontier.json`'s points."""


def next_plan(
    preset: Preset, lambdas: Sequence[float] | None, seed: int, rounds: Sequence[Round]
) -> GroupPlan | None:
    """The group that a seed trains next; None when its search is over.

    Args:
        preset: Rounds and range of λ.
        lambdas: Exactly the λ that the user gave, in one round; None for Algorithm 1.
        seed: Search seed.
        rounds: Those that are done, in their order.
    """
    if lambdas is not None:
        return None if rounds else GroupPlan(seed, 1, tuple(lambdas))
    chosen = next_round(
        [list(done.plan.lambdas) for done in rounds],
        [[point["naturalness_selection"] for point in done.points] for done in rounds],
        per_round=preset.per_round, lambda_min=preset.lambda_min, lambda_max=preset.lambda_max,
    )  # fmt: skip
    return None if chosen is None else GroupPlan(seed, len(rounds) + 1, tuple(chosen))


class SeedSearch:
    """The search of one seed of one measurement, as executors drive it.

    They run the plan of `next_plan` wherever they like, hand its points to `take`, and begin again
    until there is no plan left.
    """

    def __init__(
        self,
        inputs: GroupInputs,
        seed: int,
        lambdas: Sequence[float] | None,
        clock: Clock,
        listener: Listener,
    ) -> None:
        self.inputs, self.seed, self.clock, self.listener = inputs, seed, clock, listener
        self._lambdas = lambdas
        self._rounds: list[Round] = []

    @property
    def points(self) -> list[dict[str, Any]]:
        """Entries of `frontier.json`'s points so far, in the order of rounds and λ."""
        return [point for done in self._rounds for point in done.points]

    def next_plan(self) -> GroupPlan | None:
        """The group to be run next; None when the search is over."""
        return next_plan(self.inputs.preset, self._lambdas, self.seed, self._rounds)

    def take(self, plan: GroupPlan, points: list[dict[str, Any]]) -> None:
        """Notes that the group of `next_plan` is done."""
        self._rounds.append(Round(plan, points))

    def catch_up(self) -> int:
        """Takes the groups that earlier calls finished.

        Returns:
            Environment steps of those, and of the group that was begun.

        Raises:
            UserError: A file of them is damaged.
        """
        done = 0
        while (plan := self.next_plan()) is not None:
            points = read_finished(self.inputs.directory, plan)
            if points is None:
                return done + begun_steps(self.inputs, plan)
            self.take(plan, points)
            done += all_steps(self.inputs, plan)
        return done

    def take_stored(self, plan: GroupPlan) -> None:
        """Takes the group of `next_plan`, which is done, from the run directory.

        Raises:
            UserError: Its file is damaged.
        """
        points = read_finished(self.inputs.directory, plan)
        assert points is not None
        self.take(plan, points)

    def advance(self, env_steps: int) -> None:
        """Tells the listener of steps that are done, and notes the time."""
        self.listener.advance(env_steps)
        self.clock.tick()
