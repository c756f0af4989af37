"""How the adversaries of a group are trained: each on its own, or many in one network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import jax

from rigid.learning.adversary import Adversary, Metrics, start_adversary, train_iteration
from rigid.learning.adversary_settings import AdversarySettings
from rigid.learning.conditioned import Sharing
from rigid.learning.group_play import Opponent
from rigid.learning.ranges import Range, ranges_of
from rigid.learning.shared import Family, family_iteration, members, start_family
from rigid.tasks.protocol import Task, World


@runtime_checkable
class Search(Protocol):
    """Training of one group; its state is a pytree that a checkpoint can hold."""

    @property
    def blocks(self) -> int:
        """Blocks of `episodes` episodes that are played in an iteration."""
        ...

    def start(self) -> Any:
        """The state before any step."""
        ...

    def iteration(self, state: Any) -> int:
        """Iterations done."""
        ...

    def iterate(self, world: World, state: Any) -> tuple[Any, list[Metrics]]:
        """The state after one more iteration, and what each λ saw."""
        ...

    def adversaries(self, state: Any) -> list[Adversary]:
        """One for each λ of the plan, in its order."""
        ...


def search_for(
    task: Task,
    opponent: Opponent,
    settings: AdversarySettings,
    lambdas: Sequence[float],
    entropy: int,
) -> Search:
    """The training that the settings ask for.

    Args:
        task: The task.
        opponent: What stays frozen.
        settings: Budget and machinery.
        lambdas: One for each adversary.
        entropy: Everything random comes from it.
    """
    sharing, chosen = settings.sharing, tuple(lambdas)
    if sharing is None:
        return Apart(task, opponent, settings, chosen, entropy)
    return Together(task, opponent, settings, chosen, entropy, sharing)


@dataclass(frozen=True)
class Apart:
    """A network for each λ (paper)."""

    task: Task
    opponent: Opponent
    settings: AdversarySettings
    lambdas: tuple[float, ...]
    entropy: int

    @property
    def blocks(self) -> int:
        """One for each λ."""
        return len(self.lambdas)

    def start(self) -> list[Adversary]:
        """Fresh adversaries."""
        keys = jax.random.split(jax.random.key(self.entropy), self.blocks)
        return [
            start_adversary(self.opponent, self.settings, lambda_, key)
            for lambda_, key in zip(self.lambdas, keys, strict=True)
        ]

    def iteration(self, state: list[Adversary]) -> int:
        """Iterations done."""
        return int(state[0].iteration)

    def iterate(
        self, world: World, state: list[Adversary]
    ) -> tuple[list[Adversary], list[Metrics]]:
        """One iteration of every adversary."""
        results = train_iteration(
            self.task, world, state, self.opponent, self.settings, self.entropy
        )
        return [after for after, _ in results], [metrics for _, metrics in results]

    def adversaries(self, state: list[Adversary]) -> list[Adversary]:
        """Themselves."""
        return state


@dataclass(frozen=True)
class Together:
    """One network for the λ from which on adversaries start canonical, one for those below."""

    task: Task
    opponent: Opponent
    settings: AdversarySettings
    lambdas: tuple[float, ...]
    entropy: int
    sharing: Sharing

    @property
    def ranges(self) -> list[Range]:
        """The λ of each network."""
        return ranges_of(self.lambdas, self.sharing)

    @property
    def blocks(self) -> int:
        """One for each slot, however many λ there are."""
        return sum(each.slots for each in self.ranges)

    def start(self) -> list[Family]:
        """Fresh families."""
        ranges = self.ranges
        keys = jax.random.split(jax.random.key(self.entropy), len(ranges))
        return [
            start_family(self.opponent, self.settings, each, key)
            for each, key in zip(ranges, keys, strict=True)
        ]

    def iteration(self, state: list[Family]) -> int:
        """Iterations done."""
        return int(state[0].iteration)

    def iterate(self, world: World, state: list[Family]) -> tuple[list[Family], list[Metrics]]:
        """One iteration of every family."""
        ranges = self.ranges
        families, seen = family_iteration(
            self.task, world, state, ranges, self.opponent, self.settings, self.entropy
        )
        return families, [seen[lambda_] for lambda_ in self.lambdas]

    def adversaries(self, state: list[Family]) -> list[Adversary]:
        """What the families are at each λ."""
        found = members(state, self.ranges, self.opponent, self.settings)
        return [found[lambda_] for lambda_ in self.lambdas]
