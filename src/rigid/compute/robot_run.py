"""The measurement of one robot: what was ordered, how it begins, and what it writes at its end."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from rigid.compute.budget import COMPILING_SECONDS, working_speed
from rigid.compute.listening import Listener, Silence, Workload
from rigid.compute.preparation import Prepared, lambdas_of, passive_reference, prepare, seeds_of
from rigid.compute.run.clock import Clock
from rigid.compute.run.directory import OpenRun, alone_in, check_place, check_same, open_run
from rigid.compute.run.identity import settings_identity
from rigid.compute.run.provenance import command_line
from rigid.compute.search.discriminators import write_discriminators
from rigid.compute.search.group import json_lambda
from rigid.compute.search.group_plan import GroupInputs, GroupPlan, all_steps, training_steps
from rigid.compute.search.seed_search import SeedSearch
from rigid.compute.subject import Subject, load_robot
from rigid.files import json_text, write_atomically
from rigid.frontier.result import load_frontier, measured_points
from rigid.frontier.statistics import summarize_seeds
from rigid.learning.adversary_settings import AdversarySettings
from rigid.policies.loading import policy_hash
from rigid.presets import Preset


@dataclass(frozen=True, kw_only=True)
class Order:
    """A robot that is to be measured."""

    subject: Subject
    preset: Preset
    settings: AdversarySettings
    """How adversaries are trained; of the preset's budget."""
    out: Path
    """Run directory."""
    seeds: Sequence[int] | None = None
    """Search seeds instead of the preset's; those that `out` already has stay."""
    lambdas: Sequence[float] | None = None
    """Exactly these λ, without refinement; 0 and inf are allowed."""
    listener: Listener = field(default_factory=Silence)

    @property
    def searches(self) -> int:
        """Seeds that are asked for."""
        return len(seeds_of(self.preset, self.seeds))

    @property
    def env_steps(self) -> int:
        """About how many training steps they take."""
        return self._budget.env_steps(self.subject.task.horizon)

    @property
    def all_steps(self) -> int:
        """About how many steps they take, of training and scoring."""
        adversaries, horizon = self._budget.adversaries, self.subject.task.horizon
        return self.env_steps + self.preset.scoring_steps(adversaries, horizon)

    @property
    def _budget(self) -> Preset:
        budget = replace(self.preset, seeds=seeds_of(self.preset, self.seeds))
        if self.lambdas is None:
            return budget
        return replace(budget, per_round=(len(self.lambdas),))

    def check(self) -> None:
        """Refuses what can never be measured, before any work; canonical play may tell more later.

        Raises:
            UserError: Seeds or λ that make no search, a robot that does not load, or a place that
                cannot become this run.
        """
        seeds_of(self.preset, self.seeds)
        known = settings_identity(self.preset, self.settings) | {"lambdas": self.exactly}
        check_place(self.out)
        robot = load_robot(self.subject)
        check_same(self.out, known | {"robot": policy_hash(robot)})

    @property
    def exactly(self) -> list[float | str] | None:
        """The λ as JSON has them; None where the search chooses them."""
        chosen = lambdas_of(self.lambdas)
        return None if chosen is None else [json_lambda(value) for value in chosen]


