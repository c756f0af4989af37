"""`rigid pairs`: from runs and recordings to a file of pairs that a study can show."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Int

from rigid.compute.pairs.members import Candidate, MeasuredRun
from rigid.compute.pairs.moments import moment, people_in, rule_text
from rigid.compute.pairs.pool import Pool, fill_pool, read_runs
from rigid.compute.pairs.recordings import Say, read_recordings
from rigid.compute.run.directory import RunDirectory
from rigid.data.pair_file import (
    FoundMember,
    Pair,
    PairFile,
    PairRule,
    RecordedMember,
    RecordingSource,
    RunSource,
    file_hash,
    relative_to,
)
from rigid.errors import UserError
from rigid.frontier.pairs import (
    RULES,
    Candidates,
    Kind,
    draw_pairs,
    eligible_pairs,
    strata,
)
from rigid.tasks.protocol import Task

Places = list[tuple[int, int]]
Track = Callable[[Places], Iterable[tuple[int, int]]]


@dataclass(frozen=True, kw_only=True)
class PairOrder:
    """What to pick, from what."""

    runs: tuple[Path, ...]
    recordings: tuple[Path, ...] = ()
    kind: Kind
    count: int = 30
    """Paper, appendix 'Additional User Study …'."""
    seed: int = 0
    reuse: bool = False
    """Whether an episode may be in several pairs."""
    any_start: bool = False
    """Whether the humans of a pair may start from different things."""
    robot: str | None = None
    """Where the measured robot is now, if it moved."""


def pick_pairs(
    order: PairOrder, out: Path, *, say: Say = lambda _: None, track: Track = iter
) -> PairFile:
    """Picks pairs; equal sources and seeds give equal pairs, however the sources are named.

    Args:
        order: What to pick.
        out: Where the file will lie, since it names its sources from there. Not written.
        say: Told of progress.
        track: Goes through the pairs while their moments are chosen.

    Raises:
        UserError: A source is not what it has to be, or there are fewer pairs than asked for.
    """
    rule = RULES[order.kind]
    if rule.recorded_with_found and not order.recordings:
        raise UserError(
            f"{order.kind} pairs show recorded episodes beside those of adversaries: name files of "
            "recorded episodes with --recordings"
        )
    runs = read_runs(order.runs)
    task = runs[0].task
    people_in(task)  # Refuses a task without a picture before any work.
    recordings = read_recordings(order.recordings, task)
    pool = fill_pool(runs, recordings, robot=order.robot, say=say)
    eligible, drawn = _draw(order, pool.columns, any_start=order.any_start)
    if len(drawn) < order.count:
        raise UserError(_too_few(order, pool.columns, len(eligible), len(drawn)))
    say(f"{len(eligible)} pairs are eligible; choosing the moments of {len(drawn)}")
    pairs = tuple(_finished(pool, task, order.kind, track([(i, j) for i, j in drawn.tolist()])))
    return PairFile(
        kind=order.kind,
        rule=PairRule(
            **asdict(rule), same_start=not order.any_start, reuse=order.reuse,
            snapshot=rule_text(order.kind),
        ),
        seed=order.seed,
        eligible=len(eligible),
        task=dict(task.describe()),
        runs=tuple(_run_source(number, run, pairs, out) for number, run in enumerate(runs)),
        recordings=tuple(
            RecordingSource(path=relative_to(path, out), sha256=key, source=episodes.source)
            for path, key, episodes in recordings
        ),
        pairs=pairs,
    )  # fmt: skip


def _draw(
    order: PairOrder, columns: Candidates, *, any_start: bool
) -> tuple[Int[np.ndarray, "p 2"], Int[np.ndarray, "k 2"]]:
    """The eligible pairs, and those of them that were drawn, as places among the candidates."""
    if any_start:
        columns = columns._replace(start=np.zeros_like(columns.start))
    rule = RULES[order.kind]
    pairs = eligible_pairs(columns, rule)
    drawn = draw_pairs(
        columns.episode[pairs], strata(columns, pairs, rule), order.count,
        seed=order.seed, reuse=order.reuse,
    )  # fmt: skip
    return pairs, pairs[drawn]


def _finished(
    pool: Pool, task: Task, kind: Kind, drawn: Iterable[tuple[int, int]]
) -> Iterable[Pair]:
    """The pairs that were drawn, with reference and moments."""
    people, columns = people_in(task), pool.columns

    @cache  # References serve many pairs.
    def companion(run: int, number: int) -> Mapping[str, Any]:
        return task.replay(pool.companions[run].each[number].states)

    for places in drawn:
        members = [pool.candidates[place] for place in places]
        run, start = int(columns.run[places[0]]), int(columns.start[places[0]])
        seeds = [candidate.member.seed for candidate in members]
        number = pool.companions[run].reference(start=start, shown=seeds)
        first, second = (
            _still(candidate, task, companion(run, number), people, kind) for candidate in members
        )
        reference = pool.companions[run].each[number].reference
        yield Pair(run=run, first=first, second=second, reference=reference)


def _still(
    candidate: Candidate,
    task: Task,
    reference: Mapping[str, Any],
    people: frozenset[int],
    kind: Kind,
) -> FoundMember | RecordedMember:
    """A member of a pair with its moment."""
    step, by = moment(task.replay(candidate.states), reference, people, kind)
    return candidate.member.model_copy(update={"snapshot": step, "snapshot_by": by})


def _run_source(number: int, run: MeasuredRun, pairs: Sequence[Pair], out: Path) -> RunSource:
    """A run as the file names it, with the hashes of what its pairs need."""
    mine = [pair for pair in pairs if pair.run == number]
    members = [member for pair in mine for member in (pair.first, pair.second)]
    points = {pair.reference.point for pair in mine}
    points |= {member.point for member in members if isinstance(member, FoundMember)}
    place = RunDirectory(run.directory)
    return RunSource(
        path=relative_to(run.directory, out),
        robot=str(run.frontier.data["robot"]),
        robot_sha256=run.identity["robot"],
        episodes_sha256={
            point: file_hash(place.adversary(point) / "episodes.npz") for point in sorted(points)
        },
    )


def _too_few(order: PairOrder, columns: Candidates, eligible: int, drawn: int) -> str:
    """How many pairs there are, and what would bring more."""
    episodes = len(set(columns.episode.tolist()))
    cures = []
    if drawn:
        cures.append(f"take these with --count {drawn}")
    if not order.reuse and eligible > drawn:
        cures.append(f"show episodes again with --reuse ({min(eligible, order.count)} pairs)")
    if not order.any_start:
        more = len(_draw(order, columns, any_start=True)[1])
        if more > drawn:
            cures.append(f"pair humans of different starts with --any-start ({more} pairs)")
    cures.append("name more runs or recordings, or add search seeds with `rigid frontier --seeds`")
    return (
        f"{drawn} of {order.count} {order.kind} pairs could be picked: {episodes} episodes of "
        f"{len(order.runs)} run(s) and {len(order.recordings)} recording(s) make {eligible} "
        f"eligible pairs ({described(order.kind)}); {', or '.join(cures)}"
    )


def described(kind: Kind) -> str:
    """What makes a pair of this kind, in words.

    Example:
        >>> described("danger")
        'naturalness differs by less than 0.1, adversarialness by more than 0.3'
    """
    rule = RULES[kind]
    words = f"{rule.alike} differs by less than {rule.alike_below}"
    if rule.different is not None:
        words += f", {rule.different} by more than {rule.different_above}"
    return words + (", one of the two recorded" if rule.recorded_with_found else "")
