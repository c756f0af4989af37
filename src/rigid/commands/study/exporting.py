"""`rigid study export`, `rigid study withdraw`: people's data as files, and taken out again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.terminal.helping import several
from rigid.commands.terminal.wrapping import tell

if TYPE_CHECKING:
    from rigid.study.store.exports import Corrected, Exported


@dataclass(frozen=True, kw_only=True)
class ExportCommand:
    """Write a study's data as files: tables, whole episodes, and episodes as RIGID measures them.

    `canonical/` holds what people practised, by class of devices and robot: natural behaviour of
    people, for `rigid frontier --canonical`. `played/` holds what each of them played, for
    `rigid pairs --recordings`. The study may be served meanwhile. Into a directory that holds an
    export of this data it is written anew, without those who withdrew since.

    Examples:
      rigid study export --data data/study1 --out export
      rigid study export --data data/study1 --out shared --shareable --licence CC-BY-4.0
    """

    data: Path
    """Directory of the study."""
    out: Path
    """New directory, or an earlier export of this data."""
    shareable: bool = False
    """Leave out who did not agree to sharing, external ids, times, and words of their own."""
    licence: Annotated[str | None, tyro.conf.arg(metavar="SPDX")] = None
    """Under which others may use what is shareable, such as CC-BY-4.0; kept with the files."""

    def run(self) -> int:
        """Writes, then takes who withdrew out of earlier exports."""
        from rich.console import Console

        from rigid.study.store.exports import correct_exports, write_export

        with Console(stderr=True).status("writing"):
            found = write_export(
                self.data, self.out, shareable=self.shareable, licence=self.licence
            )
            corrected = correct_exports(self.data)
        print(_told(found))
        _tell_corrected(corrected)
        return 0


@dataclass(frozen=True, kw_only=True)
class WithdrawCommand:
    """Delete everything of participants who withdraw: from the study and from its exports.

    They can do so themselves on their page; this is for those who ask you to. The study may be
    served meanwhile. Their codes stay, so that copies elsewhere can be corrected. Without a code it
    ends what earlier withdrawals had to leave: bytes that somebody was reading, exports.

    Examples:
      rigid study withdraw P07 --data data/study1
      rigid study withdraw --data data/study1
    """

    codes: Annotated[tuple[str, ...], tyro.conf.Positional, several()] = ()
    """Of the participants."""
    data: Path
    """Directory of the study."""

    def run(self) -> int:
        """Deletes."""
        from rich.console import Console

        from rigid.study.store import Store
        from rigid.study.store.exports import correct_exports

        with Store.edit(self.data) as store:
            for code in self.codes:
                store.participant(code)  # All are there before the first is deleted.
            for code in self.codes:
                store.withdraw(code)
                print(f"deleted everything of {code}")
            whole = store.scrub()
        if not whole:
            tell(
                "warning: somebody is reading the study, so that traces are left in its files: end "
                f"that, then rigid study withdraw --data {self.data}"
            )
        with Console(stderr=True).status("correcting exports"):
            corrected = correct_exports(self.data)
        _tell_corrected(corrected)
        if self.codes:
            print("what `rigid study analyze` wrote before counts them still: analyse again")
        if whole and not self.codes and not corrected:
            print("nothing is left of those who withdrew")
        return 0


def _told(found: Exported) -> str:
    written = found.written
    counts = f"{written.episodes} episodes, {written.answers} answers"
    lines = [f"{len(found.codes)} participants, {counts}: {found.path}"]
    if found.not_shared:
        lines.append(f"not among them, since they did not agree: {', '.join(found.not_shared)}")
    if written.faulted:
        lines.append(f"{written.faulted} episodes ran away and are in no canonical file")
    lines += [f"canonical episodes: {found.path / name}" for name in written.blocks]
    return "\n".join(lines)


def _tell_corrected(corrected: Sequence[Corrected]) -> None:
    for export in corrected:
        if export.mended:
            print(f"took {', '.join(export.codes)} out of {export.path}")
        else:
            tell(f"warning: {export.missing()}")
