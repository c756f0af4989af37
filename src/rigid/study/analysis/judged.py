"""Answers as arrays, with the place of what was judged on the frontier's axes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from rigid.data.pair_file import Pair
from rigid.study.records import Answer

Asked = Literal["correspondence", "danger", "naturalness"]
_SECOND = {"first": 0, "second": 1}


class Choices(NamedTuple):
    """Which of two was closer to the reference; arrays over answers."""

    chose_second: Float[np.ndarray, " n"]
    """1 where the pair's second member was chosen: the recorded one."""
    rater: Int[np.ndarray, " n"]
    pair: Int[np.ndarray, " n"]
    chose_left: Float[np.ndarray, " n"]
    """1 where what stood on the left was chosen, whichever that was."""


class Scores(NamedTuple):
    """A score on a scale, with where the judged member lies; arrays over judged members."""

    score: Float[np.ndarray, " n"]
    rater: Int[np.ndarray, " n"]
    pair: Int[np.ndarray, " n"]
    second: Int[np.ndarray, " n"]
    """1 for the second of the pair: the more adversarial (danger), the more natural one."""
    naturalness: Float[np.ndarray, " n"]
    """Of the member's human."""
    adversarialness: Float[np.ndarray, " n"]
    """Of its episode."""

    @property
    def member(self) -> Int[np.ndarray, " n"]:
        """A number for each member of each pair."""
        numbers: Int[np.ndarray, " n"] = 2 * self.pair + self.second
        return numbers

    def keep(self, which: np.ndarray) -> Scores:
        """Some of them."""
        return Scores(*(column[which] for column in self))


def choices_of(answers: Iterable[Answer]) -> Choices:
    """The answers that say which of two is closer to the reference; attention checks left out."""
    kept = [a for a in answers if a.question == "correspondence" and a.pair is not None]
    left = [(a.response == 1.0) == (a.shown_left == "second") for a in kept]
    return Choices(
        np.array([a.response for a in kept], dtype=float),
        numbered([a.participant for a in kept]),
        np.array([a.pair for a in kept], dtype=int),
        np.array(left, dtype=float),
    )


def scores_of(answers: Iterable[Answer], question: Asked, pairs: Sequence[Pair]) -> Scores:
    """The scores of one questionnaire.

    The danger of a member is the answer on danger minus the one on the goal, from -7 to 7 (paper,
    appendix 'Additional User Study': 'the score of the second question minus the score of the first
    question'). A member of which only one of the two was answered has none.

    Args:
        answers: Of any questions; only those of this one count, without attention checks.
        question: Which.
        pairs: What was shown.
    """
    given: dict[tuple[str, int, str], dict[str, float]] = {}
    for answer in answers:
        if answer.pair is None or answer.of not in _SECOND:
            continue
        key = (answer.participant, answer.pair, answer.of)
        given.setdefault(key, {})[answer.question] = answer.response
    rows = [
        (key, score) for key, said in given.items() if (score := _score(said, question)) is not None
    ]
    members = [getattr(pairs[pair], of) for (_, pair, of), _ in rows]
    return Scores(
        np.array([score for _, score in rows], dtype=float),
        numbered([rater for (rater, _, _), _ in rows]),
        np.array([pair for (_, pair, _), _ in rows], dtype=int),
        np.array([_SECOND[of] for (_, _, of), _ in rows], dtype=int),
        np.array([member.naturalness for member in members], dtype=float),
        np.array([member.adversarialness for member in members], dtype=float),
    )


def differences_of(
    scores: Scores,
) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """What each rater gave the second of a pair beyond the first, with rater and pair."""
    first = {(r, p): s for s, r, p, two in zip(*scores[:4], strict=True) if not two}
    rows = [
        (s - first[r, p], r, p)
        for s, r, p, two in zip(*scores[:4], strict=True) if two and (r, p) in first
    ]  # fmt: skip
    table = np.array(rows, dtype=float).reshape(-1, 3)
    return table[:, 0], table[:, 1].astype(int), table[:, 2].astype(int)


def numbered(names: Sequence[str]) -> Int[np.ndarray, " n"]:
    """A number for each name, in the order of the names."""
    places = {name: place for place, name in enumerate(sorted(set(names)))}
    return np.array([places[name] for name in names], dtype=int)


def _score(said: Mapping[str, float], question: Asked) -> float | None:
    if question == "danger":
        whole = "danger" in said and "goal" in said
        return said["danger"] - said["goal"] if whole else None
    return said.get(question)
