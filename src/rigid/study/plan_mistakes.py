"""Mistakes in a study file, in words: the line, the field, the bad value, what may stand there."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import BaseModel

from rigid.study.plan import (
    Completion,
    Consent,
    JudgeStage,
    PlayStage,
    PractiseStage,
    Role,
    StudyPlan,
    WatchStage,
)

CURE = "docs/study.md shows every field"

Place = tuple[str | int, ...]
"""Where in the file: names of fields and places in lists."""
_Mistake = Mapping[str, Any]
"""One of `pydantic.ValidationError.errors()`."""


def dotted(place: Place) -> str:
    r"""As people name a field.

    Example:
        >>> dotted(("roles", "novice", "stages", 1, "kind"))
        'roles.novice.stages[1].kind'
    """
    parts = (f"[{part}]" if isinstance(part, int) else f".{part}" for part in place)
    return "".join(parts).removeprefix(".")


def mistakes(errors: Iterable[_Mistake], lines: Mapping[Place, int], where: str) -> str:
    """What pydantic found, as one message.

    Args:
        errors: Of pydantic.
        lines: Of each entry of the file.
        where: Whose text it is.
    """
    found = sorted({_mistake(error, lines) for error in errors})
    told = [f"line {line}: {text}" if line else text for line, text in found]
    if len(told) == 1:
        return f"{where}: {told[0]}"
    return "\n".join([f"{where} has {len(told)} mistakes:", *(f"  {text}" for text in told)])


def _mistake(error: _Mistake, lines: Mapping[Place, int]) -> tuple[int, str]:
    """Line (0: none) and text of what pydantic found."""
    place = _place(error["loc"])
    name = dotted(place) or "the file"
    line = lines.get(place, 0)
    if error["type"] == "missing":
        cure = _EXAMPLES.get(str(place[-1]), f"{place[-1]}: …")
        return line or lines.get(place[:-1], 0), f"{name} is missing: write {cure}"
    if error["type"] == "extra_forbidden":
        known = _known_beside(error["loc"])
        close = difflib.get_close_matches(str(place[-1]), known, n=1)
        hint = f", did you mean {close[0]!r}?" if close else ";"
        return line, f"{name} is unknown{hint} there may stand {', '.join(known)}"
    return line, f"{name}: {_of_a_value(error)}"


_EXAMPLES = {
    "title": "title: Scratching an itch with a robot",
    "robots": 'robots: {a: "builtin:vanilla"}',
    "roles": "roles: with a role below it, such as novice",
    "participants": "participants: 8",
    "stages": "stages: with an entry for each below it, such as - {kind: watch, episodes: 3}",
    "question": "question: correspondence, danger or naturalness",
    "pairs": "pairs: FILE, one of `rigid pairs`",
}
"""What to write where something is missing."""

_STAGES: Mapping[str, type[BaseModel]] = {
    "watch": WatchStage,
    "practise": PractiseStage,
    "play": PlayStage,
    "judge": JudgeStage,
}


def _place(location: Place) -> Place:
    """Where pydantic means; after a stage's number it also names its kind."""
    place = tuple(part for part in location if part != "[key]")
    return place[:4] + place[5:] if place[2:3] == ("stages",) else place


def _known_beside(location: Place) -> list[str]:
    """The fields that may stand where an unknown one does."""
    model: type[BaseModel]
    match location:
        case ("consent", _):
            model = Consent
        case ("completion", _):
            model = Completion
        case ("roles", _, _):
            model = Role
        case ("roles", _, "stages", _, str(kind), _):
            model = _STAGES[kind]
        case _:
            model = StudyPlan
    return [name for name, field in model.model_fields.items() if not field.exclude]


_WANTED = {
    "bool_type": "must be true or false",
    "dict_type": "must hold fields, each on a line of its own",
    "int_from_float": "must be a whole number",
    "int_type": "must be a whole number",
    "mapping_type": "must hold fields, each on a line of its own",
    "model_attributes_type": "must hold fields, each on a line of its own",
    "model_type": "must hold fields, each on a line of its own",
    "path_type": "must be the path of a file",
    "string_too_short": "must not be empty",
    "string_type": "must be text: put it in quotes",
    "too_short": "must not be empty",
    "tuple_type": "must be a list: begin each entry with a dash",
}


def _of_a_value(error: _Mistake) -> str:
    value = error["input"]
    shown = f"{value!r} " if isinstance(value, str | int | float | bool) else ""
    match error["type"], error.get("ctx", {}):
        case "union_tag_not_found", _:
            return "kind is missing: write kind: watch, practise, play or judge"
        case "union_tag_invalid", {"tag": tag, "expected_tags": tags}:
            said = f"kind {tag!r} is unknown: write {_or(tags)}"
        case "literal_error", {"expected": words}:
            said = f"{shown}is unknown: write {_or(words)}"
        case "string_pattern_mismatch", {"pattern": pattern}:
            said = f"{shown}{_form(pattern)}"
        case "greater_than", {"gt": limit}:
            said = f"{shown}must be more than {limit}"
        case "greater_than_equal", {"ge": limit}:
            said = f"{shown}must be at least {limit}"
        case kind, _ if kind in _WANTED:
            said = shown + _WANTED[kind]
        case _:
            said = f"{shown}does not fit ({error['msg']}): {CURE}"
    return said


def _form(pattern: str) -> str:
    if pattern.startswith("^https?"):
        return "must be an address, such as https://example.org/done"
    if "2,3" in pattern:
        return "must be a language, such as en"
    return "must be a name of small letters, digits and dashes, such as novice or a"


def _or(expected: str) -> str:
    return expected.replace("'", "").replace(" or ", ", ")
