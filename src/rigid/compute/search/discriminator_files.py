"""What is known of the discriminators of one search seed, on disk: `discriminators/sSEED.json`.

Written when the seed's search is over (`rigid.compute.search.discriminators`), read by the report.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel, ConfigDict, NonNegativeInt

from rigid.files import read_bytes
from rigid.headers import parse_header

FORMAT_VERSION = 1


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, strict=True, allow_inf_nan=False)


class Accuracy(_Part):
    """Shares of steps that are told right."""

    canonical: tuple[float, ...]
    """Held-out canonical motion taken for canonical, at each level of noise."""
    adversaries: Mapping[str, float | None]
    """Motion of each human of the seed taken for not canonical; None where it is unknown."""


class Scores(_Part):
    """D of the poses that are shown, negative for canonical."""

    noisy: tuple[tuple[float, ...], ...]
    own: tuple[float, ...]


class Judged(_Part):
    """How the discriminator of one human fares, and the referee that rules its x axis."""

    discriminator: Accuracy
    referee: Accuracy | None
    scores: Scores


class Poses(_Part):
    """Features of single steps."""

    names: tuple[str, ...]
    levels: tuple[float, ...]
    noisy: tuple[tuple[tuple[float, ...], ...], ...]
    """The same canonical steps at each level of noise."""
    own: Mapping[str, tuple[tuple[float, ...], ...]]
    """Steps of each human."""


class Discriminators(_Part):
    """The discriminators of one seed."""

    format: int = FORMAT_VERSION
    levels: tuple[float, ...]
    canonical_episodes: NonNegativeInt
    adversary_episodes: NonNegativeInt
    judged: Mapping[str, Judged] | None
    """By id; None where the search measure has no discriminator."""
    poses: Poses


def load_discriminators(directory: Path, seed: int) -> Discriminators | None:
    """What a measurement wrote into its run directory; None for a run that never did.

    Raises:
        UserError: The file is damaged or of a newer format version.
    """
    path = file_of(directory, seed)
    if not path.exists():
        return None
    cure = "delete it to draw the report without it"
    text = read_bytes(path, cure=cure)
    return parse_header(Discriminators, text, version=FORMAT_VERSION, where=path, cure=cure)


def file_of(directory: Path, seed: int) -> Path:
    """Where in a run directory it lies."""
    return directory / "discriminators" / f"s{seed}.json"
