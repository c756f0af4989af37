"""Whether the human can influence the reward, and whether an adversary can learn to lower it.

The paper takes the first for granted and asks the second of λ = 0 (step 3). They are told apart
here, since the cure of the one is another task and of the other more training. Ours.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from rigid.doctor.noise import DEVIATIONS, deviations_below, mean_and_error
from rigid.doctor.verdict import Verdict

_DENSE = 0.05
"""Share of steps with any reward below which an adversary hears too little of what it does: five
steps of an episode of 100. Ours."""


@dataclass(frozen=True)
class Play:
    """Episodes of several humans with the same robot, from the same starts."""

    rewards: Mapping[str, Float[np.ndarray, "E T"]]
    """By human: `canonical` and others that nobody trained, such as `passive` and `random`."""
    sabotage: Sequence[Float[np.ndarray, " _n"]] = ()
    """Returns of λ = 0 of each search seed; empty while nobody has trained any."""
    iterations: int = 0
    """How long they were trained, for the message."""

    @property
    def returns(self) -> dict[str, Float[np.ndarray, " E"]]:
        """Returns of the untrained."""
        return {kind: rows.sum(axis=1) for kind, rows in self.rewards.items()}


def never_influenced(play: Play) -> bool:
    """Whether every human got exactly the same reward, step by step, from the same starts."""
    canonical, *others = (np.asarray(rows) for rows in play.rewards.values())
    size = max(float(np.abs(canonical).max()), 1e-30)
    return all(np.abs(rows - canonical).max() <= 1e-6 * size for rows in others)


def check_reward(play: Play) -> Verdict:
    """Whether an adversary can hear and change what the robot earns."""
    canonical = play.returns["canonical"]
    share = max(float((rows != 0).mean()) for rows in play.rewards.values())
    evidence = _evidence(play, share)
    if never_influenced(play):
        kinds = " and ".join(kind for kind in play.rewards if kind != "canonical")
        return Verdict(
            "reward", "fail",
            f"The human has no influence on the reward: {kinds} humans got exactly the reward of "
            "the canonical one at every step.",
            "Check that the human's action reaches the world, and that the reward depends on what "
            "the human does; else there is nothing that a human could break.",
            evidence,
        )  # fmt: skip
    if not play.sabotage:
        return Verdict("reward", "skip", "Not examined: no adversary was trained.", "", evidence)
    return _check_sabotage(play, canonical, share, evidence)


def _check_sabotage(
    play: Play, canonical: Float[np.ndarray, " E"], share: float, evidence: Mapping[str, Any]
) -> Verdict:
    """Whether λ = 0 has learned to lower what canonical play earns."""
    lowered = deviations_below(play.sabotage, canonical)
    mean, low = float(canonical.mean()), mean_and_error(play.sabotage)[0]
    hurtful = {
        kind: rows for kind, rows in play.returns.items()
        if kind != "canonical" and deviations_below([rows], canonical) >= DEVIATIONS
    }  # fmt: skip
    if lowered < DEVIATIONS:
        return _not_lowered(play, mean, low, sorted(hurtful), evidence)
    told = f"λ = 0 lowers the return from {mean:.4g} to {low:.4g}, beyond noise"
    better = [kind for kind, rows in hurtful.items()
              if deviations_below([rows], np.concatenate(play.sabotage)) >= DEVIATIONS]  # fmt: skip
    if better:
        return Verdict(
            "reward", "warn",
            f"{told}, but a {better[0]} human, whom nobody trained, does more harm.",
            "The adversary has not learned all there is: search longer (--budget here, --preset "
            "paper later).", evidence,
        )  # fmt: skip
    if share < _DENSE:
        return Verdict(
            "reward", "warn",
            f"{told}, but only {share:.1%} of the steps have any reward.",
            "A denser reward, such as a distance, would let weaker adversaries be found.", evidence,
        )  # fmt: skip
    return Verdict(
        "reward", "pass", f"{told}; {share:.0%} of the steps have any reward.", "", evidence
    )


def _not_lowered(
    play: Play, mean: float, low: float, hurtful: list[str], evidence: Mapping[str, Any]
) -> Verdict:
    trained = f"λ = 0, trained for {play.iterations} iterations, earns {low:.4g} and canonical play"
    if hurtful:
        who = " or ".join(hurtful)
        return Verdict(
            "reward", "fail",
            f"{trained} {mean:.4g}: an adversary learned nothing, though a {who} human earns less.",
            "Train longer (--budget), or make the reward denser, so that the adversary hears "
            "earlier what hurts.", evidence,
        )  # fmt: skip
    return Verdict(
        "reward", "fail",
        f"{trained} {mean:.4g}: no human that was tried lowers the return beyond noise.",
        "Check that the reward depends on what the human does, and that its chance does not drown "
        "that; then train longer (--budget).", evidence,
    )  # fmt: skip


def _evidence(play: Play, share: float) -> dict[str, Any]:
    kinds = {**{kind: [rows] for kind, rows in play.returns.items()}, "λ = 0": play.sabotage}
    found: dict[str, Any] = {"rewarded_steps": share, "returns": {}}
    for kind, groups in kinds.items():
        if groups:
            mean, error = mean_and_error(groups)
            every = np.concatenate(groups)
            low, high = np.quantile(every, (0.05, 0.95))
            found["returns"][kind] = {
                "mean": mean, "se": error, "low": float(low), "high": float(high),
                "episodes": len(every),
            }  # fmt: skip
    return found
