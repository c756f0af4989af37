"""`rigid doctor`: is everything there that a frontier on this task needs?"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.naming import PairOptions
from rigid.commands.parsing import parse_budget
from rigid.commands.ranging import RangeOptions
from rigid.commands.terminal.stopping import goes_on
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.compute.subject import Subject
    from rigid.doctor.verdict import Verdict
    from rigid.presets import Preset
    from rigid.tasks.protocol import Task

_shown_as = tyro.conf.arg
_HUMAN = tyro.conf.arg(metavar="HUMAN", help_behavior_hint="(default: builtin:synthetic-human)")
_TRAINED = tyro.conf.arg(metavar="ROBOT", help_behavior_hint="(default: a short pair is trained)")


@dataclass(frozen=True, kw_only=True)
class DoctorCommand(RangeOptions, PairOptions):
    """Examine a new task step by step, as the paper does: exit 1 when a verdict fails.

    Do the key features vary? Can the human influence the reward, and an adversary learn to? Are
    there enough canonical data? Does λ = 0 break the task while λ = ∞ stays canonical? Is there a
    gradual curve between? Takes about three minutes on itch scratching with two cores.

    Examples:
      rigid doctor --task my-task --robot my/robot --human my/human --out runs/doctor
      rigid doctor --task pettingzoo:my.module:env --human-agent a --robot-agent b --out runs/doctor
      rigid doctor --task my-task --robot R --human H --features arm_angle,arm_speed --out runs/d2
    """

    out: Path
    """Directory of doctor.html, doctor.json and what was trained; a stopped examination goes on."""
    robot: Annotated[str, _TRAINED] = ""
    """As for rigid frontier; without one a short pair is trained in DIR first."""
    human: Annotated[str, _HUMAN] = ""
    """The synthetic human that --robot was trained for."""
    canonical: Annotated[str | None, _shown_as(metavar="FILE")] = None
    """File of canonical episodes; by default the robot's own, or a fresh recording."""
    features: Annotated[str, _shown_as(metavar="NAMES")] = "default"
    """What naturalness sees: default, observation, observation+action, or the task's by name."""
    budget: Annotated[str | None, _shown_as(metavar="TIME")] = None
    """Fit the search to a time of this machine: 90s, 3m; what else is examined takes about 1m."""
    json: bool = False
    """Print doctor.json on standard output."""

    def run(self) -> int:
        """Examines, writes the page and prints a table."""
        seconds = parse_budget(self.budget)
        if self.human and not self.robot:
            raise UserError("--human is the human of a --robot: name both, or neither")
        if self.canonical and not self.robot:
            raise UserError("--canonical needs the --robot that it was recorded with")
        from rigid.commands.terminal.progress import TerminalListener
        from rigid.compute.doctor.domain import check_doctor_place, doctor_preset, examine
        from rigid.report.doctor_page import write_doctor_page

        task = self.open_task()
        check_doctor_place(self.out)
        with goes_on(self.out), TerminalListener(f"{self.task} · doctor") as listener:
            subject = self._subject(task)
            preset = doctor_preset(task)
            if seconds is not None:
                preset = self._fitted(preset, task, seconds)
            listener.say(f"examining {self.task} with {subject.robot}")
            found = examine(subject, preset, out=self.out, listener=listener)
            page = write_doctor_page(found, self.out)
        print(json.dumps(found.describe()) if self.json else f"{table(found.verdicts)}\n\n{page}")
        return 1 if found.failed else 0

    def _subject(self, task: Task) -> Subject:
        """Who is examined; a pair is trained where nobody is named."""
        from rigid.compute.return_range import find_return_range
        from rigid.compute.subject import Subject

        robot, human = self.robot, self.human or "builtin:synthetic-human"
        if not robot:
            from rigid.commands.train.progress import show_progress
            from rigid.robots.short_pair import train_short_pair

            robot, human = train_short_pair(task, self.out, showing=show_progress)
        return Subject(
            task, robot, human, self.canonical, self.features, self.opening(),
            find_return_range(self.return_range, task),
        )  # fmt: skip

    def _fitted(self, preset: Preset, task: Task, seconds: float) -> Preset:
        """The preset that `--budget` stands for; a search that was begun keeps its own."""
        from rigid.compute.budget import fit_here, stored_preset
        from rigid.compute.doctor.domain import SEARCH
        from rigid.compute.doctor.steps import LAMBDAS

        stored = stored_preset(self.out / SEARCH, preset)
        if stored is not None:
            return stored
        fitted = fit_here(replace(preset, per_round=(len(LAMBDAS),)), seconds, task)
        return replace(fitted, per_round=preset.per_round)


_WORDS = {"pass": "pass", "warn": "warn", "fail": "FAIL", "skip": "skip"}


def table(verdicts: Sequence[Verdict]) -> str:
    """Every step with its verdict, and what to do."""
    lines = [""]
    for verdict in verdicts:
        lines.append(f"  {_WORDS[verdict.status]:5} {verdict.title}")
        lines += [f"        {text}" for text in (verdict.says, verdict.advice) if text]
    failed = [verdict.title for verdict in verdicts if verdict.status == "fail"]
    end = "no verdict fails: `rigid frontier` may begin"
    if failed:
        end = f"fails: {'; '.join(failed)}"
    return "\n".join([*lines, "", f"  {end}"])
