"""Whether all parts, wherever they were measured, are of one study."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from benchmarks.robots import OWN_HUMAN
from benchmarks.standard.making import Workplace
from benchmarks.standard.plan import Part, Robot
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.errors import UserError
from rigid.files import first_difference
from rigid.policies.loading import load_policy, policy_hash

_OF_A_PRESET = ("preset", "adversary")
"""Entries of a run's identity in which both presets may differ."""
_ASKED, _MADE = "the study asks for", "other parts of the robot with"


def check_parts(place: Workplace) -> None:
    """Refuses parts of another plan, and robots whose parts differ in more than seed and preset.

    Args:
        place: Its robots are made. Parts that are kept are looked at, and those under way.

    Raises:
        UserError: The message names the first difference.
    """
    human = policy_hash(load_policy(OWN_HUMAN, task=place.task, agent="human"))
    for robot in place.plan.robots:
        first: dict[str, Mapping[str, Any]] = {}
        for part, directory in _begun(place, robot):
            stored = read_settings(RunDirectory(directory))
            identity = stored["identity"]
            asked = {
                "preset": _budget(place, part.preset), "robot": _hash(place, robot),
                "human": human, "task": dict(place.task.describe()), "seeds": [part.seed],
            }  # fmt: skip
            _refuse_other(directory, asked, identity | {"seeds": stored["seeds"]}, _ASKED)
            _refuse_other(directory, first.setdefault(part.preset, identity), identity, _MADE)
            others = _shared(next(iter(first.values())))
            _refuse_other(directory, others, _shared(identity), _MADE)


def makers(place: Workplace) -> Counter[str]:
    """With what the parts that are kept were made, in words, and how many with each."""
    return Counter(
        _maker(read_settings(RunDirectory(place.kept(part)))["provenance"])
        for part in place.kept_parts()
    )


def _begun(place: Workplace, robot: Robot) -> Iterator[tuple[Part, Path]]:
    """Parts of a robot that are kept, then those under way, and where their settings are."""
    for part in place.kept_parts():
        if part.robot == robot:
            yield part, place.kept(part)
    for part in place.missing():
        if part.robot == robot and RunDirectory(place.raw(part)).settings.exists():
            yield part, place.raw(part)


def _budget(place: Workplace, preset: str) -> dict[str, Any]:
    budget = place.plan.presets()[preset].describe()
    return {key: value for key, value in budget.items() if key != "seeds"}


def _hash(place: Workplace, robot: Robot) -> str:
    return policy_hash(load_policy(place.spec(robot), task=place.task, agent="robot"))


def _shared(identity: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in identity.items() if key not in _OF_A_PRESET}


def _refuse_other(
    directory: Path, wanted: Mapping[str, Any], found: Mapping[str, Any], why: str
) -> None:
    different = first_difference(wanted, found)
    if different is not None:
        name, mine, theirs = different
        raise UserError(
            f"{directory} was made with {name} {theirs}, but {why} {mine}: "
            "delete it, or choose other places with --out and --results"
        )


def _maker(provenance: Mapping[str, Any]) -> str:
    """Who made a measurement; it comes from a file, so that anything may be missing."""
    commit = provenance.get("git_commit")
    libraries = [f"{name} {version}" for name, version in sorted(provenance["versions"].items())]
    words = [
        f"RIGID {provenance.get('rigid')}" + (f" ({commit[:9]})" if commit else ""),
        *libraries, str(provenance.get("machine")),
    ]  # fmt: skip
    return ", ".join(words)
