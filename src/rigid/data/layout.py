"""Which columns of a recording are what a task knows: features, observations, actions.

A feature's column has the feature's name. An observation's is `observation_I` or
`observation_NAME`; one that shares its name with no feature goes by the name alone. An action's is
`action_I`, and a discrete one holds the number of its choice.
"""

from __future__ import annotations

import difflib
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from rigid.errors import UserError
from rigid.tasks.protocol import Task

VELOCITY = "_velocity"
"""A feature NAME_velocity is the rate of change of the feature NAME, as itch scratching names its
own; no other feature is ever taken for one."""
OBSERVATION, ACTION = "observation_", "action_"
REWARD, SUCCESS, RETURN, SEED = "reward", "success", "return", "seed"
TEXTS = ("participant", "device", "robot", "notes")
"""Columns of text, as `EpisodeNote` has them."""
RESERVED = frozenset({"episode", "time", "step", REWARD, SUCCESS, RETURN, SEED, *TEXTS})
"""Never the name of an observation alone."""


class Source(NamedTuple):
    """What a number of the task is made from."""

    column: str
    rate: bool = False
    """Whether it is the column's rate of change."""


@dataclass(frozen=True)
class Layout:
    """The columns that make an episode; None where the recording lacks some."""

    features: tuple[Source, ...]
    observations: tuple[Source, ...] | None
    actions: tuple[Source, ...] | None
    choices: tuple[int, ...] = ()
    """Of discrete actions that are given as numbers of choices."""
    rewarded: bool = False

    @property
    def computed(self) -> tuple[str, ...]:
        """Columns whose rate of change had to be computed."""
        return tuple(source.column for source in self.features if source.rate)

    @property
    def columns(self) -> tuple[str, ...]:
        """Every column that is needed at every step."""
        parts = (self.features, self.observations or (), self.actions or ())
        return tuple(dict.fromkeys(source.column for part in parts for source in part))


def find_layout(
    names: Collection[str], task: Task, *, sampled: bool, offered: Collection[str], where: str
) -> Layout:
    """Finds the columns of a task.

    Args:
        names: Columns that every table of the recording has.
        task: Whose human was recorded.
        sampled: Whether rows are samples in time: then a feature and an observation of the same
            name are the same signal. Where rows are control steps they are not, since an
            observation is before the step and a feature after it.
        offered: Everything that the recording has, to be listed when something is missing.
        where: The recording; begins every message.

    Raises:
        UserError: Features are missing, or some observations or actions are and others are not.
    """
    own = task.feature_names
    features = tuple(_feature(name, names, own, offered, where) for name in own)
    named = task.human.observation_names
    spoken = [
        [f"{OBSERVATION}{index}", *_by_name(named, index, RESERVED.union(() if sampled else own))]
        for index in range(task.human.observation_size)
    ]
    observations = _all_or_none(spoken, names, "observations", where)
    actions, choices = _actions(names, task, where)
    if not own and (observations is None or actions is None):
        raise UserError(
            f"{where} lacks observations or actions, but task {task.name!r} declares no features, "
            f"so that they are what naturalness sees: give columns {OBSERVATION}0, … and {ACTION}0…"
        )
    return Layout(features, observations, actions, choices, REWARD in names)


def _by_name(named: tuple[str, ...], index: int, shadowed: frozenset[str]) -> list[str]:
    if not named:
        return []
    alone = [] if named[index] in shadowed else [named[index]]
    return [f"{OBSERVATION}{named[index]}", *alone]


def _feature(
    name: str, names: Collection[str], own: tuple[str, ...], offered: Collection[str], where: str
) -> Source:
    if name in names:
        return Source(name)
    position = name.removesuffix(VELOCITY)
    if position != name and position in own and position in names:
        return Source(position, rate=True)
    missing = [n for n in own if n not in names and n.removesuffix(VELOCITY) not in names]
    close = difflib.get_close_matches(name, offered, n=1)
    hint = f" (is it {close[0]!r}?)" if close else ""
    raise UserError(
        f"{where} has no column {name!r}{hint}; missing are {', '.join(missing)}; it has "
        f"{', '.join(sorted(offered))}: rename columns with --map"
    )


def _actions(
    names: Collection[str], task: Task, where: str
) -> tuple[tuple[Source, ...] | None, tuple[int, ...]]:
    choices, size = task.human.choices, task.human.action_size
    scores = [[f"{ACTION}{index}"] for index in range(size)]
    as_numbers = [[f"{ACTION}{index}"] for index in range(len(choices))]
    if "action" in names:
        scores = [["action"]] if size == 1 else scores
        as_numbers = [["action"]] if len(choices) == 1 else as_numbers
    given = sum(name.startswith(ACTION) and name[len(ACTION) :].isdigit() for name in names)
    if choices and given <= len(choices):
        return _all_or_none(as_numbers, names, "actions", where), choices
    return _all_or_none(scores, names, "actions", where), ()


def _all_or_none(
    spoken: list[list[str]], names: Collection[str], what: str, where: str
) -> tuple[Source, ...] | None:
    found = [next((name for name in known if name in names), None) for known in spoken]
    # A name alone is no sign that somebody recorded it as an observation: features may share it.
    meant = any(name is not None and name.startswith((OBSERVATION, "action")) for name in found)
    missing = [known[-1] for known, name in zip(spoken, found, strict=True) if name is None]
    if missing and meant:
        raise UserError(
            f"{where} holds only some {what}; missing are {', '.join(missing)}: give all of them "
            "or none"
        )
    if missing or not found:
        return None
    return tuple(Source(name) for name in found if name is not None)


def units_of(task_units: Mapping[str, str], said: Mapping[str, str], where: str) -> dict[str, str]:
    """The units of features: the task's, and for others what the map says.

    Raises:
        UserError: The map says something else than the task.
    """
    for name, unit in said.items():
        if task_units.get(name, unit) != unit:
            raise UserError(
                f"{where}: {name} is measured in {unit}, but the task wants {task_units[name]}: "
                "name another column in --map"
            )
    return {**said, **task_units}
