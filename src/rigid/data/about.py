"""What a file of episodes says of its origin: units, consent, licence, and a note on each episode.

Nothing here changes a measurement, so none of it is part of `data_hash`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from pydantic import BaseModel, ConfigDict, PositiveFloat


class _Part(BaseModel):
    """Unknown fields are let be: the format grows by adding."""

    model_config = ConfigDict(frozen=True, strict=True)


class EpisodeNote(_Part):
    """Where one episode comes from; empty text where nobody said."""

    name: str = ""
    """What the recording calls it."""
    participant: str = ""
    """A pseudonym, never a name; the key that leads to the person belongs elsewhere."""
    device: str = ""
    """What recorded it."""
    robot: str = ""
    """What the recording calls the robot that the person met."""
    notes: str = ""


class About(_Part):
    """Of a whole file; None and empty where nobody said."""

    units: Mapping[str, str] = {}
    """Of features and observations, by name."""
    consent: str | None = None
    """What the participants agreed to, in words: who may use this, and for what."""
    licence: str | None = None
    """Under which others may use it, an SPDX identifier such as CC-BY-4.0."""
    recorded_rate: PositiveFloat | None = None
    """Samples a second of the recording, before it was resampled [Hz]."""
    episodes: tuple[EpisodeNote, ...] = ()
    """One for each episode, in their order, or none at all."""

    def pick(self, which: np.ndarray) -> About:
        """The same of some of the episodes, in the order of `which`."""
        notes = tuple(self.episodes[int(episode)] for episode in which) if self.episodes else ()
        return self.model_copy(update={"episodes": notes})

    @property
    def participants(self) -> tuple[str, ...]:
        """The pseudonyms in the file, sorted; of episodes whose participant is known."""
        return tuple(sorted({note.participant for note in self.episodes} - {""}))


NOTHING_SAID = About()
