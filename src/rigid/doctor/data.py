"""Step 2 of the paper: how many canonical episodes it takes until a judge learns no more from them.

"One may steadily increase the size of the dataset, and visualize the Naturalness measure on OOD
data."
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from rigid.doctor.verdict import Status, Verdict

FEWEST = 12
"""Episodes below which no referee is trained on people (`compute.canonical.FEWEST`)."""
_ENOUGH, _TOLERABLE = 0.03, 0.06
"""Shortfall of the share that a judge tells right, against that with the most episodes. Ours: itch
scratching falls short by 0.01 at the paper's 40 episodes, by 0.06 at 12 and by 0.25 at 3."""


_CHANCE = 0.6
"""Share that a judge tells right below which its curve says nothing: a coin tells half. Ours."""


def check_data(
    episodes: int,
    accuracy: Mapping[int, Sequence[float]],
    *,
    source: str,
    trained: int | None = None,
) -> Verdict:
    """Whether a judge of canonical motion learns enough from the canonical episodes there are.

    Args:
        episodes: How many there are.
        accuracy: For each number of episodes the shares of held-out steps, canonical and not, that
            judges trained with so many tell right, one for each repetition; may be empty.
        source: `synthetic` or `recorded`.
        trained: How many of the episodes a judge of a measurement is trained on; None: all.
    """
    trained = episodes if trained is None else trained
    evidence = {
        "episodes": episodes,
        "trained": trained,
        "source": source,
        "curve": [
            {"episodes": size, "mean": float(np.mean(shares)), "shares": list(map(float, shares))}
            for size, shares in sorted(accuracy.items())
        ],
    }
    more = "Record more" if source == "recorded" else "Record more with `rigid record --episodes N`"
    if not accuracy:
        return Verdict(
            "data", "fail",
            f"{episodes} canonical episodes are too few to train any judge on and keep some apart.",
            f"{more}: at least {FEWEST}, better 40, the paper's number.", evidence,
        )  # fmt: skip
    sizes = sorted(accuracy)
    means = np.array([np.mean(accuracy[size]) for size in sizes])
    short = means.max() - means  # Chance may put the best before the last.
    enough = math.ceil(_first_enough(sizes, short) * episodes / trained)
    mine = float(np.interp(np.log(trained), np.log(sizes), short))
    evidence |= {"shortfall": mine, "enough": enough}
    used = "" if trained == episodes else f", {trained} of which train each referee,"
    told = (
        f"With {episodes} canonical episodes{used} a judge tells {means.max() - mine:.0%} of "
        f"held-out steps right, with {sizes[-1]} {'' if not used else 'to train on '}it tells "
        f"{means[-1]:.0%}"
    )
    status, why, wanted = _judged(episodes, sizes, means, mine, enough)
    advice = "" if status == "pass" else wanted.format(more=more)
    return Verdict("data", status, f"{told}{why}.", advice, evidence)


def _judged(
    episodes: int, sizes: Sequence[int], means: np.ndarray, mine: float, enough: int
) -> tuple[Status, str, str]:
    """Status, what it says of the curve, and the advice, in which {more} is how to record more."""
    wanted = f"{{more}}: about {max(enough, 2 * episodes)} may be enough."
    if episodes < FEWEST or mine > _TOLERABLE:
        return "fail", ": too few", f"{{more}}: about {max(enough, FEWEST)} would be enough."
    if means.max() < _CHANCE:
        cure = "See whether the features tell anything of a moment (--features). {more}."
        return "warn", ": hardly more than chance, so nobody knows what is enough", cure
    if mine > _ENOUGH:
        return "warn", ": barely enough", wanted
    if episodes >= sizes[-1] and len(sizes) > 1 and means.max() - means[-2] > _ENOUGH:
        return "warn", ", and the curve still rises there", wanted
    return "pass", ": enough", ""


def _first_enough(sizes: Sequence[int], short: np.ndarray) -> int:
    """The smallest number of episodes from which on nothing falls short."""
    lacking = [size for size, gap in zip(sizes, short, strict=True) if gap > _ENOUGH]
    return min((size for size in sizes if size > max(lacking, default=0)), default=2 * sizes[-1])
