"""What a stored policy's weights are the weights of, and how they become a policy again."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array
from pydantic import BaseModel, ConfigDict, Field, PositiveInt

from rigid.policies.gaussian import GaussianParameters, GaussianPolicy
from rigid.policies.networks import MLP, Normaliser
from rigid.policies.palm import MotionEncoder, PalmParameters, PalmPolicy

NativePolicy = GaussianPolicy | PalmPolicy
"""What RIGID's own format holds."""
Weights = dict[str, np.ndarray]
Shapes = dict[str, tuple[int, ...]]


class GaussianArchitecture(BaseModel):
    """A tanh network on a window of observations."""

    model_config = ConfigDict(frozen=True, strict=True)

    kind: Literal["gaussian"] = "gaussian"
    observation_size: PositiveInt
    action_size: PositiveInt
    memory: PositiveInt
    """Observations in the network's input, newest first."""
    hidden: tuple[PositiveInt, ...]
    """Widths of the tanh layers."""

    def shapes(self) -> Shapes:
        """Shape of each weight array, by name."""
        return _head_shapes(self.observation_size * self.memory, self.hidden, self.action_size)

    def assemble(self, weights: Weights) -> GaussianPolicy:
        """The policy of these weights."""
        arrays = {name: jnp.asarray(array) for name, array in weights.items()}
        return GaussianPolicy(_head(arrays, len(self.hidden)), memory=self.memory)


class PalmArchitecture(BaseModel):
    """A recurrent encoder of the last observations, and a tanh network on the newest and z."""

    model_config = ConfigDict(frozen=True, strict=True)

    kind: Literal["palm"] = "palm"
    observation_size: PositiveInt
    action_size: PositiveInt
    memory: Annotated[int, Field(ge=1, le=100)]
    """Observations that the encoder reads. No weight bounds it, so a stranger's card is held to
    100 (ours)."""
    hidden: tuple[PositiveInt, ...]
    """Widths of the tanh layers."""
    encoder_hidden: PositiveInt
    """Width of the recurrent unit."""
    latent: PositiveInt

    def shapes(self) -> Shapes:
        """Shape of each weight array, by name."""
        size, width = self.observation_size, self.encoder_hidden
        return {
            **_head_shapes(size + self.latent, self.hidden, self.action_size),
            "encoder.recurrent.w": (2 * size, 3 * width),
            "encoder.recurrent.u": (width, 3 * width),
            "encoder.recurrent.b": (3 * width,),
            "encoder.mean.w": (width, self.latent),
            "encoder.mean.b": (self.latent,),
            **_normaliser_shapes("encoder.normaliser", size),
            **_normaliser_shapes("encoder.change", size),
        }

    def assemble(self, weights: Weights) -> PalmPolicy:
        """The policy of these weights."""
        arrays = {name: jnp.asarray(array) for name, array in weights.items()}
        encoder = MotionEncoder(
            {key: arrays[f"encoder.recurrent.{key}"] for key in "wub"},
            {key: arrays[f"encoder.mean.{key}"] for key in "wb"},
            _normaliser("encoder.normaliser", arrays),
            _normaliser("encoder.change", arrays),
        )
        parameters = PalmParameters(encoder, _head(arrays, len(self.hidden)))
        return PalmPolicy(parameters, memory=self.memory)


Architecture = Annotated[GaussianArchitecture | PalmArchitecture, Field(discriminator="kind")]


def architecture_of(policy: NativePolicy) -> GaussianArchitecture | PalmArchitecture:
    """The architecture of a policy in memory."""
    if isinstance(policy, GaussianPolicy):
        return GaussianArchitecture(
            observation_size=policy.observation_size,
            action_size=policy.action_size,
            memory=policy.memory,
            hidden=_widths(policy.parameters.network),
        )
    width, latent = policy.parameters.encoder.mean["w"].shape
    return PalmArchitecture(
        observation_size=policy.observation_size,
        action_size=policy.action_size,
        memory=policy.memory,
        hidden=_widths(policy.parameters.head.network),
        encoder_hidden=width,
        latent=latent,
    )


def weights_of(policy: NativePolicy) -> Weights:
    """The weights of a policy in memory, by name, float32."""
    if isinstance(policy, GaussianPolicy):
        named = _head_weights(policy.parameters)
    else:
        encoder, head = policy.parameters
        named = _head_weights(head)
        named |= _normaliser_weights("encoder.normaliser", encoder.normaliser)
        named |= _normaliser_weights("encoder.change", encoder.change)
        named |= {f"encoder.recurrent.{key}": value for key, value in encoder.recurrent.items()}
        named |= {f"encoder.mean.{key}": value for key, value in encoder.mean.items()}
    return {name: np.asarray(value, dtype=np.float32) for name, value in named.items()}


def _widths(network: MLP) -> tuple[int, ...]:
    return tuple(layer["w"].shape[1] for layer in network[:-1])


def _head_shapes(seen: int, hidden: Sequence[int], action_size: int) -> Shapes:
    shapes: Shapes = {}
    for layer, size in enumerate(pairwise((seen, *hidden, action_size))):
        shapes |= {f"network.{layer}.w": size, f"network.{layer}.b": size[1:]}
    return {**shapes, "log_std": (action_size,), **_normaliser_shapes("normaliser", seen)}


def _normaliser_shapes(name: str, size: int) -> Shapes:
    return {f"{name}.mean": (size,), f"{name}.variance": (size,), f"{name}.count": ()}


def _head(arrays: dict[str, Array], hidden: int) -> GaussianParameters:
    network = [
        {key: arrays[f"network.{layer}.{key}"] for key in "wb"} for layer in range(hidden + 1)
    ]
    return GaussianParameters(network, arrays["log_std"], _normaliser("normaliser", arrays))


def _normaliser(name: str, arrays: dict[str, Array]) -> Normaliser:
    return Normaliser(**{key: arrays[f"{name}.{key}"] for key in Normaliser._fields})


def _head_weights(parameters: GaussianParameters) -> dict[str, Any]:
    network, log_std, normaliser = parameters
    named = {f"network.{i}.{key}": layer[key] for i, layer in enumerate(network) for key in "wb"}
    return named | _normaliser_weights("normaliser", normaliser) | {"log_std": log_std}


def _normaliser_weights(name: str, normaliser: Normaliser) -> dict[str, Any]:
    return {f"{name}.{key}": value for key, value in normaliser._asdict().items()}
