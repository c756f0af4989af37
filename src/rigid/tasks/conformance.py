"""Whether a task keeps what `rigid.tasks.protocol` promises; for authors of tasks and `doctor`.

It plays a few short episodes, so that it is quick, and shows nothing of what a task is good for.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import cloudpickle
import numpy as np

from rigid.errors import UserError
from rigid.tasks.protocol import AgentSpec, Step, Summary, Task, World

STEPS = 100
"""Steps that are played of a longer episode. Ours: one episode of itch scratching."""
_BATCH = 3
_MEMBERS = (*Task.__annotations__, "make_world", "features", "scene", "replay", "describe")
_COMPARED = 10
"""Steps over which two plays of an episode must agree: physics that is begun again may differ in
its last digits, and chaos makes much of them. Ours."""
_ALIKE = 1e-3
"""Largest difference of numbers that count as the same, absolute or relative. Ours."""


def check_task(task: Any) -> None:
    """Plays a task a little and looks for broken promises.

    Args:
        task: What should be a `rigid.tasks.protocol.Task`.

    Raises:
        UserError: It breaks some; the message lists them.

    Example:
        >>> from rigid.tasks.registry import make_task
        >>> check_task(make_task("analytic/offset-catch"))
    """
    found = broken_promises(task)
    if found:
        listed = "\n".join(f"  - {line}" for line in found)
        raise UserError(f"task {getattr(task, 'name', task)!r} breaks its promises:\n{listed}")


def broken_promises(task: Any) -> tuple[str, ...]:
    """What `check_task` says, a sentence each; nothing for a sound task.

    Raises:
        UserError: The task itself fails.
    """
    found = tuple(_of_form(task))
    if found:  # Nothing else could be trusted.
        return found
    return tuple(dict.fromkeys([
        *_of_play(task), *_of_seeds(task), *_of_actions(task), *_of_copies(task),
    ]))  # fmt: skip


def _of_form(task: Any) -> Iterator[str]:
    """What stands still."""
    lacking = [name for name in _MEMBERS if not hasattr(task, name)]
    if lacking:
        yield f"a {type(task).__name__} lacks {', '.join(sorted(lacking))}"
        return
    if task.horizon < 1:
        yield f"horizon is {task.horizon}, but an episode has at least 1 step"
    for agent, spec in (("robot", task.robot), ("human", task.human)):
        yield from _of_spec(agent, spec)
    names = task.feature_names
    if len(set(names)) != len(names) or any("," in name for name in names):
        yield f"feature_names must be distinct and without commas, got {names}"
    if not task.outcome_names:
        yield "outcome_names is empty"
    ends = task.return_range
    if ends is not None and not (np.isfinite(ends).all() and ends[0] < ends[1]):
        yield f"return_range must be (worst, best) with worst < best, or None, got {ends}"
    try:
        described = json.loads(json.dumps(dict(task.describe()), allow_nan=False))
    except (TypeError, ValueError) as error:
        yield f"describe() is no JSON: {error}"
        return
    if described.get("name") != task.name:
        yield f"describe() has name {described.get('name')!r}, but the task is {task.name!r}"


def _of_spec(agent: str, spec: AgentSpec) -> Iterator[str]:
    if spec.observation_size < 1 or spec.action_size < 1:
        sizes = f"sees {spec.observation_size} numbers and does {spec.action_size}"
        yield f"{agent} {sizes}, but must have 1 of each at least"
    names = spec.observation_names
    if names and len(names) != spec.observation_size:
        yield f"{agent}: {len(names)} observation_names for {spec.observation_size} numbers"
    if spec.choices and sum(spec.choices) != spec.action_size:
        yield f"{agent}: choices {spec.choices} do not add up to action_size {spec.action_size}"


def _of_play(task: Task) -> Iterator[str]:
    """Shapes, kinds and ranges, over an episode."""
    world = task.make_world(_BATCH, threads=1)
    if world.batch != _BATCH:
        yield f"make_world({_BATCH}) has batch {world.batch}"
    step = world.reset(np.arange(_BATCH))
    yield from _of_step(task, step, "after a reset")
    if np.any(step.reward != 0):
        yield "reward is not 0 after a reset"
    names: set[str] | None = None  # A reset may measure nothing yet.
    for actions in _drawn(task, min(task.horizon, STEPS)):
        step = world.step(*actions)
        yield from _of_step(task, step, "after a step")
        names = set(step.info) if names is None else names
        if set(step.info) != names:
            yield f"info changes its names: {', '.join(sorted(names ^ set(step.info)))}"
    yield from _of_summary(task, world.summary())
    snapshot = world.snapshot()
    if snapshot.ndim != 2 or len(snapshot) != _BATCH:
        yield f"snapshot has shape {snapshot.shape}, but must have ({_BATCH}, columns)"
    elif snapshot.shape[1] and not task.replay(np.stack([snapshot[0], snapshot[0]])):
        yield "snapshots have columns, but replay shows nothing"


def _of_step(task: Task, step: Step, when: str) -> Iterator[str]:
    sizes: dict[str, tuple[int, ...]] = {
        "robot_observation": (_BATCH, task.robot.observation_size),
        "human_observation": (_BATCH, task.human.observation_size),
        "reward": (_BATCH,),
        "faulted": (_BATCH,),
        **{f"info {name!r}": (_BATCH,) for name in step.info},
    }
    found = {**step._asdict(), **{f"info {name!r}": v for name, v in step.info.items()}}
    features = task.features(step)
    if task.feature_names:
        sizes["features"] = (_BATCH, len(task.feature_names))
        found["features"] = features
    for name, shape in sizes.items():
        if np.shape(found[name]) != shape:
            yield f"{name} has shape {np.shape(found[name])} {when}, but must have {shape}"
    for name in ("robot_observation", "human_observation", "reward", "features"):
        if not np.isfinite(found[name]).all():
            yield f"{name} is not finite {when}; a world that runs away sets faulted instead"


def _of_summary(task: Task, summary: Summary) -> Iterator[str]:
    for name, values in summary._asdict().items():
        for key, column in values.items() if isinstance(values, Mapping) else [(name, values)]:
            if np.shape(column) != (_BATCH,):
                yield f"summary: {key} has shape {np.shape(column)}, but must have ({_BATCH},)"
    if not np.isin(summary.success[~np.isnan(summary.success)], (0, 1)).all():
        yield f"summary: success must be 0, 1 or NaN, got {summary.success}"
    outcomes = len(task.outcome_names)
    if np.any(summary.outcome < 0) or np.any(summary.outcome >= outcomes):
        yield f"summary: outcome {summary.outcome} is no index into {outcomes} outcome_names"
    for name in ("peak_force", "impulse"):
        if np.any(getattr(summary, name) < 0):
            yield f"summary: {name} is negative"


def _of_seeds(task: Task) -> Iterator[str]:
    """The same seed, the same episode: begun again, elsewhere, and in another process' copy."""
    count = min(task.horizon, _COMPARED)
    actions = list(_drawn(task, count))
    world, seeds = task.make_world(_BATCH, threads=1), np.array([5, 7, 11])
    first = _played(world, seeds, actions)
    yield from _differences(first, _played(world, seeds, actions), "begun again in the same world")
    turned = [(robot[::-1], human[::-1]) for robot, human in actions]
    other = _played(task.make_world(_BATCH, threads=1), seeds[::-1], turned)
    backwards = [_rows(step, slice(None, None, -1)) for step in other]
    yield from _differences(first, backwards, "played in another place of another world")
    try:
        copy: Task = cloudpickle.loads(cloudpickle.dumps(task))
    except Exception as error:  # noqa: BLE001 - The task may raise anything.
        yield f"cannot be sent to other processes: cloudpickle fails: {error}"
        return
    again = _played(copy.make_world(_BATCH, threads=1), seeds, actions)
    yield from _differences(first, again, "played by a copy that cloudpickle made")


