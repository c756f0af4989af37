"""Policies of Stable-Baselines3 and sb3-contrib.

Their files hold pickles: opening one can run code of its maker, so it takes `--trust`. Only the
policy is built, from its class and weights, so that any algorithm will do, no replay buffer is made
and nothing else of the file is unpickled.
"""

from __future__ import annotations

import base64
import hashlib
import inspect
import io
import json
import logging
import zipfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Shaped

from rigid.errors import UserError
from rigid.files import read_bytes
from rigid.policies.foreign import ForeignPolicy, Wanted, first_line, need_packages, open_model
from rigid.policies.opening import Opening
from rigid.policies.sb3_inputs import Inputs, Statistics, read_statistics, statistics_beside
from rigid.policies.sb3_spaces import check_observation, from_space

_CURE = "save it again with model.save(…)"
_log = logging.getLogger(__name__)


class _Memory(NamedTuple):
    seen: Shaped[np.ndarray, "B ..."]
    """Frames that `Inputs` keeps."""
    hidden: tuple[Shaped[np.ndarray, "B ..."], ...] | None
    """State of a recurrent policy, worlds first; None before the first step or without one."""


def open_sb3(path: Path, wanted: Wanted, opening: Opening) -> ForeignPolicy:
    """The policy in a file that `model.save(…)` of Stable-Baselines3 wrote.

    Args:
        path: The zip file.
        wanted: Whom it acts for.
        opening: Whether it is trusted, and what stood between environment and policy.

    Raises:
        UserError: The user does not trust it, a library is missing, the file is damaged, or the
            policy sees or does other things than the task's.
    """
    opening.need_trust(wanted.label, "a file of Stable-Baselines3, which holds pickles")
    need_packages(wanted, "sb3", "stable_baselines3", "torch")
    if opening.frames < 1:
        raise UserError(f"--frames is {opening.frames}, but must be at least 1")
    data = read_bytes(path, cure="name a file that model.save(…) wrote")
    described = _described(data, path)
    statistics = None
    if opening.vecnormalize is not None:
        statistics = read_statistics(opening.vecnormalize)
    else:
        _warn_of_statistics(path, described, wanted)
    model = Sb3Model(data, str(path), statistics, opening.frames)
    size = check_observation(model.policy.observation_space, wanted, opening.frames, statistics)
    return open_model(model, wanted, size)


