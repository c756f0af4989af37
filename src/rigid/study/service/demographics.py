"""What participants are asked about themselves, each question free to skip.

What reports of human-robot interaction are asked to tell of their participants: age, gender (with
words of one's own), and what bears on this study: handedness, experience, limits of the arm.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

QUESTIONS: Final[tuple[Mapping[str, Any], ...]] = (
    {"id": "age", "number": {"min": 18, "max": 120}},
    {"id": "gender", "options": ["woman", "man", "non-binary", "self-described", "undisclosed"]},
    {"id": "gender_description", "text": {"max": 100}},
    {"id": "handedness", "options": ["right", "left", "both"]},
    {"id": "robot_experience", "scale": {"min": 1, "max": 7}},
    {"id": "vr_experience", "scale": {"min": 1, "max": 7}},
    {"id": "limited_arm", "options": ["yes", "no", "undisclosed"]},
)
"""Ids and values; their words are in `rigid/study/texts/`. Adults only: consent is theirs."""


def demographics_problem(answers: Mapping[str, Any]) -> str | None:
    """What is wrong with answers, in words; None where all is well. Those left out are skipped.

    Example:
        >>> demographics_problem({"age": 34, "handedness": "left"})
        >>> demographics_problem({"age": 12})
        'age must be a whole number from 18 to 120'
        >>> demographics_problem({"shoe_size": 43})
        'shoe_size is no question'
    """
    known = {question["id"]: question for question in QUESTIONS}
    for name, value in answers.items():
        if name not in known:
            return f"{name} is no question"
        problem = _problem(known[name], value)
        if value is not None and problem is not None:
            return f"{name} must be {problem}"
    return None


def _problem(question: Mapping[str, Any], value: object) -> str | None:
    """What a value should be instead, None where it is that."""
    if "options" in question:
        return None if value in question["options"] else "one of " + ", ".join(question["options"])
    if "text" in question:
        longest = question["text"]["max"]
        fits = isinstance(value, str) and len(value) <= longest
        return None if fits else f"a text of at most {longest} characters"
    ends = question["number"] if "number" in question else question["scale"]
    number = value if isinstance(value, int | float) and not isinstance(value, bool) else math.nan
    fits = ends["min"] <= number <= ends["max"] and number == int(number)
    return None if fits else f"a whole number from {ends['min']} to {ends['max']}"
