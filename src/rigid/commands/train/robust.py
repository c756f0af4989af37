"""`rigid train robust-gt`: a robot that goes on learning with the humans that broke it."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.naming import MeasuredTaskOptions
from rigid.commands.parsing import at_least
from rigid.commands.terminal.stopping import goes_on
from rigid.commands.train.progress import show_progress
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.compute.listening import Listener
    from rigid.robots.robust_gt import RobustSettings


@dataclass(frozen=True, kw_only=True)
class RobustCommand(MeasuredTaskOptions):
    """Train a measured robot on with the natural adversaries that were found (Robust GT).

    The most harmful adversaries of a finished run take 15 % of the episodes. With `--rounds 2` the
    new robot is searched, and learns on from what was found: does robustness grow, or does the hole
    only move? Measure the result with search seeds that no training saw; the last line names some.

    Examples:
      rigid train robust-gt --from runs/vanilla --out runs/robust
      rigid train robust-gt --from runs/vanilla --rounds 2 --out runs/robust-2
    """

    run_: Annotated[Path, tyro.conf.arg(name="from", metavar="DIR")]
    """Run directory of `rigid frontier`, finished."""
    out: Path
    """Directory for the robot; an interrupted training in it goes on."""
    rounds: int = 1
    """Trainings in all, with a search of the newest robot between them."""
    preset: Annotated[str | None, tyro.conf.arg(metavar="NAME")] = None
    """Of the searches between rounds; by default that of the run."""
    robot: Annotated[str | None, tyro.conf.arg(metavar="ROBOT")] = None
    """Where the measured robot is now; by default where it was."""
    naturalness: tuple[float, float] = (0.2, 0.8)
    """Range of the adversaries that are taken."""
    adversaries: int = 6
    """At most, of each run."""
    share: float = 0.15
    """Of the episodes, for all adversaries together."""
    from_scratch: bool = False
    """Start from a random robot instead of the measured one."""
    seed: int = 0
    """Everything random comes from it."""
    iterations: Annotated[int | None, tyro.conf.arg(metavar="INT")] = None
    """Iterations of 19,200 steps of each training; by default 60."""
    episodes: int = 40
    """Canonical episodes to record with each robot."""

    def run(self) -> int:
        """Trains, searches between rounds, and says how to judge the result."""
        from rigid.frontier.result import load_frontier
        from rigid.presets import find_preset
        from rigid.robots.rounds import seeds_not_used, train_in_rounds

        self._check()
        settings = self._settings()
        frontier = load_frontier(self.run_)
        preset = find_preset(self.preset or str(frontier.data["preset"]))
        length = settings.training.iterations
        with goes_on(self.out):
            runs = train_in_rounds(
                self.run_, settings, preset, rounds=self.rounds, seed=self.seed, out=self.out,
                canonical_episodes=self.episodes, task=self.named_task(), robot=self.robot,
                training=lambda name: show_progress(
                    name if self.rounds > 1 else "robust-gt", length
                ),
                searching=_searching,
            )  # fmt: skip
        fresh = seeds_not_used(runs, len(preset.seeds))
        named = {
            name: getattr(self, name) for name in ("task", "human_agent", "robot_agent", "horizon")
        }
        options = named | {
            "robot": self.out, "human": frontier.data["human"], "preset": preset.name,
            **_as_searched(self.run_),
            "seeds": f"{fresh[0]}..{fresh[-1]}", "out": f"{self.out}-frontier",
        }  # fmt: skip
        print(
            f"robot: {self.out}\njudge it by a search that no training saw:\n"
            f"rigid frontier {_typed(options)}"
        )
        return 0

    def _check(self) -> None:
        at_least("--rounds", self.rounds, 1)
        at_least("--seed", self.seed, 0)
        at_least("--episodes", self.episodes, 1)
        at_least("--adversaries", self.adversaries, 1)
        if self.iterations is not None:
            at_least("--iterations", self.iterations, 1)
        low, high = self.naturalness
        if not 0 <= low < high <= 1:
            raise UserError(f"--naturalness {low:g} {high:g} must be LOW HIGH within [0, 1]")
        if not 0 < self.share < 1:
            raise UserError(f"--share is {self.share:g}, but must lie between 0 and 1")

    def _settings(self) -> RobustSettings:
        from dataclasses import replace

        from rigid.robots.robust_gt import RobustSettings

        settings = RobustSettings(
            naturalness=self.naturalness, adversaries=self.adversaries, share=self.share,
            from_scratch=self.from_scratch,
        )  # fmt: skip
        if self.iterations is None:
            return settings
        return replace(settings, training=replace(settings.training, iterations=self.iterations))


def _as_searched(run: Path) -> dict[str, object]:
    """The options of `rigid frontier` that search as a finished run did, its budget apart."""
    from rigid.compute.return_range import stored_range
    from rigid.frontier.result import load_frontier
    from rigid.naturalness.choice import DEFAULT_MEASURE
    from rigid.naturalness.features import DEFAULT
    from rigid.robots.rounds import Manner

    manner, given = Manner.of(run), stored_range(load_frontier(run).data)
    usual = {"features": DEFAULT, "search_measure": DEFAULT_MEASURE, "memory": 1}
    searched = {
        "features": manner.features, "search_measure": manner.search_measure,
        "memory": manner.memory, "lambdas": _listed(manner.lambdas),
        "return_range": None if given.source == "task" else _listed(given.ends),
    }  # fmt: skip
    return {name: value for name, value in searched.items() if value != usual.get(name)}


def _listed(numbers: Iterable[float] | None) -> str | None:
    return None if numbers is None else ",".join(str(number) for number in numbers)


def _typed(options: Mapping[str, object]) -> str:
    """Options as a shell takes them; those that are None are left out."""
    words = (
        (f"--{name.replace('_', '-')}", shlex.quote(str(value)))
        for name, value in options.items()
        if value is not None
    )
    # A value that begins with a dash would be taken for an option.
    return " ".join(f"{name}{'=' if value[0] == '-' else ' '}{value}" for name, value in words)


@contextmanager
def _searching(name: str) -> Iterator[Listener]:
    from rigid.commands.terminal.progress import TerminalListener

    with TerminalListener(f"{name}: searching") as listener:
        yield listener
