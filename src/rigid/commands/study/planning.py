"""`rigid study new` and `rigid study show`: a study's file, to start from and to look over."""

from __future__ import annotations

import os
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.terminal.helping import several
from rigid.errors import UserError
from rigid.files import lies_there

if TYPE_CHECKING:
    from rigid.study.plan import StudyPlan

_shown_as = tyro.conf.arg


@dataclass(frozen=True, kw_only=True)
class NewCommand:
    """Write a study file to start from: a copy of one of the paper's studies.

    Examples:
      rigid study new study.yaml
      rigid study new danger.yaml --like paper-danger --robot robots/first robots/second
    """

    file: Annotated[Path, tyro.conf.Positional]
    """Study file to write (.yaml)."""
    like: Annotated[str, _shown_as(metavar="NAME")] = "paper-exhaustiveness"
    """paper-exhaustiveness, paper-faithfulness, paper-danger or paper-naturalness."""
    task: Annotated[str | None, _shown_as(metavar="TASK")] = None
    """Task to name in it."""
    robot: Annotated[tuple[str, ...], several("ROBOT…")] = ()
    """Robots to name in it, which become a, b, …; see rigid frontier --robot."""

    def run(self) -> int:
        """Copies."""
        from rigid.files import make_room, write_atomically, writing_to
        from rigid.study.plan_file import copy_of, protocol_text

        text = copy_of(
            protocol_text(self.like.removeprefix("builtin:")),
            task=self.task,
            robots=[_below(spec, self.file) for spec in self.robot],
        )
        if self.file.exists():
            raise UserError(f"{self.file} is there already: remove it, or choose another name")
        make_room(self.file, "FILE")
        with writing_to(self.file, "FILE"):
            write_atomically(self.file, text.encode())
        print(f"{self.file}: edit it, then look it over with rigid study show --study {self.file}")
        return 0


def _below(spec: str, file: Path) -> str:
    """A robot as it is named from the folder of the study file."""
    if not lies_there(spec):
        return spec
    return Path(os.path.relpath(spec, file.resolve().parent)).as_posix()


@dataclass(frozen=True, kw_only=True)
class ShowCommand:
    """Check a study file, and show what each role does and how long it takes.

    Names every mistake with its line, opens task, robots and pairs as the server would, and says
    what the study could not show.

    Examples:
      rigid study show --study study.yaml
      rigid study show --study builtin:paper-exhaustiveness --preview
    """

    study: Annotated[str, _shown_as(metavar="FILE")]
    """Study file, or builtin:NAME."""
    preview: bool = False
    """Serve it as well, with a link for each role, until Ctrl-C; nothing of it is kept."""
    trust: bool = False
    """Open robots and tasks that can run code: only from people you trust."""

    def run(self) -> int:
        """Reads, checks and prints."""
        from rigid.study.judging.questionnaire import judge_stages, questionnaire
        from rigid.study.overview import advice, overview
        from rigid.study.plan import load_plan, plan_hash

        plan = load_plan(self.study)
        robots = " · ".join(f"{key}: {spec}" for key, spec in plan.robots.items())
        print(f"{plan.title} ({self.study})")
        print(f"task {plan.task} · robots {robots} · language {plan.language}")
        print(f"study {plan_hash(plan)}\n")
        print("\n".join(overview(plan, episode_seconds=self._open(plan))))
        print("\n".join(["", *advice(plan)]))
        for stage in judge_stages(plan):
            questionnaire(stage)
        if self.preview:
            self._serve(plan)
        return 0

    def _serve(self, plan: StudyPlan) -> None:
        """Lets the user see it as participants do."""
        from rigid.study.pilot.run import invite
        from rigid.study.pilot.server import pilot_server

        with (
            suppress(KeyboardInterrupt),
            tempfile.TemporaryDirectory(prefix="rigid-preview-") as folder,
            pilot_server(self.study, Path(folder), speed=1.0, trust=self.trust) as server,
        ):
            for role in plan.roles:
                for who in invite(server, role, 1):
                    print(f"{role}: {server.address}{who.path}")
            print("open a link to see the study as participants do; end with Ctrl-C", flush=True)
            while True:
                time.sleep(1)

    def _open(self, plan: StudyPlan) -> float:
        """Opens task and robots; the length of an episode [s]."""
        from rigid.study.play.episode import PlayedEpisode
        from rigid.study.players import open_players

        task, robots = open_players(plan, trust=self.trust)
        episode = PlayedEpisode(task, next(iter(robots.values())), seed=plan.seed)
        return episode.horizon * episode.period
