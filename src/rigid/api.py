"""Measuring a robot from Python."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from rigid.compute.executors.executor import Executor, find_executor
from rigid.compute.listening import Listener
from rigid.compute.measurement import measure_robot
from rigid.compute.return_range import find_return_range
from rigid.compute.subject import Subject
from rigid.frontier.result import Frontier
from rigid.naturalness.choice import DEFAULT_MEASURE
from rigid.naturalness.features import DEFAULT
from rigid.policies.opening import SAFE, Opening
from rigid.presets import Preset, find_preset
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task


def measure(
    task: str | Task,
    robot: str,
    *,
    out: str | Path,
    preset: str | Preset = "standard",
    seeds: Sequence[int] | None = None,
    lambdas: Sequence[float] | None = None,
    memory: int = 1,
    search_measure: str = DEFAULT_MEASURE,
    features: str = DEFAULT,
    human: str = "builtin:synthetic-human",
    canonical: str | Path | None = None,
    return_range: str | Path | Sequence[float] | None = None,
    executor: str | Executor = "local",
    opening: Opening = SAFE,
    listener: Listener | None = None,
) -> Frontier:
    """Measures the natural-adversarial frontier of a robot.

    Args:
        task: A registered name, or a task.
        robot: `builtin:NAME` or a native policy directory.
        out: Run directory; an interrupted measurement in it is continued.
        preset: `demo`, `standard`, `paper`, or a `Preset` of your own.
        seeds: Search seeds instead of the preset's.
        lambdas: Exactly these λ, without refinement; 0 and ∞ are allowed.
        memory: Observations that an adversary acts on, the newest included.
        search_measure: What holds adversaries close: lsgan, paper_d2, kl, kl-gan, mmd, temporal or
            ensemble. The x axis is the referee's, whatever it is.
        features: What naturalness sees of the human, for search and referee alike: `default` (the
            task's own), `observation`, `observation+action`, or some of `task.feature_names`
            separated by commas.
        human: The synthetic human that the robot was trained for.
        canonical: A file of canonical episodes; by default the robot's own.
        return_range: Returns (worst, best) that map to adversarialness 1 and 0, or a file of `rigid
            calibrate`; by default the task's own.
        executor: Where the work is done: `local`, on this machine; `ray`, on the Ray that runs on
            this machine or else one that is started; `ray:HOST:PORT`, on a Ray cluster; or an
            `Executor`. The numbers are the same.
        opening: How files of other libraries are opened; the default trusts none.
        listener: Told of progress; by default a bar on standard error, if that is a terminal.
            `rigid.compute.listening.Silence()` keeps quiet.

    Raises:
        UserError: Bad input; the message names it and the cure, and nothing was overwritten.
    """
    played = make_task(task) if isinstance(task, str) else task
    subject = Subject(
        played,
        robot,
        human,
        None if canonical is None else str(canonical),
        features,
        opening,
        find_return_range(return_range, played),
    )
    chosen = find_preset(preset) if isinstance(preset, str) else preset
    with _heard(listener, f"{robot} · {chosen.name}") as hearing:
        return measure_robot(
            subject,
            chosen,
            out=Path(out),
            seeds=seeds,
            lambdas=lambdas,
            memory=memory,
            search_measure=search_measure,
            executor=find_executor(executor) if isinstance(executor, str) else executor,
            listener=hearing,
        )


@contextmanager
def _heard(listener: Listener | None, what: str) -> Iterator[Listener | None]:
    """Who is told of progress: the given one, else a bar where somebody can see it."""
    if listener is not None or not sys.stderr.isatty():
        yield listener
        return
    from rigid.commands.terminal.progress import TerminalListener

    with TerminalListener(what) as bar:
        yield bar
