"""Finished measurements and robots kept small beside the results of a study.

Raw runs are large and stay on the machine that made them. What is kept is enough to write every
table again, and to go on elsewhere with what is missing.
"""

from __future__ import annotations

from pathlib import Path

from rigid.files import read_bytes, write_atomically
from rigid.frontier.result import FILE, Frontier, load_frontier
from rigid.policies.native import CARD_FILE, WEIGHTS_FILE

_RUN = ("settings.json", FILE)
_POLICY = (WEIGHTS_FILE, CARD_FILE)
"""Last comes the file whose presence says that all is there."""


def keep_run(run: Path, place: Path) -> None:
    """Keeps settings and result of a finished run directory in `place`."""
    _copy(run, place, _RUN)


def keep_policy(policy: Path, place: Path, *, beside: tuple[str, ...] = ()) -> None:
    """Keeps a native policy, and of what lies beside it the files that are named."""
    _copy(policy, place, (*beside, *_POLICY))


def kept_run(place: Path) -> Frontier | None:
    """What `keep_run` left in `place`, None where it never was.

    Raises:
        UserError: It is damaged.
    """
    return load_frontier(place) if (place / FILE).exists() else None


def has_policy(place: Path) -> bool:
    """Whether a policy is in `place`."""
    return (place / CARD_FILE).exists()


def _copy(source: Path, place: Path, names: tuple[str, ...]) -> None:
    place.mkdir(parents=True, exist_ok=True)
    for name in names:
        data = read_bytes(source / name, cure="run the study again")
        write_atomically(place / name, data)
