"""`rigid data import`: canonical episodes from people's recordings."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.commands.naming import TaskOptions
from rigid.commands.places import new_file
from rigid.commands.terminal.wrapping import tell
from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.data.episodes import CanonicalEpisodes
    from rigid.data.importing import Imported
    from rigid.tasks.protocol import Task

_shown_as = tyro.conf.arg


@dataclass(frozen=True, kw_only=True)
class ImportCommand(TaskOptions):
    """Make canonical episodes of a recording: CSV files, or a Minari dataset.

    A CSV file has a row for each moment of each episode: columns `episode`, `time` [s] (or `step`),
    one for each feature of the task, and, where known, `observation_I`, `action_I`, `reward`,
    `return`, `success`, `seed`, `participant`, `device`, `robot`, `notes`. Samples of any rate
    become control steps. Every episode is judged, and the good ones are used.

    Examples:
      rigid data import --from motion.csv --map columns.json --out people.npz
      rigid data import --from minari:people/itch-v0 --task itch-scratching --out people.npz
    """

    source: Annotated[str, _shown_as(name="from", metavar="FILE.csv|DIR|minari:ID")]
    """A CSV file, a folder of them (a file an episode), or a Minari dataset."""
    out: Path
    """File to write (.npz); one that is there stays."""
    overwrite: bool = False
    """Replace a file that is there, and what people consented to in it."""
    map_: Annotated[Path | None, _shown_as(name="map", metavar="FILE")] = None
    """JSON or YAML: which columns of the recording are which, and in what units."""
    rate: Annotated[float | None, _shown_as(metavar="HZ")] = None
    """Samples a second, where rows are numbered by `step` and have no `time`."""
    robot: Annotated[str | None, _shown_as(metavar="ROBOT")] = None
    """The robot that people met: plays recorded actions again, to fill in returns and the like."""
    met: Annotated[str | None, _shown_as(metavar="NAME")] = None
    """Use only episodes whose column `robot` says this."""
    consent: Annotated[str | None, _shown_as(metavar="TEXT")] = None
    """What the participants agreed to; kept with the file."""
    licence: Annotated[str | None, _shown_as(metavar="SPDX")] = None
    """Under which others may use it, such as CC-BY-4.0; kept with the file."""
    trust: bool = False
    """Open a robot whose file can run code: only from people you trust."""
    json: bool = False
    """Print the verdicts as JSON."""

    def run(self) -> int:
        """Reads, judges, resamples and stores."""
        from rigid.data.column_map import load_map
        from rigid.data.episodes import save_episodes
        from rigid.data.importing import import_recording
        from rigid.data.sources import open_source
        from rigid.files import writing_to

        new_file(self.out, overwrite=self.overwrite)
        task, map_ = self.open_task(), load_map(self.map_)
        opened = open_source(self.source, task, map_, rate=self.rate)
        about = opened.about
        if self.consent is not None:
            about = about.model_copy(update={"consent": self.consent})
        if self.licence is not None:
            about = about.model_copy(update={"licence": self.licence})
        found = import_recording(
            opened.recording, task, map_=map_, about=about, source=opened.source, robot=self.met,
            provenance={**opened.provenance, "imported_from": self.source},
        )  # fmt: skip
        episodes = found.episodes
        notes = []
        if found.computed:
            notes.append(f"computed velocities of {', '.join(found.computed)}")
        if episodes is not None and self.robot is not None:
            episodes, said = self._completed(task, episodes)
            notes.append(said)
        if episodes is not None:
            with writing_to(self.out):
                save_episodes(self.out, episodes)
        return self._tell(found, episodes, notes)

    def _completed(self, task: Task, episodes: CanonicalEpisodes) -> tuple[CanonicalEpisodes, str]:
        from rigid.compute.people.completing import complete
        from rigid.policies.loading import load_policy
        from rigid.policies.opening import Opening

        assert self.robot is not None
        robot = load_policy(self.robot, task=task, agent="robot", opening=Opening(trust=self.trust))
        found, same = complete(task, robot, episodes, where=Path(self.source))
        said = f"{int(same.sum())} of {len(same)} episodes came out again with {self.robot}"
        if not same.all():
            said += "; of the others nothing was filled in: they met another robot or task"
        return found, said

    def _tell(self, found: Imported, episodes: CanonicalEpisodes | None, notes: list[str]) -> int:
        from rigid.commands.data.tables import print_verdicts, too_few

        used = 0 if episodes is None else len(episodes)
        if self.json:
            verdicts = [verdict.as_json() for verdict in found.verdicts]
            print(json.dumps({"episodes": verdicts, "used": used, "notes": notes}))
        else:
            print_verdicts(found.verdicts)
        if episodes is None:
            raise UserError(
                f"{self.source} holds no episode that can be used: the reasons stand above"
            )
        warnings = [too_few(used), _about_velocities(found.computed, episodes.feature_names)]
        untold = episodes.about.consent is None or episodes.about.licence is None
        if untold and episodes.source == "recorded":
            warnings.append("nobody will know what may be done with it: --consent, --licence")
        for note in notes:
            tell(note)
        for warning in filter(None, warnings):
            tell(f"warning: {warning}")
        if not self.json:
            print(f"{used} of {len(found.verdicts)} episodes: {self.out}")
        return 0


def _about_velocities(computed: Sequence[str], names: Sequence[str]) -> str | None:
    """Velocities from positions are smoother than the task's, which a referee of windows sees."""
    if not computed:
        return None
    measured = [name for name in names if name.removesuffix("_velocity") not in computed
                or name in computed]  # fmt: skip
    return (
        "velocities that were computed from positions are not quite those of the task; let nobody "
        f"judge by them: rigid frontier --features {','.join(measured)}"
    )
