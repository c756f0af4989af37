"""The search measures by name: `rigid frontier --search-measure NAME`."""

from __future__ import annotations

import difflib
from collections.abc import Callable

from rigid.errors import UserError
from rigid.naturalness.ensemble import Ensemble
from rigid.naturalness.gan import Gan
from rigid.naturalness.kl import ExactKL
from rigid.naturalness.lsgan import DiscriminatorSettings
from rigid.naturalness.measure import Measure
from rigid.naturalness.mmd import MMD
from rigid.naturalness.sights import Recurrent, Windows

DEFAULT_MEASURE = "lsgan"


def _temporal(settings: DiscriminatorSettings, penalty: str) -> Measure:
    sights = (Windows(), Recurrent())
    return Ensemble(tuple(Gan(settings=settings, penalised=penalty, sight=s) for s in sights))


def _ensemble(settings: DiscriminatorSettings, penalty: str) -> Measure:
    step = Gan(settings=settings, penalised=penalty)
    window = Gan(settings=settings, penalised=penalty, sight=Windows())
    return Ensemble((step, step, window, MMD()))


MEASURES: dict[str, Callable[[DiscriminatorSettings, str], Measure]] = {
    "lsgan": lambda settings, penalty: Gan(settings=settings, penalised=penalty),
    "paper_d2": lambda settings, _: Gan(settings=settings, penalised="paper_d2"),
    "kl": lambda *_: ExactKL(),
    "kl-gan": lambda settings, _: Gan(settings=settings, penalised="log_ratio", loss="logistic"),
    "mmd": lambda *_: MMD(),
    "temporal": _temporal,
    "ensemble": _ensemble,
}
"""Each from the settings of its discriminators, if it has any, and what they penalise."""


def check_measure(name: str) -> str:
    """The name, if a measure has it; else raises `UserError` listing them."""
    if name not in MEASURES:
        close = difflib.get_close_matches(name, MEASURES, n=1)
        suggestion = f", did you mean {close[0]!r}?" if close else ";"
        raise UserError(
            f"search measure {name!r} is unknown{suggestion} measures: {', '.join(MEASURES)}"
        )
    return name


def measure_named(name: str, settings: DiscriminatorSettings, penalty: str) -> Measure:
    """The measure called `name`.

    Args:
        name: One of `MEASURES`.
        settings: Of its discriminators.
        penalty: Which function of their score they penalise, where the measure leaves it open.

    Raises:
        UserError: No measure has this name.
    """
    return MEASURES[check_measure(name)](settings, penalty)
