"""From what a user writes after `--robot` or `--human` to a policy that fits the task."""

from __future__ import annotations

import difflib
import hashlib
from dataclasses import asdict
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

from rigid.errors import UserError
from rigid.files import json_text
from rigid.policies.architecture import NativePolicy, architecture_of, weights_of
from rigid.policies.native import (
    CARD_FILE,
    Agent,
    hash_weights,
    load_card,
    load_native,
)
from rigid.policies.passive import PassivePolicy
from rigid.policies.protocol import Policy
from rigid.tasks.protocol import AgentSpec, BringsPolicies, Task

BUNDLED: Traversable = resources.files("rigid") / "bundled"
"""Where the policies that ship with RIGID live: `<task name>/<policy name>/`."""

_BUILTIN = "builtin:"
_PASSIVE = "passive"
_KINDS = f"{_BUILTIN}NAME or a native policy directory ({CARD_FILE} beside its weights)"


def load_policy(spec: str, *, task: Task, agent: Agent) -> Policy:
    """The policy that `spec` names, for `agent` of `task`.

    Args:
        spec: `builtin:NAME` or a native policy directory.
        task: The task it has to fit.
        agent: Whom it acts for.

    Raises:
        UserError: There is no such policy, its files are damaged, it acts for the other agent, was
            trained for another task, or sees or does another number of things than `task` asks for.
    """
    policy: Policy
    if spec == f"{_BUILTIN}{_PASSIVE}" and agent == "human":
        policy = PassivePolicy(task.human.observation_size, task.human.action_size)
    elif spec.startswith(_BUILTIN):
        policy = _load_builtin(spec.removeprefix(_BUILTIN), task, agent)
    elif Path(spec).is_dir():
        policy = _load_directory(Path(spec), spec, task, agent)
    else:
        raise UserError(f"{agent} {spec!r} {_why_unknown(spec, task, agent)}")
    check_sizes(policy, spec, task=task, agent=agent)
    return policy


def builtin_names(task: Task, agent: Agent) -> tuple[str, ...]:
    """Names that `builtin:` takes for `agent` of `task`, sorted."""
    names = {_PASSIVE} if agent == "human" else set()
    if isinstance(task, BringsPolicies):
        names |= set(task.builtin_policies(agent))
    folder = BUNDLED / task.name
    for entry in folder.iterdir() if folder.is_dir() else ():
        if (entry / CARD_FILE).is_file():
            with resources.as_file(entry) as directory:
                if load_card(directory).agent == agent:
                    names.add(entry.name)
    return tuple(sorted(names))


def check_sizes(policy: Policy, name: str, *, task: Task, agent: Agent) -> None:
    """Refuses a policy that sees or does another number of things than the task asks for.

    Raises:
        UserError: The message begins with `agent` and `name`, and states both shapes.
    """
    wanted: AgentSpec = getattr(task, agent)
    found = (policy.observation_size, policy.action_size)
    if found != (wanted.observation_size, wanted.action_size):
        raise UserError(
            f"{agent} {name!r} maps {found[0]} observations to {found[1]} actions, but the {agent} "
            f"of {task.name!r} maps {wanted.observation_size} to {wanted.action_size}: "
            "choose a policy of this task"
        )


def policy_hash(policy: Policy | Path | str) -> str:
    """SHA-256 over the weights and architecture of a policy or a native policy directory.

    Part of 'same settings': equal hashes act alike, wherever they lie and whoever trained them.

    Raises:
        TypeError: The policy has no weights that could be hashed.
    """
    if isinstance(policy, PassivePolicy):
        sizes = json_text({"kind": _PASSIVE, **asdict(policy)})
        return hashlib.sha256(sizes.encode()).hexdigest()
    stored = load_native(policy).policy if isinstance(policy, Path | str) else policy
    if not isinstance(stored, NativePolicy):
        raise TypeError(f"a {type(stored).__name__} has no weights to hash")
    return hash_weights(architecture_of(stored), weights_of(stored))


def _load_builtin(name: str, task: Task, agent: Agent) -> Policy:
    names = builtin_names(task, agent)
    if name not in names:
        listed = ", ".join(_BUILTIN + known for known in names) or "none"
        raise UserError(
            f"{agent} '{_BUILTIN}{name}' is unknown for task {task.name!r}"
            f"{_suggestion(name, names)}; builtin {agent}s: {listed}"
        )
    brought = task.builtin_policies(agent) if isinstance(task, BringsPolicies) else {}
    if name in brought:
        return brought[name]
    with resources.as_file(BUNDLED / task.name / name) as directory:
        return _load_directory(directory, _BUILTIN + name, task, agent)


def _load_directory(directory: Path, spec: str, task: Task, agent: Agent) -> NativePolicy:
    policy, card = load_native(directory)
    if card.agent != agent:
        raise UserError(f"{agent} {spec!r} is a policy of the {card.agent}: choose a {agent}'s")
    trained_for = card.task.get("name")
    if trained_for != task.name:
        raise UserError(
            f"{agent} {spec!r} was trained for task {trained_for!r}, not {task.name!r}: "
            "choose a policy of this task"
        )
    return policy


def _why_unknown(spec: str, task: Task, agent: Agent) -> str:
    names = builtin_names(task, agent)
    kind, colon, _ = spec.partition(":")
    if colon or spec.endswith(".onnx"):
        return f"is of kind {kind if colon else 'onnx'!r}, but this version takes {_KINDS}"
    if spec in names:
        return f"is no directory; did you mean '{_BUILTIN}{spec}'?"
    return f"is no directory: give {_KINDS}"


def _suggestion(name: str, names: tuple[str, ...]) -> str:
    close = difflib.get_close_matches(name, names, n=1)
    return f"; did you mean '{_BUILTIN}{close[0]}'?" if close else ""
