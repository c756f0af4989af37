"""The unit of work: the adversaries of one seed and one round, from training to scored points.

A group's numbers depend on its inputs alone, never on where or when it runs or how often it was
interrupted: randomness comes from (seed, round, iteration), and the width of every batch is fixed.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rigid.compute.referee.files import save_panel
from rigid.compute.run.checkpoint import load_tree, save_arrays, save_tree
from rigid.compute.search.convergence import convergence
from rigid.compute.search.group_plan import (
    GroupInputs,
    GroupPlan,
    checkpoint_of,
    scoring_steps,
    search_of,
    training_steps,
)
from rigid.compute.search.scoring import Court, Judged, Scored, judge, score
from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically
from rigid.learning.adversary import Adversary, Metrics
from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.native import save_policy
from rigid.tasks.views.watched import WatchedWorld, watched

Row = dict[str, Any]
"""A line of `metrics.jsonl`: iteration, and numbers or None."""

CHECKPOINT_EVERY = 10
"""Iterations between checkpoints: at most about 10 s of work is lost on two cores."""


def run_group(
    inputs: GroupInputs, plan: GroupPlan, *, advance: Callable[[int], None] = lambda _: None
) -> list[dict[str, Any]]:
    """Trains and scores a group, or reads it when it is already done.

    Args:
        inputs: What all groups share.
        plan: Which adversaries these are.
        advance: Called with environment steps as they are done, scoring included.

    Returns:
        One entry of `frontier.json`'s points for each λ, in the order of the plan.
    """
    finished = read_finished(inputs.directory, plan)
    if finished is not None:
        return finished
    steps = training_steps(inputs, plan)
    group, history = train_group(inputs, plan, advance)
    points = []
    scored, judged = _score_group(inputs, plan, group, advance)
    for index, (point, episodes) in enumerate(scored):
        name = plan.member(index)
        points.append({
            "id": name,
            "seed": plan.seed,
            "round": plan.round,
            "lambda": json_lambda(plan.lambdas[index]),
            # Adversaries of one network share its steps.
            "env_steps": steps // len(group) + (index < steps % len(group)),
            **convergence(history[index]),
            **point,
        })  # fmt: skip
        save_panel(
            inputs.directory / "referee", name, judged[index].panel, inputs.task.feature_names
        )
        save_arrays(inputs.directory / "adversaries" / name / "episodes.npz", episodes)
    done = _done(inputs.directory, plan)
    done.parent.mkdir(exist_ok=True)
    write_atomically(done, json_text({"points": points}, indent=1).encode())
    checkpoint_of(inputs.directory, plan).unlink(missing_ok=True)
    return points


def _score_group(
    inputs: GroupInputs,
    plan: GroupPlan,
    group: Sequence[Adversary],
    advance: Callable[[int], None],
) -> tuple[list[Scored], list[Judged]]:
    """What is measured of each adversary, and by which referees.

    Half of the steps is told as they are played, half as referees are trained, which takes longer.
    """
    every = left = scoring_steps(inputs, plan)

    def tell(env_steps: int) -> None:
        nonlocal left
        left -= env_steps
        advance(env_steps)

    court = Court(
        watched(inputs.task, lambda played: tell(played // 2)),
        inputs.opponent, inputs.ruler, inputs.preset, inputs.settings, inputs.threads,
    )  # fmt: skip
    judged = judge(
        court, [adversary.learner.policy for adversary in group], plan.entropy,
        each=lambda: tell(every // (2 * len(group))),
    )  # fmt: skip
    scored = score(court, group, judged, plan.entropy)
    advance(left)
    return scored, judged


def json_lambda(lambda_: float) -> float | str:
    """λ for JSON, which knows no infinity."""
    return "inf" if np.isinf(lambda_) else lambda_


def read_finished(directory: Path, plan: GroupPlan) -> list[dict[str, Any]] | None:
    """The points of a group that a run directory holds; None for one that is not done.

    Raises:
        UserError: Its file is damaged, or of other adversaries.
    """
    path, cure = _done(directory, plan), "delete it to train its group again"
    if not path.exists():
        return None
    try:
        points: list[dict[str, Any]] = json.loads(read_bytes(path, cure=cure))["points"]
        found = [point["id"] for point in points]
    except (ValueError, KeyError, TypeError) as error:
        raise UserError(f"{path} is damaged ({error}): {cure}") from None
    wanted = [plan.member(index) for index in range(len(plan.lambdas))]
    if found != wanted:
        raise UserError(f"{path} holds the points {found}, not {wanted}: {cure}")
    return points


def _done(directory: Path, plan: GroupPlan) -> Path:
    """Exists when the group is done, and only then."""
    return directory / "groups" / f"{plan.name}.json"


def train_group(
    inputs: GroupInputs, plan: GroupPlan, advance: Callable[[int], None] = lambda _: None
) -> tuple[list[Adversary], list[list[Row]]]:
    """Trains a group, or goes on from its checkpoint, which stays; its policies are stored.

    Returns:
        The adversaries, and what each iteration saw of each of them.
    """
    search = search_of(inputs, plan)
    state = search.start()
    history: list[list[Row]] = [[] for _ in plan.lambdas]
    checkpoint = checkpoint_of(inputs.directory, plan)
    if checkpoint.exists():
        state = load_tree(checkpoint, state)
        count = search.iteration(state)
        history = [
            _read_metrics(inputs, plan.member(i), count, checkpoint) for i in range(len(history))
        ]
    batch = search.blocks * inputs.preset.episodes
    world = WatchedWorld(inputs.task.make_world(batch, threads=inputs.threads), advance)
    for iteration in range(search.iteration(state), inputs.preset.iterations):
        state, metrics = search.iterate(world, state)
        for rows, seen in zip(history, metrics, strict=True):
            rows.append(_metrics_row(iteration, seen))
        world.tell_all()
        last = iteration + 1 == inputs.preset.iterations
        if last or (iteration + 1) % CHECKPOINT_EVERY == 0:
            _save(inputs, plan, search.adversaries(state), history)
            save_tree(checkpoint, state)
    return search.adversaries(state), history


def _save(
    inputs: GroupInputs,
    plan: GroupPlan,
    group: Sequence[Adversary],
    history: Sequence[list[Row]],
) -> None:
    for index, (adversary, rows) in enumerate(zip(group, history, strict=True)):
        directory = inputs.directory / "adversaries" / plan.member(index)
        directory.mkdir(parents=True, exist_ok=True)
        save_policy(
            GaussianPolicy(adversary.learner.policy, memory=inputs.settings.memory),
            directory,
            agent="human",
            task=inputs.task.describe(),
            provenance={"lambda": json_lambda(plan.lambdas[index]), "seed": plan.seed,
                        "round": plan.round, "iterations": int(adversary.iteration)},
        )  # fmt: skip
        kept = inputs.settings.search_measure.kept(adversary.measure)
        save_tree(directory / "discriminator.safetensors", kept)
        text = "".join(json.dumps(row) + "\n" for row in rows)
        write_atomically(directory / "metrics.jsonl", text.encode())
    (inputs.directory / "groups").mkdir(exist_ok=True)


def _metrics_row(iteration: int, metrics: Metrics) -> Row:
    """One line of `metrics.jsonl`; unknown values, such as a success nobody defines, are null."""
    health = metrics.health._asdict()
    flat = {**metrics._asdict(), **health}
    del flat["health"]
    numbers = {name: float(value) for name, value in flat.items()}
    known = {name: None if math.isnan(value) else value for name, value in numbers.items()}
    return {"iteration": iteration, **known}


def _read_metrics(inputs: GroupInputs, name: str, count: int, checkpoint: Path) -> list[Row]:
    """The first `count` rows; a run that was killed may have written more than its checkpoint."""
    path = inputs.directory / "adversaries" / name / "metrics.jsonl"
    cure = f"delete {checkpoint} to train from the start of its group"
    try:
        rows = [json.loads(line) for line in read_bytes(path, cure=cure).splitlines()]
    except ValueError as error:
        raise UserError(f"{path} is damaged ({error}): {cure}") from None
    if len(rows) < count:
        raise UserError(f"{path} is damaged ({len(rows)} of {count} iterations): {cure}")
    return rows[:count]