class Sb3Model:
    """A policy of Stable-Baselines3; built where it is needed."""

    def __init__(self, data: bytes, path: str, statistics: Statistics | None, frames: int) -> None:
        self._data, self._path = data, path
        self._statistics, self._frames = statistics, frames
        self._built: Any = None

    def __getstate__(self) -> dict[str, Any]:
        """It is built again in another process."""
        return {**self.__dict__, "_built": None}

    @property
    def policy(self) -> Any:
        """The policy, on the processor."""
        if self._built is None:
            self._built = _build(self._data, self._path)
        return self._built

    @property
    def _inputs(self) -> Inputs:
        whole = int(self.policy.observation_space.shape[0])
        return Inputs(whole // self._frames, self._frames, self._statistics)

    def begin(self, batch: int) -> _Memory:
        """Nothing seen yet."""
        return _Memory(self._inputs.start(batch), None)

    def answer(
        self, observation: Float[np.ndarray, "B o"], memory: _Memory, rng: object
    ) -> tuple[Shaped[np.ndarray, "..."], _Memory]:
        """The deterministic action, in [-1, 1] or as whole numbers."""
        del rng
        seen, frames = self._inputs.see(observation, memory.seen)
        hidden = memory.hidden
        state = None if hidden is None else tuple(np.swapaxes(part, 0, 1) for part in hidden)
        action, after = self.policy.predict(seen, state=state, deterministic=True)
        kept = None if after is None else tuple(np.swapaxes(part, 0, 1) for part in after)
        return from_space(np.asarray(action), self.policy.action_space), _Memory(frames, kept)

    def fingerprint(self) -> str:
        """SHA-256 over the file, the statistics and the number of frames."""
        digest = hashlib.sha256(self._data)
        if self._statistics is not None or self._frames > 1:
            normaliser = "" if self._statistics is None else self._statistics.sha256
            digest.update(f"\0{normaliser}\0{self._frames}".encode())
        return digest.hexdigest()


def _described(data: bytes, path: Path) -> dict[str, Any]:
    """The file's JSON, in which what is no JSON is pickled; nothing is unpickled here."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            found = json.loads(archive.read("data"))
            archive.getinfo("policy.pth")
    except (zipfile.BadZipFile, KeyError, ValueError, EOFError) as error:
        raise UserError(
            f"{path} is no file of Stable-Baselines3, or a truncated one ({error}): {_CURE}"
        ) from None
    if not isinstance(found, dict):
        raise UserError(f"{path}: its description is no JSON object: {_CURE}")
    return found


def _warn_of_statistics(path: Path, described: dict[str, Any], wanted: Wanted) -> None:
    """A policy that misses its normaliser acts, but badly: whoever forgot it should know."""
    beside = statistics_beside(path)
    cure = f"say --vecnormalize {beside[0] if beside else 'FILE, a file that env.save(…) wrote'}"
    if wanted.agent == "human":  # The option is the robot's.
        cure = "convert it to ONNX with its statistics inside (docs/policies.md)"
    if beside:
        _log.warning(
            "rigid: %s: %s lies beside it. If the policy was trained behind VecNormalize it acts "
            "wrongly without: %s", wanted.label, beside[0], cure,
        )  # fmt: skip
    elif described.get("_last_original_obs") is not None and not _off_policy(described):
        _log.warning(
            "rigid: %s was trained behind VecNormalize. Unless that left observations as they "
            "were, the policy acts wrongly without its statistics: %s", wanted.label, cure,
        )  # fmt: skip


def _off_policy(described: dict[str, Any]) -> bool:
    """Whether it learned from a replay buffer: such models always keep their last observation."""
    return "replay_buffer_class" in described


def _build(data: bytes, path: str) -> Any:
    """Unpickles what describes the policy, builds it and loads its weights."""
    import torch

    torch.set_num_threads(1)  # One for each worker process; also the same sums everywhere.
    described = _described(data, Path(path))
    kind = _unpickled(described, "policy_class", path)
    spaces = [_unpickled(described, name, path) for name in ("observation_space", "action_space")]
    options = dict(_unpickled(described, "policy_kwargs", path) or {})
    known = inspect.signature(kind.__init__).parameters
    if described.get("use_sde"):
        options.setdefault("use_sde", True)
    schedule = [_no_learning] if "lr_schedule" in known or "args" in known else []  # ARS has none.
    try:
        policy = kind(*spaces, *schedule, **options)
        with zipfile.ZipFile(io.BytesIO(data)) as archive, archive.open("policy.pth") as file:
            weights = torch.load(file, map_location="cpu", weights_only=True)
        policy.load_state_dict(weights)
    except Exception as error:  # noqa: BLE001 - Classes of anybody's making may raise anything.
        raise UserError(
            f"{path}: its {kind.__name__} cannot be built ({first_line(error)}): "
            f"{_CURE} of the installed version"
        ) from None
    policy.set_training_mode(False)
    return policy


def _unpickled(described: dict[str, Any], name: str, path: str) -> Any:
    """An entry of the description."""
    import cloudpickle

    entry = described.get(name)
    if not isinstance(entry, dict) or ":serialized:" not in entry:
        return entry
    try:
        return cloudpickle.loads(base64.b64decode(entry[":serialized:"]))  # The user said --trust.
    except Exception as error:  # noqa: BLE001 - Pickles may raise anything.
        raise UserError(
            f"{path}: its {name} cannot be read ({first_line(error)}): install what it "
            "was trained with (sb3-contrib?), or convert it to ONNX where that is installed"
        ) from None


def _no_learning(remaining: float) -> float:
    """The learning rate of a policy that only acts."""
    del remaining
    return 0.0