class RobotRun:
    """A measurement that was begun, or gone on with, in its run directory."""

    def __init__(self, order: Order, prepared: Prepared, opened: OpenRun, clock: Clock) -> None:
        self._order, self._prepared, self._clock = order, prepared, clock
        self._file = opened.directory.frontier
        self._inputs = GroupInputs(
            prepared.task, prepared.opponent, prepared.ruler, order.preset, order.settings,
            opened.directory.path,
        )  # fmt: skip
        lambdas = lambdas_of(order.lambdas)
        self.searches = tuple(
            SeedSearch(self._inputs, seed, lambdas, clock, order.listener) for seed in opened.seeds
        )
        """One for each seed, in ascending order."""
        self._open = set(opened.seeds)
        self._done = sum(search.catch_up() for search in self.searches)

    def announce(self, workers: int) -> None:
        """Tells the listener how much there is to do, and about how long it takes."""
        order, seeds = self._order, len(self.searches)
        of_a_seed, of_all = self._work_of_a_seed()
        at_a_time = min(workers, seeds)
        order.listener.begin(
            Workload(
                training_steps=seeds * of_a_seed,
                steps=seeds * of_all,
                done=self._done,
                steps_per_second=working_speed(self._prepared.steps_per_second, at_a_time),
                starting=COMPILING_SECONDS,
            )
        )

    def close(self, search: SeedSearch) -> bool:
        """Sums up a seed whose search is over, and the measurement when it was the last one.

        Returns:
            Whether it was: then `frontier.json` is there.
        """
        with self._clock.working():
            write_discriminators(self._inputs, search.seed, [p["id"] for p in search.points])
            self._open.discard(search.seed)
            if self._open:
                return False
            write_atomically(self._file, json_text(self._summed_up(), indent=1).encode())
        return True

    def _work_of_a_seed(self) -> tuple[int, int]:
        """Environment steps of training, and of training and scoring."""
        lambdas, horizon = lambdas_of(self._order.lambdas), self._inputs.task.horizon
        if lambdas is not None:
            plan = GroupPlan(0, 1, lambdas)
            return training_steps(self._inputs, plan), all_steps(self._inputs, plan)
        preset = replace(self._order.preset, seeds=(0,))
        training = preset.env_steps(horizon)
        return training, training + preset.scoring_steps(preset.adversaries, horizon)

    def _summed_up(self) -> dict[str, Any]:
        """What `frontier.json` holds."""
        subject, preset, prepared = self._order.subject, self._order.preset, self._prepared
        points = [point for search in self.searches for point in search.points]
        headline = _headline(points, prepared, [search.seed for search in self.searches])
        passive = passive_reference(prepared.task, prepared, preset)
        self._clock.keep()
        return {
            "schema": 1,
            "task": subject.task.name,
            "robot": subject.robot,
            "human": subject.human,
            "preset": preset.name,
            "search_measure": prepared.identity["measure"],
            "features": prepared.identity["features"],
            "canonical": prepared.canonical,
            **headline,
            **prepared.return_range.describe(),
            "passive": passive,
            "stamp": preset.stamp,
            **_costs(points, prepared, preset, subject.task.horizon),
            **self._clock.read(),
        }


def begin(order: Order, locks: ExitStack) -> RobotRun | None:
    """Prepares a measurement and opens its run directory; None when it is already complete.

    Args:
        order: What to measure.
        locks: Takes the lock of the run directory, which others are kept out of until it closes.

    Raises:
        UserError: Bad input, or a directory that holds something else; nothing was overwritten.
    """
    clock, listener = Clock(), order.listener
    with clock.working():
        order.check()
        seeds = seeds_of(order.preset, order.seeds)
        prepared = prepare(order.subject, order.preset, order.settings, listener.say)
        locks.enter_context(alone_in(order.out))
        identity = {**prepared.identity, "lambdas": order.exactly}
        opened = open_run(order.out, identity, seeds, command_line())
        for warning in opened.warnings:
            listener.say(warning)
        if opened.directory.frontier.exists():
            load_frontier(order.out)  # A damaged one is not called complete.
            listener.say(f"{order.out} is already complete; nothing to do")
            return None
        clock.go_on(opened.directory.path / "groups" / "spent.json")
        return RobotRun(order, prepared, opened, clock)


def _headline(
    points: list[dict[str, Any]], prepared: Prepared, seeds: Sequence[int]
) -> dict[str, Any]:
    anchors = dict.fromkeys(seeds, prepared.canonical["adversarialness"])
    summary = summarize_seeds(measured_points(points), anchors, rng=np.random.default_rng(0))
    marked = [
        {**point, "on_frontier": bool(mark)}
        for point, mark in zip(points, summary.on_frontier, strict=True)
    ]
    return {"points": marked, **summary.headline()}


def _costs(
    points: Sequence[dict[str, Any]], prepared: Prepared, preset: Preset, horizon: int
) -> dict[str, int]:
    """Environment steps of training, and of everything that only scores."""
    scoring = preset.scoring_steps(len(points), horizon) + preset.judging_episodes * horizon
    return {
        "env_steps": sum(point["env_steps"] for point in points),
        "env_steps_scoring": scoring + prepared.env_steps,
    }
