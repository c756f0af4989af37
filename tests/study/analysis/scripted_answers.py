"""Answers of known law, which an analysis has to find again."""

from __future__ import annotations

from itertools import product

import numpy as np

from rigid.data.pair_file import FoundMember, Pair, PairFile, PairRule, Reference, RunSource
from rigid.study.records import Answer

SHARE, ALPHA = 0.65, 0.0
"""Of `halves`: half prefer with 0.8, the others with 0.5; no pair has more of it than another."""


def answer(rater, pair, response, question="correspondence", of="both", **changes) -> Answer:
    fields = {
        "participant": f"S{rater:02}", "stage": 0, "trial": f"t{pair or 0:02}",
        "question": question, "pair": pair, "shown_left": "first", "position": pair or 0, "of": of,
        "response": float(response), "rt": 2.0, "passed": None,
        "answered": "2026-01-05T10:00:00+00:00",
    }  # fmt: skip
    return Answer(**fields | changes)


def check(rater, *, passed) -> Answer:
    """The answer to an attention check."""
    return answer(rater, None, 1.0, trial="t99", passed=passed)


def halves(raters=16, pairs=30, *, seed=0) -> list[Answer]:
    """Half of the raters choose the recorded one with probability 0.8, the others with 0.5."""
    rng = np.random.default_rng(seed)
    law = np.where(np.arange(raters) < raters // 2, 0.8, 0.5)
    return chosen(rng.uniform(size=(raters, pairs)) < law[:, None], rng)


def agreeing(raters=10, pairs=60, accuracy=0.8, *, seed=0) -> list[Answer]:
    """Every pair has a right answer, either one as often, which each rater gives independently.

    Two raters differ with probability 2q(1-q) and two answers at random with 1/2, so that
    Krippendorff's alpha is (2q - 1)² for many pairs.
    """
    rng = np.random.default_rng(seed)
    right = np.arange(pairs) % 2 == 0
    correct = rng.uniform(size=(raters, pairs)) < accuracy
    return chosen(np.where(correct, right, ~right), rng)


def chosen(second, rng) -> list[Answer]:
    """A table of choices, raters by pairs; sides are drawn."""
    sides = rng.choice(["first", "second"], size=second.shape)
    return [
        answer(rater, pair, second[rater, pair], shown_left=str(sides[rater, pair]))
        for rater, pair in product(*map(range, second.shape))
    ]


def made_pairs(count, *, kind="danger", seed=0) -> tuple[Pair, ...]:
    """Pairs as the rules of the appendix want them, of no run that exists."""
    rng = np.random.default_rng(seed)
    pairs = []
    for number in range(count):
        alike, low = rng.uniform(0.1, 0.8), rng.uniform(0, 0.3)
        both = np.array([[alike, low], [alike + 0.05, low + rng.uniform(0.35, 0.65)]])
        if kind == "naturalness":
            both = both[:, ::-1]
        first, second = (_member(number, place, *x_y) for place, x_y in enumerate(both.tolist()))
        reference = Reference(point="s0-r1-l1", shown="worst", seed=number)
        pairs.append(Pair(run=0, first=first, second=second, reference=reference))
    return tuple(pairs)


def pair_file(pairs, kind="danger") -> PairFile:
    """A file of them."""
    rule = PairRule(
        alike="naturalness", alike_below=0.1, different=None, different_above=0.3,
        recorded_with_found=False, same_start=True, reuse=False, snapshot="none",
    )  # fmt: skip
    hashes = {"s0-r1-l1": "0" * 64}
    run = RunSource(path="run", robot="a", robot_sha256="0" * 64, episodes_sha256=hashes)
    return PairFile(
        kind=kind, rule=rule, seed=0, eligible=len(pairs), task={}, runs=(run,), recordings=(),
        pairs=pairs,
    )  # fmt: skip


def danger_scores(pairs, raters=5, *, slope=4.0, deviations=(0.8, 0.5, 0.5), seed=0):
    """Danger rises with adversarialness alone, by `slope` log-odds over the axis.

    Raters, pairs and episodes differ with these deviations. The score, danger minus goal, is cut
    into both answers.
    """
    rng = np.random.default_rng(seed)
    of_rater = rng.normal(0, deviations[0], raters)
    of_pair = rng.normal(0, deviations[1], len(pairs))
    answers = []
    of_episode = rng.normal(0, deviations[2], (len(pairs), 2))
    for (number, pair), (place, of) in product(enumerate(pairs), enumerate(("first", "second"))):
        level = slope * (getattr(pair, of).adversarialness - 0.4) + of_pair[number]
        for rater in range(raters):
            latent = level + of_rater[rater] + of_episode[number, place] + rng.logistic()
            score = int(np.searchsorted(np.linspace(-4, 4, 14), latent)) - 7
            danger, goal = max(score, 0), max(-score, 0)
            common = {"rater": rater, "pair": number, "of": of}
            answers.append(answer(response=danger, question="danger", **common))
            answers.append(answer(response=goal, question="goal", **common))
    return answers


def _member(number, place, x, y) -> FoundMember:
    return FoundMember(
        point="s0-r1-l1", shown="worst", episode=2 * number + place, seed=number, naturalness=x,
        naturalness_se=0.01, adversarialness=y, snapshot=3, snapshot_by="deviation",
    )  # fmt: skip