def _of_actions(task: Task) -> Iterator[str]:
    """Only what actions mean may count: their part in [-1, 1], or which score is the largest."""
    world, seeds = task.make_world(_BATCH, threads=1), np.arange(_BATCH)
    actions = list(_drawn(task, 1))
    clear = [_pressed(task, actions[0], 1.0)]
    beyond = [_pressed(task, actions[0], 3.0)]
    said = "actions beyond [-1, 1], which must be clipped"
    yield from _differences(_played(world, seeds, clear), _played(world, seeds, beyond), said)


def _pressed(task: Task, actions: tuple[np.ndarray, np.ndarray], size: float) -> tuple[Any, Any]:
    """Actions at their bounds or as far beyond them; scores keep their order."""
    specs = (task.robot, task.human)
    return tuple(
        size * (action if spec.choices else np.sign(action))
        for spec, action in zip(specs, actions, strict=True)
    )  # type: ignore[return-value]  # There are two of them.


def _of_copies(task: Task) -> Iterator[str]:
    """What a step holds stays as it is: learning keeps the arrays of a whole episode."""
    world = task.make_world(_BATCH, threads=1)
    step = world.reset(np.arange(_BATCH))
    before = _rows(step)
    for actions in _drawn(task, min(task.horizon, 2)):
        world.step(*actions)
    for name in ("robot_observation", "human_observation", "reward", "features"):
        if not np.array_equal(getattr(step, name), getattr(before, name)):
            yield f"{name} of an earlier step changes with the next one: return copies"


def _played(
    world: World, seeds: np.ndarray, actions: list[tuple[np.ndarray, np.ndarray]]
) -> list[Step]:
    steps = [_rows(world.reset(seeds))]
    for pair in actions:
        steps.append(_rows(world.step(*pair)))
    return steps


def _rows(step: Step, which: slice = slice(None)) -> Step:
    """A copy of some rows, without info."""

    def rows(array: np.ndarray) -> np.ndarray:
        return np.array(array[which])

    return Step(
        rows(step.robot_observation), rows(step.human_observation), rows(step.reward),
        rows(step.features), rows(step.faulted), {},
    )  # fmt: skip


def _differences(first: list[Step], other: list[Step], how: str) -> Iterator[str]:
    for number, (one, two) in enumerate(zip(first, other, strict=True)):
        for name in ("robot_observation", "human_observation", "reward", "features"):
            pair = getattr(one, name), getattr(two, name)
            if not np.allclose(*pair, rtol=_ALIKE, atol=_ALIKE):
                yield f"{name} of step {number} depends on more than seed and actions: {how}"
                return


def _drawn(task: Task, count: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Random actions of both players, always the same."""
    draw: Callable[..., Any] = np.random.default_rng(0).uniform
    for _ in range(count):
        yield (
            draw(-1, 1, (_BATCH, task.robot.action_size)),
            draw(-1, 1, (_BATCH, task.human.action_size)),
        )
