"""`rigid train clone`: a human learned from recorded people."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from rigid.commands.naming import TaskOptions
from rigid.commands.parsing import at_least
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.compute.people.cloned import Cloned
    from rigid.learning.cloning import Progress

CLONE_FILE = "clone.json"
_LEAST_ROLLOUTS = 20


@dataclass(frozen=True, kw_only=True)
class CloneCommand(TaskOptions):
    """Learn a human from recorded episodes (behaviour cloning), so that no synthetic one is needed.

    A part of the episodes, by participant where known, is held out: it says when to stop, how much
    people vary, and how well the clone foresees people whom it never saw. Then the clone plays with
    the robot, and referees try to tell it from the recorded people. Exit 1 when it should not stand
    for them; it is stored all the same, with `clone.json`, which says why.

    Example:
      rigid train clone --canonical people.npz --robot my/robot --out human
      rigid frontier --canonical people.npz --robot my/robot --human human --out runs/mine
    """

    canonical: Path
    """File of episodes with observations and actions (`rigid data import`, `rigid record`)."""
    out: Path
    """Directory for the human."""
    robot: str = "builtin:vanilla"
    """The robot that the people met."""
    trust: bool = False
    """Open a robot whose file can run code: only from people you trust."""
    seed: int = 0
    """Everything random comes from it."""
    rollouts: int = 200
    """Episodes that the clone plays with the robot."""
    hidden: Annotated[tuple[int, ...], tyro.conf.arg(metavar="INT…")] = (64, 64)
    """Widths of the clone's network."""

    def run(self) -> int:
        """Clones, plays, judges and stores."""
        import json
        from dataclasses import replace

        from rigid.compute.people.cloned import check_clonable, clone_human, made_by
        from rigid.data.episodes import load_episodes
        from rigid.files import write_atomically, writing_to
        from rigid.learning.cloning import CloningSettings
        from rigid.policies.loading import load_policy
        from rigid.policies.native import CARD_FILE, save_policy
        from rigid.policies.opening import Opening

        at_least("--seed", self.seed, 0)
        at_least("--rollouts", self.rollouts, _LEAST_ROLLOUTS)
        if (self.out / CARD_FILE).exists():
            raise UserError(f"{self.out} already holds a policy: choose another with --out")
        task = self.open_task()
        episodes = load_episodes(self.canonical, task=task)
        check_clonable(episodes, self.canonical)
        opening = Opening(trust=self.trust)
        robot = load_policy(self.robot, task=task, agent="robot", opening=opening)
        settings = replace(CloningSettings(), hidden=self.hidden)
        with _showing(settings.blocks) as (report, say):
            found = clone_human(
                task, robot, episodes, settings, seed=self.seed, rollouts=self.rollouts,
                where=self.canonical, report=report, say=say,
            )  # fmt: skip
        card = {"recipe": "clone", "seed": self.seed, "robot": self.robot}
        with writing_to(self.out):
            save_policy(
                found.policy, self.out, agent="human", task=task.describe(),
                provenance={**card, **made_by(found, episodes, settings)},
            )  # fmt: skip
            text = json.dumps({**card, **found.as_json()}, indent=1)
            write_atomically(self.out / CLONE_FILE, text.encode())
        _tell(found)
        print(f"human: {self.out}")
        return int(bool(found.problems))


def _tell(found: Cloned) -> None:
    """What a person wants to know before the clone stands for people."""
    parts, likely, played = found.parts, found.likelihoods, found.played
    print(
        f"trained on {len(parts.train)} episodes, stopped by {len(parts.validation)}, judged on "
        f"{len(parts.test)} (whole {parts.by}s)\n"
        f"log-likelihood of a step of theirs: clone {likely.clone:.2f}, mean action "
        f"{likely.mean_action:.2f}, last action again {likely.last_action:.2f}\n"
        f"naturalness with the robot: {played['naturalness']:.3f}"
        f" ± {_text(played['naturalness_se'])} (1: no referee tells it from the people)\n"
        f"{_held_out(played['held_out'])}"
        f"return: {_text(played['return'])}, recorded {_text(found.recorded['return'])}; success: "
        f"{_text(played['success'])}, recorded {_text(found.recorded['success'])}"
    )
    for remark in found.remarks:
        print(f"note: {remark}")
    for problem in found.problems:
        print(f"NOT A STAND-IN: {problem}")


def _held_out(found: Mapping[str, Any] | None) -> str:
    if found is None:
        return ""
    return (
        f"against the {found['episodes']} held-out episodes alone: {found['naturalness']:.3f}"
        f" ± {_text(found['naturalness_se'])}\n"
    )


def _text(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3f}"


@contextmanager
def _showing(
    looks: int,
) -> Iterator[tuple[Callable[[Progress], None], Callable[[str], None]]]:
    """A bar over the looks at held-out episodes, and lines for what follows."""
    from rich.console import Console
    from rich.progress import MofNCompleteColumn

    from rigid.commands.terminal.progress import TimeColumn, bar_of

    console = Console(stderr=True)
    with bar_of(console, MofNCompleteColumn(), TimeColumn("judging")) as bar:
        task = bar.add_task("cloning", total=looks)

        def report(progress: Progress) -> None:
            text = f"cloning · held-out log-likelihood {progress.log_likelihood:.2f}"
            bar.update(task, completed=progress.look + 1, description=text)

        def say(text: str) -> None:
            bar.update(task, completed=looks)  # It may have stopped early.
            console.print(text, highlight=False)

        yield report, say
