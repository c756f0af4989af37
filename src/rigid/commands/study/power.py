"""`rigid study power`: how large a study must be, before anybody is invited."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

from rigid.commands.parsing import at_least, parse_counts
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.study.bounds import Chance
    from rigid.study.plan import JudgeStage, StudyPlan
    from rigid.study.power import Design, Power, Size

_shown_as = tyro.conf.arg
Judged = Literal["faithfulness", "danger", "naturalness"]
Kind = Literal["faithfulness", "danger", "naturalness", "exhaustiveness"]
WANTED = (0.8, 0.9)
"""Powers whose smallest sizes are named: the customary ones."""


@dataclass(frozen=True, kw_only=True)
class PowerCommand:
    """Simulate whole studies, to see how many raters, pairs and players it takes.

    faithfulness: do two one-sided tests find people's preference within --margin of one half, if
    it truly is --effect (0.5)? danger, naturalness: is the second of a pair seen to score higher,
    if it truly does by --effect points (1)? Raters and pairs are both drawn anew, and analysed as
    `rigid study analyze` does. exhaustiveness: how many players, for 'at most p % of people lie
    above the frontier'?

    With --study, the sizes are those of its roles: docs/study.md.

    Examples:
      rigid study power --kind faithfulness --raters 10,20,30 --pairs 20,30,40
      rigid study power --kind exhaustiveness --at-most 0.1
      rigid study power --study builtin:paper-faithfulness
    """

    kind: Annotated[Kind, _shown_as(metavar="KIND")] = "faithfulness"
    """faithfulness, danger, naturalness or exhaustiveness."""
    study: Annotated[str | None, _shown_as(metavar="FILE")] = None
    """A study file or builtin:NAME, in place of a kind and sizes."""
    raters: str = "5,10,15,20,30"
    """How many people judge."""
    pairs: str = "10,20,30,40"
    """How many pairs each of them judges."""
    effect: Annotated[float | None, _shown_as(metavar="NUMBER")] = None
    """The truth: a preference (0 to 1, faithfulness) or points of a scale (danger, naturalness)."""
    margin: float = 0.1
    """Of equivalence (faithfulness)."""
    sd_raters: Annotated[float | None, _shown_as(metavar="NUMBER")] = None
    """How raters differ in the effect: standard deviation in log odds (0.3) or points (0.5)."""
    sd_pairs: Annotated[float | None, _shown_as(metavar="NUMBER")] = None
    """How pairs do: log odds (0.5) or points (1)."""
    sd_answers: Annotated[float | None, _shown_as(metavar="NUMBER")] = None
    """What is left of one answer on a scale, in points (1.5)."""
    players: str = "8,10,20,30,50,100"
    """How many people play (exhaustiveness)."""
    at_most: float = 0.1
    """The largest share of people above the frontier that is to be claimed (exhaustiveness)."""
    above: float = 0.01
    """The true share (exhaustiveness)."""
    simulations: int = 500
    """Studies of each size; the error of a power falls with their root."""
    seed: int = 0
    """The draws come from it."""
    json: bool = False
    """Print the result as JSON."""

    def run(self) -> int:
        """Simulates and prints."""
        at_least("--simulations", self.simulations, 1)
        at_least("--seed", self.seed, 0)
        self._check()
        if self.study is not None:
            found, text = self._of_study(self.study)
        elif self.kind == "exhaustiveness":
            found, text = self._of_players()
        else:
            found, text = self._of_grid(self.kind)
        print(json.dumps(found) if self.json else text)
        return 0

    def _of_grid(self, kind: Judged) -> tuple[dict[str, Any], str]:
        """Every number of raters with every number of pairs."""
        from rigid.commands.study.power_tables import design_lines, grid, power_json, smallest_lines
        from rigid.study.power import Size, smallest

        design = self._design(kind)
        raters = parse_counts("--raters", self.raters, least=2)
        pairs = parse_counts("--pairs", self.pairs, least=2)
        sizes = [Size(r, p) for r in raters for p in pairs]
        powers = self._simulate([(design, size) for size in sizes])
        least = {wanted: smallest(powers, wanted) for wanted in WANTED}
        text = [*design_lines(kind, design, self.simulations), "", *grid(powers), ""]
        found = {
            "kind": kind, "design": asdict(design), "seed": self.seed,
            "simulations": self.simulations, "powers": [power_json(p) for p in powers],
            "smallest": {str(w): [power_json(p) for p in least[w]] for w in WANTED},
        }  # fmt: skip
        return found, "\n".join([*text, *smallest_lines(least)])

    def _of_players(self) -> tuple[dict[str, Any], str]:
        """Every number of players; nothing needs to be simulated."""
        from rigid.commands.study.power_tables import needed_table, players_table
        from rigid.study.bounds import chance

        counts = parse_counts("--players", self.players, least=1)
        chances = [chance(n, at_most=self.at_most, above=self.above) for n in counts]
        needed = self._players_for_power()
        found = {
            "kind": "exhaustiveness", "at_most": self.at_most, "above": self.above,
            "players": [c._asdict() for c in chances],
            "smallest": {str(w): None if c is None else c._asdict() for w, c in needed.items()},
        }  # fmt: skip
        text = players_table(chances, at_most=self.at_most, above=self.above, needed=needed)
        return found, "\n".join([*text, "", *needed_table()])

    def _players_for_power(self) -> dict[float, Chance | None]:
        from rigid.study.bounds import smallest_for

        return {
            wanted: smallest_for(wanted, at_most=self.at_most, above=self.above)
            for wanted in WANTED
        }

    def _of_study(self, name: str) -> tuple[dict[str, Any], str]:
        """Each role at its planned size."""
        from rigid.commands.study.power_tables import power_json, study_table
        from rigid.study.bounds import chance
        from rigid.study.plan import load_plan
        from rigid.study.power import Size

        plan = load_plan(name)
        judged = list(_judged(plan))
        powers = self._simulate([
            (self._design(_KINDS[stage.question]), Size(participants, stage.count))
            for _, participants, stage in judged
        ])  # fmt: skip
        players = [
            (name, chance(role.participants, at_most=self.at_most, above=self.above))
            for name, role in plan.roles.items()
            if any(stage.kind == "play" for stage in role.stages)
        ]
        raters = [
            (role, _KINDS[stage.question], power)
            for (role, _, stage), power in zip(judged, powers, strict=True)
        ]
        found = {
            "study": name, "seed": self.seed, "simulations": self.simulations,
            "players": [{"role": role, **c._asdict()} for role, c in players],
            "raters": [{"role": r, "kind": kind, **power_json(p)} for r, kind, p in raters],
        }  # fmt: skip
        return found, "\n".join(study_table(players, raters, at_most=self.at_most))

    def _design(self, kind: Judged) -> Design:
        from rigid.study.power import ChoiceDesign, ScaleDesign

        if kind == "faithfulness":
            given = {"preference": self.effect, "sd_raters": self.sd_raters,
                     "sd_pairs": self.sd_pairs}  # fmt: skip
            return ChoiceDesign(margin=self.margin, **_told(given))
        given = {"difference": self.effect, "sd_raters": self.sd_raters,
                 "sd_pairs": self.sd_pairs, "sd_answers": self.sd_answers}  # fmt: skip
        return ScaleDesign(scales=2 if kind == "danger" else 1, **_told(given))

    def _check(self) -> None:
        """Refuses what no simulation can mean."""
        if not 0.0 < self.margin < 0.5:
            raise UserError(f"--margin {self.margin:g} must lie between 0 and 0.5, as 0.1")
        for option, share in (("--at-most", self.at_most), ("--above", self.above)):
            if not 0.0 <= share < 1.0 or (option == "--at-most" and share == 0.0):
                raise UserError(f"{option} {share:g} must be a share, as 0.1 for 10 %")
        for name in ("sd_raters", "sd_pairs", "sd_answers"):
            value = getattr(self, name)
            if value is not None and not 0.0 <= value <= 10.0:
                option = "--" + name.replace("_", "-")
                raise UserError(f"{option} {value:g} must be between 0 and 10")
        choice = self.kind == "faithfulness" and self.study is None
        low, high = (0.0, 1.0) if choice else (-7.0, 7.0)
        if self.effect is not None and not low < self.effect < high:
            raise UserError(
                f"--effect {self.effect:g} must lie between {low:g} and {high:g} for {self.kind}"
            )

    def _simulate(self, cases: list[tuple[Design, Size]]) -> list[Power]:
        from rigid.study.power import power

        with _progress(len(cases) * self.simulations) as tick:
            return [
                power(design, size, simulations=self.simulations, seed=self.seed, tick=tick)
                for design, size in cases
            ]


_KINDS: dict[str, Judged] = {
    "correspondence": "faithfulness",
    "danger": "danger",
    "naturalness": "naturalness",
}
"""What a question of a study file is asked for."""


def _told(given: dict[str, float | None]) -> dict[str, Any]:
    return {name: value for name, value in given.items() if value is not None}


def _judged(plan: StudyPlan) -> Iterator[tuple[str, int, JudgeStage]]:
    """Role, participants and stage of every questionnaire."""
    for name, role in plan.roles.items():
        for stage in role.stages:
            if stage.kind == "judge":
                yield name, role.participants, stage


@contextmanager
def _progress(total: int) -> Iterator[Callable[[], None]]:
    """A bar on the terminal."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    with Progress(console=console, disable=not console.is_terminal) as bar:
        task = bar.add_task("studies", total=total)
        yield lambda: bar.advance(task)
