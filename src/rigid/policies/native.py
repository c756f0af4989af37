"""RIGID's own policy format: a directory with weights and a card that says what they are.

`policy.safetensors` holds float32 arrays (`network.0.w`, …, `log_std`, `normaliser.mean`, …; of a
PALM policy `encoder.recurrent.w`, … as well) and `policy.json` the card: architecture, agent, task,
provenance, and a hash that ties the two together. Neither can hold code, so a stranger's policy is
safe to open.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from pydantic import BaseModel, ConfigDict
from safetensors import SafetensorError, deserialize
from safetensors.numpy import save

from rigid.errors import UserError
from rigid.files import json_text, read_bytes, write_atomically
from rigid.headers import parse_header
from rigid.policies.architecture import (
    Architecture,
    NativePolicy,
    Weights,
    architecture_of,
    weights_of,
)

Agent = Literal["robot", "human"]

FORMAT_VERSION = 1
WEIGHTS_FILE = "policy.safetensors"
CARD_FILE = "policy.json"

_OF_A_RUN = "frontier.json"
"""What marks a finished run directory: `rigid.compute.run.directory`, above this module."""
_CURE = "copy the policy or train it again"


class PolicyCard(BaseModel):
    """`policy.json`: what a stored policy is and where it comes from."""

    model_config = ConfigDict(frozen=True, strict=True)

    format: int = FORMAT_VERSION
    agent: Agent
    architecture: Architecture
    task: Mapping[str, Any]
    """`Task.describe()` of the task it was trained in."""
    provenance: Mapping[str, Any]
    """How it was made: recipe, settings, seed, versions. Never part of the hash."""
    sha256: str
    """`policy_hash` of architecture and weights."""


class StoredPolicy(NamedTuple):
    """A policy from disk with its card."""

    policy: NativePolicy
    card: PolicyCard


def save_policy(
    policy: NativePolicy,
    directory: Path | str,
    *,
    agent: Agent,
    task: Mapping[str, Any],
    provenance: Mapping[str, Any],
) -> PolicyCard:
    """Writes `policy` into `directory`, which may hold other files, and returns its card.

    Each file is replaced atomically, weights first: a policy that was being replaced when the
    machine died is either whole or refused by its hash.

    Args:
        policy: What to store; its weights become float32.
        directory: Made if missing.
        agent: Whose policy it is.
        task: `Task.describe()` of the task it was trained in.
        provenance: How it was made, as JSON.

    Raises:
        ValueError: A weight is not finite.
    """
    architecture, weights = architecture_of(policy), weights_of(policy)
    broken = _not_finite(weights)
    if broken is not None:
        raise ValueError(f"policy has weights that are not finite in {broken}")
    card = PolicyCard(
        agent=agent,
        architecture=architecture,
        task=dict(task),
        provenance=dict(provenance),
        sha256=hash_weights(architecture, weights),
    )
    text = json_text(card.model_dump(), indent=2) + "\n"
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    write_atomically(directory / WEIGHTS_FILE, save(weights))
    write_atomically(directory / CARD_FILE, text.encode())
    return card


def load_native(directory: Path | str) -> StoredPolicy:
    """Reads a policy that `save_policy` wrote.

    Raises:
        UserError: A file is missing, truncated, of an unknown format version, or holds weights
            that are not finite, not those of the architecture or not those of the card.
    """
    directory = Path(directory)
    card = load_card(directory)
    path = directory / WEIGHTS_FILE
    weights = _read_weights(path)
    _check_weights(weights, card.architecture, path)
    if hash_weights(card.architecture, weights) != card.sha256:
        raise UserError(f"{path} holds other weights than {CARD_FILE} describes: {_CURE}")
    return StoredPolicy(card.architecture.assemble(weights), card)


def load_card(directory: Path | str) -> PolicyCard:
    """Reads and checks `policy.json` alone.

    Raises:
        UserError: It is missing, damaged or of an unknown format version.
    """
    path = Path(directory) / CARD_FILE
    if not path.exists() and (path.parent / _OF_A_RUN).exists():
        raise UserError(
            f"{directory} is a measurement ({_OF_A_RUN}), not a policy: name the robot or human "
            "itself; the humans that were found lie in its adversaries/"
        )
    cure = f"a native policy is a directory with {CARD_FILE} and {WEIGHTS_FILE}; {_CURE}"
    text = read_bytes(path, cure=cure)
    return parse_header(PolicyCard, text, version=FORMAT_VERSION, where=path, cure=_CURE)


def hash_weights(architecture: Architecture, weights: Mapping[str, np.ndarray]) -> str:
    """SHA-256 over architecture and weights, whatever order a file keeps them in."""
    digest = hashlib.sha256(json_text(architecture.model_dump()).encode())
    for name in sorted(weights):
        digest.update(f"\0{name}\0".encode())
        digest.update(np.ascontiguousarray(weights[name], dtype="<f4").tobytes())
    return digest.hexdigest()


def _read_weights(path: Path) -> Weights:
    data = read_bytes(path, cure=_CURE)
    try:
        arrays = deserialize(data)  # type: ignore[no-untyped-call]  # safetensors ships no types.
    except SafetensorError as error:
        raise UserError(f"{path} is truncated or damaged ({error}): {_CURE}") from None
    for name, array in arrays:
        if array["dtype"] != "F32":
            raise UserError(f"{path}: {name} is {array['dtype']}, but weights are F32: {_CURE}")
    return {
        name: np.frombuffer(array["data"], dtype="<f4").reshape(array["shape"])
        for name, array in arrays
    }


def _check_weights(weights: Weights, architecture: Architecture, path: Path) -> None:
    expected = architecture.shapes()
    for name in sorted(expected.keys() | weights.keys()):
        if name not in weights:
            raise UserError(f"{path}: {name} is missing: {_CURE}")
        if name not in expected:
            raise UserError(f"{path}: {name} is unknown to the architecture: {_CURE}")
        if weights[name].shape != expected[name]:
            raise UserError(
                f"{path}: {name} has shape {weights[name].shape}, but the architecture in "
                f"{CARD_FILE} has {expected[name]}: {_CURE}"
            )
    broken = _not_finite(weights)
    if broken is not None:
        raise UserError(f"{path}: {broken} holds numbers that are not finite: train it again")


def _not_finite(weights: Weights) -> str | None:
    """Name of the first array with NaN or infinity in it, if any."""
    return next((name for name in sorted(weights) if not np.isfinite(weights[name]).all()), None)
