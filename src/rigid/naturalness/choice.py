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
from rigid.naturalness.mmd import MMD, REFERENCES
from rigid.naturalness.sights import Recurrent, Windows

DEFAULT_MEASURE = "lsgan"
SHARED_REFERENCES = 4
"""Times as many rows for kernels where many adversaries share them. Ours."""


def _temporal(settings: DiscriminatorSettings, penalty: str, code_size: int) -> Measure:
    del code_size
    sights = (Windows(), Recurrent())
    return Ensemble(tuple(Gan(settings=settings, penalised=penalty, sight=s) for s in sights))


def _ensemble(settings: DiscriminatorSettings, penalty: str, code_size: int) -> Measure:
    step = Gan(settings=settings, penalised=penalty)
    window = Gan(settings=settings, penalised=penalty, sight=Windows())
    return Ensemble((step, step, window, _mmd(settings, penalty, code_size)))


def _mmd(settings: DiscriminatorSettings, penalty: str, code_size: int) -> Measure:
    del settings, penalty
    shared = SHARED_REFERENCES if code_size else 1
    return MMD(references=shared * REFERENCES, code_size=code_size)


MEASURES: dict[str, Callable[[DiscriminatorSettings, str, int], Measure]] = {
    "lsgan": lambda settings, penalty, _: Gan(settings=settings, penalised=penalty),
    "paper_d2": lambda settings, *_: Gan(settings=settings, penalised="paper_d2"),
    "kl": lambda *_: ExactKL(),
    "kl-gan": lambda settings, *_: Gan(settings=settings, penalised="log_ratio", loss="logistic"),
    "mmd": _mmd,
    "temporal": _temporal,
    "ensemble": _ensemble,
}
"""Each from the settings of its discriminators, if it has any, what they penalise, and the size of
the code behind the features, 0 for none."""


def check_measure(name: str) -> str:
    """The name, if a measure has it; else raises `UserError` listing them."""
    if name not in MEASURES:
        close = difflib.get_close_matches(name, MEASURES, n=1)
        suggestion = f", did you mean {close[0]!r}?" if close else ";"
        raise UserError(
            f"search measure {name!r} is unknown{suggestion} measures: {', '.join(MEASURES)}"
        )
    return name


def measure_named(
    name: str, settings: DiscriminatorSettings, penalty: str, code_size: int = 0
) -> Measure:
    """The measure called `name`.

    Args:
        name: One of `MEASURES`.
        settings: Of its discriminators.
        penalty: Which function of their score they penalise, where the measure leaves it open.
        code_size: Last columns of the features that are a code (`rigid.naturalness.told`).

    Raises:
        UserError: No measure has this name.
    """
    return MEASURES[check_measure(name)](settings, penalty, code_size)
