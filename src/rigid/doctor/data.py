"""Step 2 of the paper: how many canonical episodes it takes until a judge learns no more from them.

"One may steadily increase the size of the dataset, and visualize the Naturalness measure on OOD
data."
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rigid.doctor.verdict import Verdict

FEWEST = 12
"""Episodes below which no referee is trained on people (`compute.canonical.FEWEST`)."""
_ENOUGH, _TOLERABLE = 0.03, 0.06
"""Shortfall of the share that a judge tells right, against that with the most episodes. Ours: itch
scratching falls short by 0.01 at the paper's 40 episodes, by 0.06 at 12 and by 0.25 at 3."""


def check_data(episodes: int, accuracy: Mapping[int, Sequence[float]], *, source: str) -> Verdict:
    """Whether a judge of canonical motion learns enough from the canonical episodes there are.

    Args:
        episodes: How many there are.
        accuracy: For each number of episodes the shares of held-out steps, canonical and not, that
            judges trained with so many tell right, one for each repetition; may be empty.
        source: `synthetic` or `recorded`.
    """
    evidence = {
        "episodes": episodes,
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
    enough = _first_enough(sizes, short)
    mine = float(np.interp(np.log(episodes), np.log(sizes), short))
    evidence |= {"shortfall": mine, "enough": enough}
    told = (
        f"With {episodes} canonical episodes a judge tells {means.max() - mine:.0%} of held-out "
        f"steps right, with {sizes[-1]} it tells {means[-1]:.0%}"
    )
    wanted = f"about {max(enough, 2 * episodes)} may be enough"
    if episodes < FEWEST or mine > _TOLERABLE:
        wanted = f"about {max(enough, FEWEST)} would be enough"
        return Verdict("data", "fail", f"{told}: too few.", f"{more}: {wanted}.", evidence)
    if mine > _ENOUGH:
        return Verdict("data", "warn", f"{told}: barely enough.", f"{more}: {wanted}.", evidence)
    if episodes >= sizes[-1] and len(sizes) > 1 and short[-2] > _ENOUGH:
        return Verdict(
            "data", "warn", f"{told}, and the curve still rises there.", f"{more}: {wanted}.",
            evidence,
        )  # fmt: skip
    return Verdict("data", "pass", f"{told}: enough.", "", evidence)


def _first_enough(sizes: Sequence[int], short: np.ndarray) -> int:
    """The smallest number of episodes from which on nothing falls short."""
    lacking = [size for size, gap in zip(sizes, short, strict=True) if gap > _ENOUGH]
    return min((size for size in sizes if size > max(lacking, default=0)), default=2 * sizes[-1])
