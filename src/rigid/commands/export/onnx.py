"""`rigid export --onnx`: a native policy as a file that every library runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from rigid.errors import UserError

if TYPE_CHECKING:
    from rigid.policies.native import StoredPolicy
    from rigid.tasks.protocol import Task

_ITCH = "itch-scratching"


def write_onnx(
    spec: str, path: Path, *, task: str | None, agent: Literal["robot", "human"] | None
) -> None:
    """Writes a native policy to `path`, and says what it holds.

    Args:
        spec: `builtin:NAME` or a native policy directory.
        path: Its folder exists.
        task: Registered task; None takes what the policy was trained for, if that is RIGID's own.
        agent: Whose policy it is; None takes what its directory says.

    Raises:
        UserError: There is no such policy or task, or it is none that RIGID can write.
    """
    from importlib.util import find_spec

    from rigid.files import write_atomically, writing_to
    from rigid.policies.onnx_export import to_onnx

    if find_spec("onnx") is None:
        raise UserError("--onnx needs onnx: pip install 'rigid-frontier[onnx]'")
    stored, trained_for = _stored(spec, task, agent)
    policy, card = stored
    data = to_onnx(stored, trained_for.robot if card.agent == "robot" else trained_for.human)
    with writing_to(path, "--onnx"):
        write_atomically(path, data)
    memory = f", memory {policy.memory}" if policy.memory > 1 else ""
    print(
        f"{spec}, {card.agent} of {trained_for.name}: {policy.observation_size} observations, "
        f"{policy.action_size} actions{memory}: {path}"
    )


def _stored(
    spec: str, name: str | None, agent: Literal["robot", "human"] | None
) -> tuple[StoredPolicy, Task]:
    """The policy with its card, and the task that it was trained for."""
    from rigid.policies.loading import load_policy, native_directory
    from rigid.policies.native import load_card, load_native
    from rigid.tasks.registry import make_task, task_from_description

    if spec.startswith("builtin:"):
        task = make_task(name or _ITCH)
        whose = agent or ("human" if spec in _names(task, "human") else "robot")
    else:
        card = load_card(spec)
        known = make_task(name) if name else task_from_description(card.task)
        if known is None:
            raise UserError(
                f"{spec} was trained for {card.task.get('name')!r}, which is none of RIGID's own "
                "tasks: name it with --task"
            )
        task, whose = known, agent or card.agent
    load_policy(spec, task=task, agent=whose)  # Says what does not fit.
    with native_directory(spec, task) as directory:
        if directory is None:
            raise UserError(f"{spec} is made in memory and has no weights: only policies on disk")
        return load_native(directory), task


def _names(task: Task, agent: Literal["robot", "human"]) -> list[str]:
    from rigid.policies.loading import builtin_names

    return [f"builtin:{name}" for name in builtin_names(task, agent)]
