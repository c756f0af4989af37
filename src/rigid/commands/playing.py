"""`rigid record` and `rigid evaluate`: a robot and a human at play."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from rigid.commands.naming import PairOptions
from rigid.commands.parsing import at_least, parse_expected
from rigid.commands.places import file_played_again
from rigid.commands.ranging import RangeOptions
from rigid.commands.terminal.wrapping import tell

if TYPE_CHECKING:
    from rigid.policies.protocol import Policy
    from rigid.tasks.protocol import Task


@dataclass(frozen=True, kw_only=True)
class _PlayOptions(PairOptions):
    """Who plays what, and how often."""

    episodes: int = 100
    """How many episodes."""
    seed: int = 0
    """Everything random comes from it."""


@dataclass(frozen=True, kw_only=True)
class RecordCommand(_PlayOptions):
    """Record canonical episodes: what natural behaviour with this robot looks like.

    Example:
      rigid record --robot my/robot --episodes 40 --seed 0 --out canonical.npz
    """

    out: Path
    """File to write (.npz)."""

    def run(self) -> int:
        """Plays and stores the episodes."""
        from rigid.commands.terminal.progress import playing
        from rigid.data.episodes import save_episodes
        from rigid.data.recording import BATCH, record
        from rigid.files import writing_to
        from rigid.policies.loading import load_policy

        at_least("--episodes", self.episodes, 1)
        at_least("--seed", self.seed, 0)
        file_played_again(self.out)
        task, opening = self.open_task(), self.opening()
        robot = load_policy(self.robot, task=task, agent="robot", opening=opening)
        human = load_policy(self.human, task=task, agent="human", opening=opening)
        _warn_of_a_stranger(self, human, task)
        made_by = {"robot": self.robot, "human": self.human}
        with playing(task, self.episodes, BATCH) as seen:
            found = record(
                seen, robot, human, episodes=self.episodes, seed=self.seed, provenance=made_by
            )
        with writing_to(self.out):
            save_episodes(self.out, found)
        success = float(found.success.mean())
        shown = "unknown" if math.isnan(success) else f"{success:.3f}"
        print(f"{len(found)} episodes, success {shown}: {self.out}")
        return 0


@dataclass(frozen=True, kw_only=True)
class EvaluateCommand(RangeOptions, _PlayOptions):
    """Play a robot with a human and print return, success, outcomes and forces.

    Examples:
      rigid evaluate --robot builtin:vanilla --human builtin:passive --episodes 500
      rigid evaluate --robot arm.onnx --expect-return 431±15
    """

    expect_return: Annotated[str | None, tyro.conf.arg(metavar="MEAN±TOLERANCE")] = None
    """Exit 1 unless the mean return lies within the tolerance (± or +-)."""
    json: bool = False
    """Print the result as JSON."""

    def run(self) -> int:
        """Plays and prints."""
        from rigid.commands.terminal.progress import playing
        from rigid.compute.evaluation import BLOCK, evaluate
        from rigid.compute.return_range import find_return_range, range_in_force, spoken_range
        from rigid.policies.loading import load_policy
        from rigid.tasks.views.ranged import with_range

        expected = parse_expected(self.expect_return)
        at_least("--episodes", self.episodes, 1)
        at_least("--seed", self.seed, 0)
        task, opening = self.open_task(), self.opening()
        chosen = find_return_range(self.return_range, task)
        ranged = task if chosen is None else with_range(task, chosen.ends)
        robot = load_policy(self.robot, task=task, agent="robot", opening=opening)
        human = load_policy(self.human, task=task, agent="human", opening=opening)
        _warn_of_a_stranger(self, human, task)
        with playing(ranged, self.episodes, min(BLOCK, self.episodes)) as seen:
            found = evaluate(seen, robot, human, episodes=self.episodes, seed=self.seed)
        if found["adversarialness"] is not None:
            found |= range_in_force(task, chosen).describe()
        if expected is not None:
            found["expected_return"] = _verdict(found, *expected)
        if self.json:
            print(json.dumps(found))
        else:
            spoken = spoken_range(found) if "return_range" in found else None
            for name, value in found.items():
                if not name.startswith(("return_range", "range_")):
                    unit = _UNITS.get(name, "") if value is not None else ""
                    print(f"{name:22} {_text(value)}{unit}")
            if spoken is not None:
                print(f"adversarialness is {spoken}")
        if expected is None or found["expected_return"]["ok"]:
            return 0
        tell(f"rigid: {_refusal(found)}")
        return 1


_UNITS = {"peak_force": " N", "impulse": " N s"}


def _warn_of_a_stranger(options: PairOptions, human: Policy, task: Task) -> None:
    from rigid.compute.subject import stranger

    warning = stranger(options.robot, options.human, human, task)
    if warning is not None:
        tell(warning)


def _verdict(found: dict[str, Any], mean: float, tolerance: float) -> dict[str, Any]:
    """Whether the mean return is the expected one, and how sure it is itself."""
    sound = found["episodes"] - found["faults"]
    error = found["return_std"] / math.sqrt(sound - 1) if sound > 1 else None
    ok = found["return"] is not None and abs(found["return"] - mean) <= tolerance
    return {"mean": mean, "tolerance": tolerance, "standard_error": error, "ok": ok}


def _refusal(found: dict[str, Any]) -> str:
    verdict = found["expected_return"]
    wanted = f"{verdict['mean']:g} ± {verdict['tolerance']:g}"
    if found["return"] is None:
        return f"the mean return is unknown, not {wanted}: every episode ran away"
    error = verdict["standard_error"]
    return (
        f"the mean return {found['return']:.3f} (standard error {_text(error)}, "
        f"{found['episodes']} episodes) lies outside of {wanted}: another robot, task, human or "
        "normaliser than you expect?"
    )


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, dict):
        return ", ".join(f"{name} {_text(share)}" for name, share in value.items())
    if value is None:
        return "unknown"
    return f"{value:.3f}" if isinstance(value, float) else str(value)
