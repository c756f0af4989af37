"""What `rigid export --onnx` writes into a model's metadata, so that it is checked when it is read.

Other exporters may write the same: the metadata property `rigid` is a JSON object.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

from rigid.errors import UserError
from rigid.headers import parse_header
from rigid.policies.foreign import Wanted, check_made_for
from rigid.policies.native import Agent

METADATA_KEY = "rigid"
VERSION = 1


class OnnxContract(BaseModel):
    """The value of `METADATA_KEY`."""

    model_config = ConfigDict(frozen=True)

    format: int = VERSION
    agent: Agent
    task: Mapping[str, Any]
    """`Task.describe()` of the task it was trained in."""
    observation_names: tuple[str, ...] = ()
    """A name for each observed number, in order."""
    observation_size: int
    action_size: int
    choices: tuple[int, ...] = ()
    """Numbers of choices of discrete actions; the output is then a score for each choice."""
    normaliser: Literal["inside", "none"] = "inside"
    """Whether observations are normalised in the graph; the input is never normalised."""
    memory: int = 1
    """Observations that it acts on, the newest included."""
    fingerprint: str = ""
    """SHA-256 of the policy it was exported from."""
    provenance: Mapping[str, Any] = {}
    """How that was made."""


def check_contract(text: str, wanted: Wanted) -> None:
    """Refuses a model that was made for another agent, task or observation.

    Raises:
        UserError: It was, or the metadata cannot be read.
    """
    cure = "export it again"
    where = f"{wanted.label}: metadata {METADATA_KEY!r}"
    contract = parse_header(OnnxContract, text, version=VERSION, where=where, cure=cure)
    check_made_for(wanted, contract.agent, contract.task.get("name"))
    pairs = zip(contract.observation_names, wanted.sizes.observation_names, strict=False)
    for number, (mine, theirs) in enumerate(pairs):
        if mine != theirs:
            raise UserError(
                f"{wanted.label} was exported to see {mine!r} as observation {number}, but the "
                f"task shows {theirs!r} there: export it with this version of the task"
            )
