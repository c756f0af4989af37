"""`rigid train gleave`: a robot for a population of humans (Czempin & Gleave, 2022).

The paper, appendix 'Learning Robot Policies': one robot is co-optimised with three humans of
different seeds, then a robot is personalized to all three at once. Departure: the first of the
three is the synthetic human of a finished pair, who acts and learns no more; so this robot is
measured with the same human as those of the other recipes. The directory keeps the rest of the
population in `population/`, as `robot/` (the expert), `human-1/` and `human-2/`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from rigid.learning.cooptimisation import (
    CoOptimisationSettings,
    co_optimise,
    start_team,
)
from rigid.learning.learner import Learner
from rigid.learning.personalisation import (
    Partner,
    PersonalisationSettings,
    personalise,
    start_robot,
)
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.native import Agent, save_policy
from rigid.robots.storing import (
    Checkpoint,
    Report,
    already_made,
    one_of_pair,
    privileged_view,
    provenance,
    refuse_finished,
    store_robot,
    stream_of,
)
from rigid.tasks.protocol import Task

_POPULATION = "population"


@dataclass(frozen=True, kw_only=True)
class GleaveSettings:
    """Budget of both stages."""

    humans: int = 3
    """In the population, the synthetic human included (paper)."""
    population: CoOptimisationSettings = field(default_factory=CoOptimisationSettings)
    """As for a pair; each human gets a third of the episodes."""
    personalisation: PersonalisationSettings = field(default_factory=PersonalisationSettings)


def train_gleave(
    task: Task,
    settings: GleaveSettings,
    *,
    pair: Path,
    seed: int,
    out: Path,
    canonical_episodes: int,
    report_population: Report,
    report: Report,
) -> None:
    """Trains population and robot into `out`; an interrupted training in it goes on.

    Args:
        task: The task as the robot will meet it.
        settings: Budgets.
        pair: Directory of the pair whose human is the synthetic human.
        seed: Everything random comes from it.
        out: Directory of the robot.
        canonical_episodes: Recorded with the finished robot and the synthetic human.
        report_population: Told of the co-optimisation.
        report: Told of the personalisation.

    Raises:
        UserError: `pair` is no pair, or `out` holds a finished robot, something else or another
            training.
    """
    refuse_finished(out)
    privileged = privileged_view(task)
    synthetic = one_of_pair(pair, "human", task)
    made_by = provenance("gleave", settings, seed) | {"human": policy_hash(synthetic)}
    checkpoint = Checkpoint(out, task, made_by, beside=(_POPULATION,))
    population = _Population(out / _POPULATION, task, settings)
    population.train(synthetic, seed, made_by, report_population)
    expert = population.load("robot", "robot", privileged)
    humans = [synthetic, *(population.load(name, "human", task) for name in population.humans)]
    start = checkpoint.resume(start_robot(task, privileged, settings.personalisation, seed))
    report.begin(privileged, settings.personalisation.episodes, start[1])

    learner = personalise(
        task, report.watch(privileged), [Partner(human, expert) for human in humans],
        settings.personalisation, seed=seed, start=start, report=checkpoint.keeping(report),
    )  # fmt: skip
    robot = GaussianPolicy(learner.policy, memory=settings.personalisation.memory)
    store_robot(
        robot, synthetic, task,
        out=out, seed=seed, canonical_episodes=canonical_episodes, made_by=made_by,
    )  # fmt: skip
    checkpoint.drop()


class _Population:
    """A robot and its humans on disk, but for the synthetic human, who has a home."""

    def __init__(self, place: Path, task: Task, settings: GleaveSettings) -> None:
        self._place, self._task, self._settings = place, task, settings.population
        self.humans = [f"human-{number}" for number in range(1, settings.humans)]

    def train(
        self, synthetic: GaussianPolicy, seed: int, made_by: dict[str, object], report: Report
    ) -> None:
        """Co-optimises it; a finished one is left as it is."""
        privileged = privileged_view(self._task)
        last, world = (self.humans[-1], self._task) if self.humans else ("robot", privileged)
        if already_made(self._place / last, world, made_by):  # Who finds it may rely on all.
            return
        stream = stream_of(seed, _POPULATION)
        checkpoint = Checkpoint(self._place, self._task, dict(made_by))
        fresh = start_team(privileged, self._settings, stream, humans=len(self.humans))
        start = checkpoint.resume(fresh)
        report.begin(privileged, self._settings.episodes, start[1])

        team = co_optimise(
            report.watch(privileged), self._settings,
            seed=stream, start=start, grown_up=[synthetic],
            report=checkpoint.keeping(report),
        )  # fmt: skip
        self._store("robot", "robot", team.robot, privileged, made_by)
        for name, learner in zip(self.humans, team.humans, strict=True):
            self._store(name, "human", learner, self._task, made_by)
        checkpoint.drop()

    def load(self, name: str, agent: Agent, task: Task) -> GaussianPolicy:
        policy = load_policy(str(self._place / name), task=task, agent=agent)
        assert isinstance(policy, GaussianPolicy)  # As every policy of a team.
        return policy

    def _store(
        self, name: str, agent: Agent, learner: Learner, task: Task, made_by: dict[str, object]
    ) -> None:
        policy = GaussianPolicy(learner.policy)
        save_policy(
            policy, self._place / name, agent=agent, task=task.describe(), provenance=made_by
        )
