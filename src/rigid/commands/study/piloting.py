"""`rigid study pilot`: a study played through by scripts, before people come."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.parsing import at_least, spoken
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.study.pilot.checking import Found
    from rigid.study.pilot.run import Ahead, Begin

_shown_as = tyro.conf.arg
LATE = 120.0
"""95th percentile of a period that is felt [ms]; the control period is 100."""


@dataclass(frozen=True, kw_only=True)
class PilotCommand:
    """Play a study through with scripted participants, over real HTTP and WebSockets.

    Serves the study, invites as many scripts as people are planned for each role, and lets all of
    them take part at once, from the consent to the last page. Then looks whether everything they
    did is stored, and whether every episode comes out again from its seed and actions. What it
    leaves is marked as scripted and never counts as people's. Exit code 1: something is missing.

    Examples:
      rigid study pilot --study study.yaml --data pilots/first
      rigid study pilot --study builtin:paper-exhaustiveness --data pilots/paper --speed 4
    """

    study: Annotated[str, _shown_as(metavar="FILE")]
    """Study file, or builtin:NAME."""
    data: Path
    """Directory for what the pilot leaves, for `rigid study export` and `analyze`; no study yet."""
    participants: Annotated[int | None, _shown_as(metavar="INT")] = None
    """At most so many of each role; by default all that are planned."""
    scripts: str = "extend,retreat,tremble,still,follow"
    """How those who play move their hand, in turn."""
    speed: float = 1.0
    """Seconds of the study in one of ours; above 1 periods say nothing of this machine."""
    trust: bool = False
    """Open robots and tasks that can run code: only of people you trust."""

    def run(self) -> int:
        """Plays, looks and prints."""
        from rigid.study.pilot.run import PilotOrder, run_pilot
        from rigid.study.play.scripts import script

        names = self.scripts.split(",")
        for name in names:
            script(name)
        if self.participants is not None:
            at_least("--participants", self.participants, 1)
        if not 0.1 <= self.speed <= 100:
            raise UserError(f"--speed {self.speed:g} must be between 0.1 and 100")
        order = PilotOrder(
            study=self.study, data=self.data, scripts=names, participants=self.participants,
            speed=self.speed, trust=self.trust,
        )  # fmt: skip
        with _progress() as begin:
            found = run_pilot(order, begin)
        print(table(found))
        problems = [f"{f.participant.code}: {text}" for f in found for text in f.problems]
        slow = max((f.period_ms for f in found if f.period_ms is not None), default=0.0)
        if slow > LATE and self.speed <= 1:
            print(f"steps came up to {slow:.0f} ms apart (95 %): too many play at once here")
        if problems:
            print("\n".join(["", *problems]))
            return 1
        print(f"everything is there; it is kept in {self.data}, marked as scripted")
        return 0


def table(found: Sequence[Found]) -> str:
    """A line for each scripted participant."""
    width = max(len("role"), *(len(f.participant.role) for f in found))
    columns = "script   practised  played  helped  touched  trials  checks  period"
    lines = [f"code  {'role':{width}}  {columns}"]
    for f in found:
        period = "" if f.period_ms is None else f"{f.period_ms:3.0f} ms"
        lines.append(
            f"{f.participant.code:4}  {f.participant.role:{width}}  {f.script or '-':7}  "
            f"{f.practised:9}  {f.played:6}  {f.helped:6}  {f.unwanted:7}  {f.trials:6}  "
            f"{f.passed:6}  {period}".rstrip()
        )
    return "\n".join(lines)


@contextmanager
def _progress() -> Iterator[Begin]:
    """An estimate, and a bar over episodes and trials on the terminal."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    with Progress(console=console, disable=not console.is_terminal) as bar:

        def begin(ahead: Ahead) -> Callable[[], None]:
            plays = f"; they play for about {spoken(ahead.seconds)}" if ahead.seconds else ""
            console.print(f"{ahead.people} scripts take part{plays}", highlight=False)
            task = bar.add_task("pilot", total=ahead.things)
            return lambda: bar.advance(task)

        yield begin
