"""The kinds of failure, in words for readers; `rigid.report.failure_rules` tells them apart."""

from __future__ import annotations

from typing import Final, Literal, NamedTuple

Kind = Literal[
    "unwanted_contact", "out_of_reach", "spilled", "thrashing", "lost_contact", "wrong_limb",
    "missed_spot", "too_little", "stuck", "strayed", "kept_away", "unclear",
]  # fmt: skip


class Words(NamedTuple):
    """A kind for readers."""

    title: str
    meaning: str


_WORDS: Final[dict[Kind, Words]] = {
    "unwanted_contact": Words(
        "Unwanted contact", "The robot touched the person where nothing should."
    ),
    "out_of_reach": Words(
        "Out of the arm's reach",
        "For half of the time or more the {goal} was farther away than the arm is long.",
    ),
    "spilled": Words("The food falls", "So much food fell off that the rest could not help."),
    "thrashing": Words(
        "The robot swings about",
        "The tool went more than one and a half times as far as in canonical play.",
    ),
    "lost_contact": Words(
        "Lost the itch", "The robot began to scratch, and then lost the itch for good."
    ),
    "wrong_limb": Words(
        "Scratches another limb", "For a quarter of the time or more it touched the wrong limb."
    ),
    "missed_spot": Words(
        "Scratches beside the itch",
        "For a quarter of the time or more it touched the right limb, but not where it itched.",
    ),
    "too_little": Words(
        "On the itch, but too little",
        "It stayed at the itch, but too few contacts counted: they must move on and be gentle.",
    ),
    "stuck": Words(
        "The robot is stuck",
        "In the second half the tool hardly moved; the {goal} was within the arm's reach.",
    ),
    "strayed": Words(
        "The robot leaves", "The tool itself moved away; the {goal} was within the arm's reach."
    ),
    "kept_away": Words(
        "The {goal} is kept away",
        "For half of the time or more the {goal} was farther from the robot than canonical play "
        "ever brings it.",
    ),
    "unclear": Words("Unhelped for another reason", "None of the other rules holds."),
}  # fmt: skip
KINDS: Final = tuple(_WORDS)
"""In the order of the rules."""


def words(kind: Kind, goal: str) -> Words:
    """A kind in words, in a task whose tool is to reach `goal`.

    Example:
        >>> words("kept_away", "mouth").title
        'The mouth is kept away'
    """
    return Words(*(text.format(goal=goal) for text in _WORDS[kind]))
