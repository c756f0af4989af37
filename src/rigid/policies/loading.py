"""From what a user writes after `--robot` or `--human` to a policy that fits the task."""

from __future__ import annotations

import difflib
import hashlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, replace
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import NamedTuple

from rigid.errors import UserError
from rigid.files import json_text, lies_there
from rigid.policies.architecture import NativePolicy, architecture_of, weights_of
from rigid.policies.foreign import Wanted, check_made_for
from rigid.policies.native import (
    CARD_FILE,
    Agent,
    hash_weights,
    load_card,
    load_native,
)
from rigid.policies.opening import SAFE, Opening
from rigid.policies.passive import PassivePolicy
from rigid.policies.protocol import Fingerprinted, Policy
from rigid.tasks.protocol import AgentSpec, BringsPolicies, Task

BUNDLED: Traversable = resources.files("rigid") / "bundled"
"""Where the policies that ship with RIGID live: `<task name>/<policy name>/`."""

_BUILTIN = "builtin:"
_PASSIVE = "passive"
_ONNX = ".onnx"
_Open = Callable[[str, Wanted, Opening], Policy]
"""From what follows the colon to a policy."""


class _Kind(NamedTuple):
    """Policies of one sort, as users name them."""

    form: str
    open: _Open
    runs_code: bool
    """Whether the name alone makes something run, so that no file may choose it."""


def load_policy(
    spec: str, *, task: Task, agent: Agent = "robot", opening: Opening = SAFE
) -> Policy:
    """The policy that `spec` names, for `agent` of `task`.

    Args:
        spec: `builtin:NAME`, a native policy directory, `FILE.onnx`, `sb3:FILE.zip`,
            `torchscript:FILE.pt`, `exec:COMMAND` or `python:MODULE:FACTORY` (docs/policies.md).
        task: The task it has to fit.
        agent: Whom it acts for.
        opening: How files of other libraries are opened; its normaliser and frames are the robot's.

    Raises:
        UserError: There is no such policy, its files are damaged or may run code and are not
            trusted, it acts for the other agent, was trained for another task, or sees or does
            another number of things than `task` asks for.
    """
    wanted = Wanted(spec, agent, task)
    if agent == "human":
        opening = replace(opening, vecnormalize=None, frames=1)
    if agent == "robot" and not spec.startswith("sb3:"):
        _check_unused(opening, wanted)
    policy = _open(wanted, opening)
    check_sizes(policy, spec, task=task, agent=agent)
    return policy


def _open(wanted: Wanted, opening: Opening) -> Policy:
    spec, task, agent = wanted.spec, wanted.task, wanted.agent
    if spec == f"{_BUILTIN}{_PASSIVE}" and agent == "human":
        return PassivePolicy(task.human.observation_size, task.human.action_size)
    if spec.startswith(_BUILTIN):
        return _load_builtin(spec.removeprefix(_BUILTIN), task, agent)
    kind, colon, place = spec.partition(":")
    if not colon or kind not in _KINDS:  # No command is asked for on the disk.
        if lies_there(spec, Path.is_dir):
            return _load_directory(Path(spec), wanted)
        if spec.lower().endswith(_ONNX):
            return _onnx(spec, wanted, opening)
        raise UserError(f"{wanted.label} {_why_unknown(spec, task, agent)}")
    if _KINDS[kind].runs_code and not opening.named_by_user:
        raise UserError(
            f"{wanted.label} would run code that a file names: name it "
            "yourself, or say --trust (where a study names it) if you trust whoever wrote that file"
        )
    if not place.strip():
        raise UserError(f"{wanted.label} names nothing: write {_KINDS[kind].form}")
    return _KINDS[kind].open(place, wanted, opening)


def _onnx(place: str, wanted: Wanted, opening: Opening) -> Policy:
    del opening  # It cannot run code.
    from rigid.policies.onnx import open_onnx

    return open_onnx(Path(place), wanted)


def _sb3(place: str, wanted: Wanted, opening: Opening) -> Policy:
    from rigid.policies.sb3 import open_sb3

    return open_sb3(Path(place), wanted, opening)


def _torchscript(place: str, wanted: Wanted, opening: Opening) -> Policy:
    from rigid.policies.torchscript import open_torchscript

    return open_torchscript(Path(place), wanted, opening)


def _python(place: str, wanted: Wanted, opening: Opening) -> Policy:
    del opening  # The user named it.
    from rigid.policies.python import open_python

    return open_python(place, wanted)


