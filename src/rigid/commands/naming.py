"""Options by which a command is told a task and who plays it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.policies.opening import Opening
    from rigid.tasks.protocol import Task

_agent = tyro.conf.arg(metavar="AGENT")


@dataclass(frozen=True, kw_only=True)
class MeasuredTaskOptions:
    """The task of a run directory, where it is not RIGID's own."""

    task: Annotated[str | None, tyro.conf.arg(metavar="TASK")] = None
    """What was named when the run was measured; RIGID's own tasks need not be named."""
    human_agent: Annotated[str | None, _agent] = None
    """Agents of a PettingZoo environment that are the human, separated by commas."""
    robot_agent: Annotated[str | None, _agent] = None
    """Agents of a PettingZoo environment that are the robot; by default all others."""
    horizon: Annotated[int | None, tyro.conf.arg(metavar="STEPS")] = None
    """Steps of an episode of pettingzoo: and gymnasium: tasks; by default the environment's own."""

    def named_task(self) -> Task | None:
        """The task, if the user named one.

        Raises:
            UserError: There is none of this name, or it takes no such agents.
        """
        from rigid.tasks.registry import make_task, task_parameters

        if self.task is None:
            return None
        named = ("human_agent", "robot_agent", "horizon")
        given = {k: v for k in named if (v := getattr(self, k)) is not None}
        known = task_parameters(self.task)
        for name, value in given.items():
            if known is not None and name not in known:
                option = name.replace("_", "-")
                raise UserError(
                    f"--{option} {value}: {self.task} takes no {option}, leave the option out"
                )
        task = make_task(self.task, **given)
        if self.horizon is not None and task.return_range is not None:
            usual = make_task(self.task).horizon
            if self.horizon != usual:
                raise UserError(
                    f"--horizon {self.horizon}: an episode of {self.task} has {usual} steps, to "
                    "which its range of adversarialness belongs: leave the option out"
                )
        return task


@dataclass(frozen=True, kw_only=True)
class TaskOptions(MeasuredTaskOptions):
    """Which two-player task."""

    task: str = "itch-scratching"
    """Registered task, pettingzoo:MODULE:FACTORY, gymnasium:MODULE:FACTORY or exec:COMMAND."""

    def open_task(self) -> Task:
        """The task.

        Raises:
            UserError: There is none of this name, or it takes no such agents.
        """
        task = self.named_task()
        assert task is not None  # It always has a name.
        return task


@dataclass(frozen=True, kw_only=True)
class OpeningOptions:
    """How policies of other libraries are opened."""

    trust: bool = False
    """Open files that can run code (sb3, torchscript): only from people you trust."""
    vecnormalize: Annotated[Path | None, tyro.conf.arg(metavar="FILE")] = None
    """VecNormalize statistics that an sb3 robot was trained behind."""
    frames: int = 1
    """Observations that an sb3 robot sees at a time, as VecFrameStack stacked them."""

    def opening(self) -> Opening:
        """How the players' files are opened."""
        from rigid.policies.opening import Opening

        return Opening(trust=self.trust, vecnormalize=self.vecnormalize, frames=self.frames)


@dataclass(frozen=True, kw_only=True)
class PairOptions(OpeningOptions, TaskOptions):
    """Who plays it."""

    robot: str = "builtin:vanilla"
    """builtin:NAME, a native policy directory, FILE.onnx, sb3:FILE.zip, torchscript:FILE.pt,
    exec:COMMAND or python:MODULE:FACTORY."""
    human: str = "builtin:synthetic-human"
    """The synthetic human that the robot was trained for."""
