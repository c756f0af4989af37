"""Who plays: the bundled pair, the same human with loud noise, and humans who flail."""

from __future__ import annotations

from functools import cache

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int

from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.loading import load_policy
from rigid.policies.networks import OBSERVATION_CLIP
from rigid.policies.protocol import Policy, State
from rigid.tasks.itch_scratching.task import ItchScratching

ROBOT, HUMAN = "builtin:vanilla", "builtin:synthetic-human"
LOUD = 1.5
"""Standard deviation of the loud human's actions; the synthetic human's is 0.2. Ours: the most with
which the robot still succeeds often, so that success can fall as well as rise."""
_HIDDEN = 32
_GAIN = 10.0
"""Of the last layer: most actions are full ones, which turn round as the arm moves. Ours."""
_NOISE = 0.3
"""Standard deviation of the flailing human's actions on top. Ours."""


class Flailing:
    """A human of random weights for each episode, drawn from the episode's seed.

    A network of one tanh layer on observations that are scaled as the synthetic human's.
    """

    def __init__(self, seeds: Int[np.ndarray, " B"], like: GaussianPolicy) -> None:
        self.observation_size, self.action_size = like.observation_size, like.action_size
        normaliser = like.parameters.normaliser
        self._mean = np.asarray(normaliser.mean)
        self._deviation = np.sqrt(np.asarray(normaliser.variance) + 1e-6)
        weights = [self._drawn(int(seed)) for seed in seeds]
        self._first, self._last = (np.stack(layer) for layer in zip(*weights, strict=True))

    def _drawn(self, seed: int) -> tuple[np.ndarray, np.ndarray]:
        rng = np.random.default_rng([seed, 1])  # Apart from the draw of the start.
        first = rng.standard_normal((self.observation_size, _HIDDEN)) / self.observation_size**0.5
        last = rng.standard_normal((_HIDDEN, self.action_size)) * _GAIN / _HIDDEN**0.5
        return first, last

    def initial_state(self, batch: int) -> State:
        """Nothing to remember."""
        del batch
        return ()

    def act(
        self, observation: Float[np.ndarray, "B o"], state: State, rng: np.random.Generator | None
    ) -> tuple[Float[np.ndarray, "B a"], State]:
        """Actions in [-1, 1]; row i is the human of the i-th seed."""
        scaled = (observation - self._mean) / self._deviation
        seen = np.clip(scaled, -OBSERVATION_CLIP, OBSERVATION_CLIP)
        hidden = np.tanh(np.einsum("bo,boh->bh", seen, self._first))
        action = np.einsum("bh,bha->ba", hidden, self._last)
        if rng is not None:
            action = action + _NOISE * rng.standard_normal(action.shape)
        return np.clip(action, -1.0, 1.0), state


def human_named(name: str, seeds: Int[np.ndarray, " B"]) -> Policy:
    """The human of a pair, for episodes of these seeds.

    `canonical` is the synthetic human, `loud` the same with noise of `LOUD`, `flailing` another
    human of random weights in every episode.

    Raises:
        ValueError: There is no such human.
    """
    synthetic = _synthetic()
    if name == "canonical":
        return synthetic
    if name == "loud":
        noise = jnp.full_like(synthetic.parameters.log_std, np.log(LOUD))
        return GaussianPolicy(synthetic.parameters._replace(log_std=noise))
    if name == "flailing":
        return Flailing(seeds, synthetic)
    raise ValueError(f"no human is called {name!r}")


@cache
def robot() -> Policy:
    """The bundled robot."""
    return load_policy(ROBOT, task=ItchScratching(), agent="robot")


@cache
def _synthetic() -> GaussianPolicy:
    policy = load_policy(HUMAN, task=ItchScratching(), agent="human")
    assert isinstance(policy, GaussianPolicy)
    return policy