def _exec(place: str, wanted: Wanted, opening: Opening) -> Policy:
    del opening  # The user named it.
    from rigid.policies.command import open_command

    return open_command(place, wanted)


_KINDS: Mapping[str, _Kind] = {
    "onnx": _Kind("FILE.onnx", _onnx, runs_code=False),
    "sb3": _Kind("sb3:FILE.zip", _sb3, runs_code=True),
    "torchscript": _Kind("torchscript:FILE.pt", _torchscript, runs_code=True),
    "python": _Kind("python:MODULE:FACTORY", _python, runs_code=True),
    "exec": _Kind("exec:COMMAND", _exec, runs_code=True),
}
"""What may stand before a colon, `builtin` aside. Libraries are imported where they are used."""

_ENDINGS = {".zip": "sb3", ".pt": "torchscript", ".pth": "torchscript", ".ts": "torchscript"}
"""How files end of kinds that have to be named, since opening them runs code."""


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
    if isinstance(policy, Fingerprinted):
        return policy.fingerprint()
    stored = load_native(policy).policy if isinstance(policy, Path | str) else policy
    if not isinstance(stored, NativePolicy):
        raise TypeError(f"a {type(stored).__name__} has no weights to hash")
    return hash_weights(architecture_of(stored), weights_of(stored))


def _load_builtin(name: str, task: Task, agent: Agent) -> Policy:
    names = builtin_names(task, agent)
    if name not in names:
        listed = ", ".join(_BUILTIN + known for known in names) or "none"
        train = f"rigid train co-optimize --task {task.name} --out DIR"
        way = "" if names else f"; train a pair with `{train}`, or name yours with --{agent}"
        raise UserError(
            f"{agent} '{_BUILTIN}{name}' is unknown for task {task.name!r}"
            f"{_suggestion(name, names)}; builtin {agent}s: {listed}{way}"
        )
    brought = task.builtin_policies(agent) if isinstance(task, BringsPolicies) else {}
    if name in brought:
        return brought[name]
    with resources.as_file(BUNDLED / task.name / name) as directory:
        return _load_directory(directory, Wanted(_BUILTIN + name, agent, task))


@contextmanager
def native_directory(spec: str, task: Task) -> Iterator[Path | None]:
    """Where a policy that `load_policy` takes lies in the native format; None if it does not."""
    if not spec.startswith(_BUILTIN):
        there = lies_there(Path(spec) / CARD_FILE, Path.is_file)
        yield Path(spec) if there else None
        return
    entry = BUNDLED / task.name / spec.removeprefix(_BUILTIN)
    if not (entry / CARD_FILE).is_file():
        yield None
        return
    with resources.as_file(entry) as directory:
        yield directory


def _load_directory(directory: Path, wanted: Wanted) -> NativePolicy:
    if not (directory / CARD_FILE).exists() and (directory / wanted.agent / CARD_FILE).is_file():
        raise UserError(
            f"{wanted.label} holds no policy itself: name '{directory / wanted.agent}' in it"
        )
    policy, card = load_native(directory)
    check_made_for(wanted, card.agent, card.task.get("name"))
    return policy


def _check_unused(opening: Opening, wanted: Wanted) -> None:
    """Refuses what would be ignored: a robot without its normaliser is another robot."""
    for option, given in (("vecnormalize", opening.vecnormalize), ("frames", opening.frames > 1)):
        if given:
            raise UserError(f"--{option} is for sb3:FILE.zip, but the robot is {wanted.spec!r}")


def _why_unknown(spec: str, task: Task, agent: Agent) -> str:
    names = builtin_names(task, agent)
    forms = (f"{_BUILTIN}NAME", "a native policy directory", *(k.form for k in _KINDS.values()))
    known = f"give {', '.join(forms[:-1])} or {forms[-1]}"
    kind, colon, _ = spec.partition(":")
    if colon:
        return f"is of kind {kind!r}, which is unknown: {known}"
    if spec in names:
        return f"is no directory; did you mean '{_BUILTIN}{spec}'?"
    for ending, kind in _ENDINGS.items():
        if spec.lower().endswith(ending):
            there = "a file" if lies_there(spec, Path.is_file) else "no directory"
            return f"is {there}; did you mean '{kind}:{spec}', with --trust?"
    return f"is no directory: {known}"


def _suggestion(name: str, names: tuple[str, ...]) -> str:
    close = difflib.get_close_matches(name, names, n=1)
    return f"; did you mean '{_BUILTIN}{close[0]}'?" if close else ""
