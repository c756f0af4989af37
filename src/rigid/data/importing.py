"""From takes to canonical episodes: the good ones on control steps, and a verdict on every one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from rigid.data.about import About
from rigid.data.column_map import ColumnMap
from rigid.data.episodes import CanonicalEpisodes, Source
from rigid.data.judging import Verdict, judge_steps, judge_take
from rigid.data.layout import (
    ACTION,
    OBSERVATION,
    RESERVED,
    RETURN,
    REWARD,
    SEED,
    SUCCESS,
    Layout,
    find_layout,
    units_of,
)
from rigid.data.resampling import Steps, are_labels, resample, take_steps
from rigid.data.takes import Recording, Take
from rigid.errors import UserError
from rigid.tasks.protocol import BoundedTask, NamesUnits, Task, control_period


class Imported(NamedTuple):
    """What came of a recording."""

    episodes: CanonicalEpisodes | None
    """None where no episode is left."""
    verdicts: tuple[Verdict, ...]
    """One for each take, in their order."""
    computed: tuple[str, ...]
    """Positions whose velocities had to be computed."""


def wanted_columns(task: Task) -> frozenset[str]:
    """Every column of numbers that a recording of a task may have."""
    human = task.human
    names = {*task.feature_names, *(set(human.observation_names) - RESERVED)}
    names |= {f"{OBSERVATION}{name}" for name in human.observation_names}
    names |= {f"{OBSERVATION}{index}" for index in range(human.observation_size)}
    names |= {"action", *(f"{ACTION}{index}" for index in range(human.action_size))}
    return frozenset(names | {REWARD, SUCCESS, RETURN, SEED})


def feature_limits(task: Task) -> Mapping[str, tuple[float, float]]:
    """The range of each feature that the human observes as well, where the task gives bounds."""
    if not isinstance(task, BoundedTask):
        return {}
    bounds = dict(zip(task.human.observation_names, task.bounds("human"), strict=False))
    return {
        name: (float(bounds[name][0]), float(bounds[name][1]))
        for name in task.feature_names
        if name in bounds
    }


def import_recording(
    recording: Recording,
    task: Task,
    *,
    map_: ColumnMap,
    about: About,
    source: Source = "recorded",
    robot: str | None = None,
    provenance: Mapping[str, Any] | None = None,
) -> Imported:
    """Makes canonical episodes of a recording.

    Args:
        recording: Its takes.
        task: The one that its episodes are meant for.
        map_: Says units of columns.
        about: Consent, licence and what else is told of the whole.
        source: Whether the human was a policy or a person.
        robot: Keep only episodes with the robot that the recording calls so.
        provenance: Where it comes from; `seeds` is added.

    Raises:
        UserError: Columns are missing, or people met several robots and nobody said which counts.
    """
    where, steps, period = recording.where, task.horizon, control_period(task)
    layout = find_layout(
        recording.columns, task,
        sampled=recording.sampled, offered=recording.offered, where=where,
    )  # fmt: skip
    _check_robots(recording, robot)
    judged = [
        judge_take(take, layout, steps=steps, period=period, sampled=recording.sampled, robot=robot)
        for take in recording.takes
    ]
    sound = [number for number, verdict in enumerate(judged) if verdict.used]
    takes = [recording.takes[number] for number in sound]
    made = _on_steps(takes, layout, task, sampled=recording.sampled)
    side_by_side = judge_steps(
        [judged[number] for number in sound], made, task, feature_limits(task)
    )
    for number, verdict in zip(sound, side_by_side, strict=True):
        judged[number] = verdict
    kept = [place for place, verdict in enumerate(side_by_side) if verdict.used]
    if not kept:
        return Imported(None, tuple(judged), layout.computed)
    used = [takes[place] for place in kept]
    cut = frozenset(verdict.episode for verdict in side_by_side if verdict.remark)
    joined = _joined(used, [made[place] for place in kept], layout, task, cut)
    told = replace(
        joined, source=source, about=_told(about, recording, map_, used, task),
        provenance={**(provenance or {}), **joined.provenance},
    )  # fmt: skip
    return Imported(told, tuple(judged), layout.computed)


def _check_robots(recording: Recording, robot: str | None) -> None:
    met = sorted({text for take in recording.takes for text in take.texts.get("robot", ())} - {""})
    if robot is not None and robot not in met:
        raise UserError(
            f"{recording.where} holds no episode with robot {robot!r}, but with "
            f"{', '.join(repr(name) for name in met) or 'robots without a name'}: "
            f"{f'choose it, as with --met {met[0]}' if met else 'leave --met out'}"
        )
    if len(met) > 1 and robot is None:
        raise UserError(
            f"{recording.where} holds episodes with {len(met)} robots "
            f"({', '.join(repr(name) for name in met)}), but canonical episodes are of one: "
            f"choose it, as with --met {met[0]}"
        )


def _on_steps(takes: Sequence[Take], layout: Layout, task: Task, *, sampled: bool) -> list[Steps]:
    steps, period = task.horizon, control_period(task)
    if not sampled:
        made = [take_steps(take, layout, steps=steps, period=period) for take in takes]
    else:
        labels = frozenset(
            name for name in layout.columns if are_labels([take.signals[name] for take in takes])
        )
        made = [resample(take, layout, steps=steps, period=period, labels=labels) for take in takes]
    return [_scored(each, layout) for each in made]


def _scored(steps: Steps, layout: Layout) -> Steps:
    """Numbers of discrete choices as the scores that tasks take."""
    if not layout.choices or steps.actions is None:
        return steps
    from rigid.policies.discrete import scores_of

    return steps._replace(actions=scores_of(steps.actions.astype(np.int64), layout.choices))


def _joined(
    takes: Sequence[Take],
    steps: Sequence[Steps],
    layout: Layout,
    task: Task,
    cut: frozenset[str],
) -> CanonicalEpisodes:
    """The episodes side by side; `cut` are those of which a part was left out."""

    def stacked(name: str) -> np.ndarray | None:
        parts = [getattr(each, name) for each in steps]
        return None if parts[0] is None else np.stack(parts).astype(np.float32)

    rewards = stacked("rewards") if layout.rewarded else None
    if rewards is not None and not np.isfinite(rewards).all():
        rewards = None
    seeds = [take.ends.get(SEED, np.nan) for take in takes]
    known = bool(np.isfinite(seeds).all())
    features = stacked("features")
    assert features is not None  # Every layout has them.
    return CanonicalEpisodes(
        features=features, observations=stacked("observations"), actions=stacked("actions"),
        seeds=np.array(seeds if known else np.arange(len(takes)), dtype=np.int64),
        returns=np.array([_return(*pair, cut) for pair in zip(takes, steps, strict=True)],
                         dtype=np.float32),
        success=np.array([_told_of_whole(take, SUCCESS, cut) for take in takes], dtype=np.float32),
        task=task.describe(), feature_names=tuple(task.feature_names), source="recorded",
        provenance={"seeds": "recorded" if known else "numbered"},
        control_period=control_period(task), rewards=rewards,
        times=np.stack([each.times for each in steps]),
    )  # fmt: skip


def _return(take: Take, steps: Steps, cut: frozenset[str]) -> float:
    """Of the steps that are kept; NaN where nobody knows."""
    told = _told_of_whole(take, RETURN, cut)
    if np.isfinite(told) or steps.rewards is None:
        return told
    return float(steps.rewards.sum())


def _told_of_whole(take: Take, name: str, cut: frozenset[str]) -> float:
    """What was told of a whole episode; of a part of it that says nothing, so NaN."""
    return np.nan if take.name in cut else take.ends.get(name, np.nan)


def _told(
    about: About, recording: Recording, map_: ColumnMap, takes: Sequence[Take], task: Task
) -> About:
    said = {
        name: column.measured_in
        for name, column in map_.items()
        if column.measured_in is not None and name in task.feature_names
    }
    own = task.feature_units if isinstance(task, NamesUnits) else {}
    rates = [1 / np.median(np.diff(take.clock)) for take in takes if len(take.clock) > 1]
    return about.model_copy(update={
        "units": units_of(own, said, recording.where),
        "recorded_rate": round(float(np.median(rates)), 3) if recording.sampled and rates else None,
        "episodes": tuple(take.note() for take in takes),
    })  # fmt: skip
