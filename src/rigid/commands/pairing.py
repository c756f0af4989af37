"""`rigid pairs`: pairs of episodes for user studies."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

from rigid.commands.parsing import at_least, printable
from rigid.commands.terminal.helping import several
from rigid.commands.terminal.wrapping import show, tell
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.data.pair_file import FoundMember, PairFile, RecordedMember

_shown_as = tyro.conf.arg


@dataclass(frozen=True, kw_only=True)
class PairsCommand:
    """Pick pairs of episodes to show people, from finished runs and recordings.

    danger: similarly natural (difference below 0.1), unlike in harm (adversarialness differs by
    more than 0.3). naturalness: similar in harm (below 0.1), unlike in naturalness (above 0.3).
    faithfulness: an adversary's episode and a recorded one, similarly natural (below 0.1).

    Naturalness is the human's and adversarialness the episode's. Both of a pair meet one robot and
    start alike, no episode is shown twice, and runs take turns. Equal files and seeds give equal
    pairs, each with a canonical reference and a moment to show as a still: docs/pairs.md.

    Examples:
      rigid pairs runs/vanilla runs/palm --kind danger --out danger.json
      rigid pairs runs/vanilla --recordings anna.npz ben.npz --kind faithfulness --out pairs.json
    """

    directories: Annotated[tuple[Path, ...], tyro.conf.Positional, several()] = ()
    """Finished run directories of one task."""
    recordings: Annotated[tuple[Path, ...], several("FILE…")] = ()
    """Recorded episodes, one human a file; judged by the runs of the robot they met."""
    kind: Annotated[Literal["danger", "naturalness", "faithfulness"], _shown_as(metavar="KIND")]
    """danger, naturalness or faithfulness."""
    count: int = 30
    """How many; the paper shows 30."""
    seed: int = 0
    """The draw comes from it."""
    reuse: bool = False
    """Allow an episode in several pairs."""
    any_start: bool = False
    """Allow a pair whose humans start from different things, such as two itches."""
    robot: Annotated[str | None, _shown_as(metavar="ROBOT")] = None
    """The measured robot, if it is no longer where it was; only recordings need it."""
    out: Path
    """File to write (.json)."""

    def run(self) -> int:
        """Picks, writes and prints."""
        from rigid.commands.terminal.progress import counted
        from rigid.compute.pairs.picking import PairOrder, pick_pairs
        from rigid.data.pair_file import save_pairs
        from rigid.files import make_room, writing_to

        at_least("--count", self.count, 1)
        at_least("--seed", self.seed, 0)
        if not self.directories:
            raise UserError("pairs needs at least one run directory: rigid pairs RUN --kind danger")
        make_room(self.out)
        order = PairOrder(
            runs=self.directories, recordings=self.recordings, kind=self.kind, count=self.count,
            seed=self.seed, reuse=self.reuse, any_start=self.any_start, robot=self.robot,
        )  # fmt: skip
        found = pick_pairs(
            order, self.out, say=tell,
            track=lambda places: counted("choosing moments", places),
        )  # fmt: skip
        with writing_to(self.out):
            save_pairs(self.out, found)
        print(table(found))
        count = f"{len(found.pairs)} {found.kind} pairs of {found.eligible} eligible"
        show(f"{count}: {self.out}")
        return 0


def table(found: PairFile) -> str:
    """A line for each pair: x is naturalness, y adversarialness, and the step of the still."""
    lines = [f"pair  {_HEAD}   {_HEAD}   run"]
    for number, pair in enumerate(found.pairs, start=1):
        run = found.runs[pair.run].path
        lines.append(f"{number:4}  {_cells(pair.first)}   {_cells(pair.second)}   {printable(run)}")
    return "\n".join(lines)


_HEAD = f"{'episode':20}  {'x':>5}  {'y':>5}  step"


def _cells(member: FoundMember | RecordedMember) -> str:
    if member.origin == "run":
        name = f"{member.point} {member.shown}"
    else:
        name = f"recording {member.recording} #{member.episode}"
    x, y = member.naturalness, member.adversarialness
    return f"{name:20}  {x:5.3f}  {y:5.3f}  {member.snapshot:4}"
