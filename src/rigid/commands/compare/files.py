"""What `rigid compare` writes: CSV, LaTeX, a figure and a page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.frontier.standings import Standing


@dataclass(frozen=True, kw_only=True)
class ComparisonFiles:
    """Where each goes; None: nowhere."""

    csv: Path | None = None
    latex: Path | None = None
    figure: Path | None = None
    page: Path | None = None

    def check(self) -> None:
        """Refuses bad places before any work.

        Raises:
            UserError: A file cannot be written, or its ending is that of another kind.
        """
        from rigid.files import make_room
        from rigid.report.figures import KINDS

        _check_ending("--figure", self.figure, KINDS)
        _check_ending("--page", self.page, (".html",))
        for option, path in self._named():
            make_room(path, option)

    def write(self, standings: Sequence[Standing], notes: Sequence[str]) -> list[Path]:
        """Writes all of them.

        Args:
            standings: The first is the baseline.
            notes: Sentences that stand on the page.

        Raises:
            UserError: A file cannot be written.
        """
        from rigid.files import write_atomically, writing_to
        from rigid.report.tables import csv_text, latex, method_row, with_ends

        asked = any(standing.unseen is not None for standing in standings)
        rows = [
            method_row(standing.method, standing.success)
            | (with_ends("unseen", standing.unseen) if asked else {})
            for standing in standings
        ]
        for option, path in self._named():
            with writing_to(path, option):
                if option == "--figure":
                    from rigid.report.curves import draw_curves

                    draw_curves(path, {s.method.name: s.robots for s in standings})
                    continue
                if option == "--page":
                    from rigid.report.comparison import comparison_page

                    text = comparison_page(standings, notes, at=path)
                else:
                    text = csv_text(rows) if option == "--csv" else latex(rows)
                write_atomically(path, text.encode())
        return [path for _, path in self._named()]

    def _named(self) -> Iterator[tuple[str, Path]]:
        """The files that were asked for, by their option."""
        for option, path in (
            ("--csv", self.csv), ("--latex", self.latex), ("--figure", self.figure),
            ("--page", self.page),
        ):  # fmt: skip
            if path is not None:
                yield option, path


def _check_ending(option: str, path: Path | None, endings: Sequence[str]) -> None:
    if path is not None and path.suffix not in endings:
        raise UserError(f"{option} {str(path)!r}: its ending must be {' or '.join(endings)}")
