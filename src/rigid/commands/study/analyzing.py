"""`rigid study analyze`: what a study found."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rigid.commands.terminal.helping import several
from rigid.errors import UserError


@dataclass(frozen=True, kw_only=True)
class AnalyzeCommand:
    """Place people on the frontiers of the robots they met, and test what raters judged.

    People: naturalness at most, by the strictest of the referees that the runs stored, and
    adversarialness as in the frontier; how many lie above it; kinds of device apart, each with
    practice as its control. Scripted players are shown and never counted. Raters: whether they
    prefer neither of two motions, as a test of equivalence; how danger and naturalness scores
    follow the axes; how far raters agree. Two robots or more: whether people fail more with the one
    that measures worse. Writes analysis.json, placed.csv, figures (SVG, PDF) and study.html.

    The margin is fixed before the first participant: another one than the study registered makes
    the tests exploratory, and the page says so. The study may be served meanwhile.

    Examples:
      rigid study analyze --data data/study1 --runs runs/vanilla runs/palm --out results
      rigid study analyze --data data/study1 --runs a=runs/vanilla --out results --json
    """

    data: Path
    """Directory of the study."""
    runs: Annotated[tuple[str, ...], several("RUN…")] = ()
    """Finished runs of the study's robots, as DIR, or KEY=DIR with the robot's key there; only
    people who played need them."""
    out: Path
    """Directory for the results."""
    margin: float = 0.1
    """How far from one half a preference may lie and still count as none."""
    json: bool = False
    """Print the analysis as JSON."""

    def run(self) -> int:
        """Reads, analyses, writes and prints."""
        from rich.console import Console

        from rigid.files import json_text, make_room, writing_to
        from rigid.study.analysis.reading import read_questionnaires, read_robots, read_study
        from rigid.study.analysis.settings import AnalysisSettings
        from rigid.study.analysis.whole import analyse
        from rigid.study.analysis.wording import notes, sentences
        from rigid.study.analysis.writing import as_json, write_analysis

        settings = AnalysisSettings(margin=self.margin)
        make_room(self.out / "study.html")
        study = read_study(self.data)
        if not (study.episodes or study.answers):
            raise UserError(
                f"{self.data}: nobody has played or answered yet: collect with `rigid study serve`"
            )
        with Console(stderr=True).status("reading runs") as status:
            robots = read_robots(self.runs, study, quantile=settings.episode_quantile)
            questionnaires = read_questionnaires(study.plan, study.registered)
            found = analyse(study, robots, questionnaires, settings, say=status.update)
            status.update("drawing")
            with writing_to(self.out):
                written = write_analysis(found, self.out)
        if self.json:
            print(json_text(as_json(found), indent=1))
            return 0
        for line in (*sentences(found), *(f"({note})" for note in notes(found))):
            print(line)
        print(f"written: {written[-1]}")
        return 0
