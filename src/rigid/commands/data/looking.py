"""`rigid data show` and `rigid data check`: what a file of episodes holds, and if it is good."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from rigid.commands.naming import TaskOptions
from rigid.commands.terminal.wrapping import tell


@dataclass(frozen=True, kw_only=True)
class ShowCommand:
    """Show what a file of episodes holds: people, rate, ranges, consent, licence, hash.

    Example:
      rigid data show people.npz
    """

    file: Annotated[Path, tyro.conf.Positional]
    """File of episodes (.npz)."""
    json: bool = False
    """Print as JSON."""

    def run(self) -> int:
        """Reads and prints."""
        from rigid.commands.data.tables import described, print_described
        from rigid.data.episodes import load_episodes

        found = described(load_episodes(self.file, task=None))
        if self.json:
            print(json.dumps(found))
        else:
            print_described(found)
        return 0


@dataclass(frozen=True, kw_only=True)
class CheckCommand(TaskOptions):
    """Check that a file of episodes can be used as canonical data of a task; exit 1 if it cannot.

    Example:
      rigid data check people.npz --task itch-scratching
    """

    file: Annotated[Path, tyro.conf.Positional]
    """File of episodes (.npz)."""
    json: bool = False
    """Print the verdicts as JSON."""

    def run(self) -> int:
        """Loads, judges and prints."""
        from rigid.commands.data.tables import print_verdicts, too_few
        from rigid.data.checking import judge_file
        from rigid.data.episodes import load_episodes

        task = self.open_task()
        episodes = load_episodes(self.file, task=task)
        verdicts = judge_file(episodes, task)
        problem = too_few(len(episodes)) if episodes.source == "recorded" else None
        if self.json:
            listed = [verdict.as_json() for verdict in verdicts]
            print(json.dumps({"episodes": listed, "problem": problem}))
        else:
            print_verdicts(verdicts)
        if problem is not None:
            tell(f"warning: {problem}")
        bad = sum(not verdict.used for verdict in verdicts)
        if not self.json:
            print(f"{self.file}: {len(verdicts) - bad} of {len(verdicts)} episodes are good")
        return int(bad > 0 or problem is not None)
