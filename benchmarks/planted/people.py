"""How people move in the hand-over: the canonical human, and four who do what nobody ever does.

The canonical human is written down here and then stored as the small network that every search
starts from. The others are the same human with one habit more; none of their motions is in the
canonical data, yet every one is close to it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import optax
from jaxtyping import Array, Float

from benchmarks.planted.handover import HAND_STEP, HandOver
from rigid.policies.gaussian import GaussianParameters, GaussianPolicy, init_gaussian, mean_action
from rigid.policies.networks import MLP, Normaliser
from rigid.policies.protocol import State

NOISE = 0.12
"""Standard deviation of a canonical action, in units of a full one. Ours, as all numbers here."""
MEAN_PLACE, SPREAD = np.array([0.0, 0.58, 0.0]), np.array([0.15, 0.11, 0.13])
"""Where people mean to meet [m]."""
HIDDEN = (32, 32)
Habit = Callable[[np.ndarray, np.ndarray, np.ndarray, int], tuple[np.ndarray, np.ndarray]]
"""From hand, aim, memory of the habit and step to what the habit makes of aim and memory."""


def aim_of(observation: Float[np.ndarray, "B 14"]) -> Float[np.ndarray, "B 3"]:
    """The place [m] that the human intends."""
    return np.asarray(MEAN_PLACE + SPREAD * observation[:, 9:12])


def move_towards(
    observation: Float[np.ndarray, "B 14"], aim: Float[np.ndarray, "B 3"]
) -> Float[np.ndarray, "B 3"]:
    """Mean action towards `aim`, more or less hurried, by a more or less wide curve."""
    hand, move = observation[:, :3], observation[:, 3:6]
    hurry, curve = observation[:, 12:13], observation[:, 13:14]
    gap = aim - hand
    aside = np.stack(
        [gap[:, 1], -gap[:, 0], np.zeros(len(gap))], axis=1
    )  # To the right of the way.
    wanted = 0.3 * (gap + 0.35 * curve * aside) - 0.2 * move
    size = np.linalg.norm(wanted, axis=1, keepdims=True)
    most = 0.6 * HAND_STEP * np.exp(0.25 * hurry)
    limited = most * np.tanh(size / most) * wanted / np.maximum(size, 1e-9)
    return np.asarray(limited / HAND_STEP)


@dataclass
class Person:
    """The canonical human with a habit; stands for the human that a weakness was built from."""

    habit: Habit
    observation_size: int = HandOver.human.observation_size
    action_size: int = HandOver.human.action_size

    def initial_state(self, batch: int) -> State:
        """The step, and what the habit remembers."""
        return (0, np.zeros(batch))

    def act(
        self, observation: Float[np.ndarray, "B 14"], state: State, rng: np.random.Generator | None
    ) -> tuple[Float[np.ndarray, "B 3"], State]:
        """The canonical human's action towards the aim that the habit sets."""
        step, memory = state
        aim, memory = self.habit(observation[:, :3], aim_of(observation), memory, step)
        action = move_towards(observation, aim)
        if rng is not None:
            action = action + NOISE * rng.standard_normal(action.shape)
        return np.clip(action, -1, 1), (step + 1, memory)


def _plainly(
    hand: np.ndarray, aim: np.ndarray, memory: np.ndarray, step: int
) -> tuple[np.ndarray, np.ndarray]:
    del hand, step
    return aim, memory


def _drifting(
    hand: np.ndarray, aim: np.ndarray, memory: np.ndarray, step: int
) -> tuple[np.ndarray, np.ndarray]:
    """Drifts to the other side, 1.2 cm a step, once the place is reached."""
    del step
    arrived = np.linalg.norm(aim - hand, axis=1) < 0.06
    memory = np.where(arrived | (memory > 0), memory + 0.012, 0.0)
    across = np.where(aim[:, :1] < 0, 1.0, -1.0) * np.array([[1.0, 0.0, 0.0]])
    return aim + memory[:, None] * across, memory


def _pausing(
    hand: np.ndarray, aim: np.ndarray, memory: np.ndarray, step: int
) -> tuple[np.ndarray, np.ndarray]:
    """Stops for eleven steps about half-way."""
    del step
    pausing = (hand[:, 1] > 0.11) & (memory < 11)
    return np.where(pausing[:, None], hand, aim), np.where(hand[:, 1] > 0.11, memory + 1, memory)


def _changing_sides(
    hand: np.ndarray, aim: np.ndarray, memory: np.ndarray, step: int
) -> tuple[np.ndarray, np.ndarray]:
    """Offers the hand on the left first, then on the right."""
    del hand
    side = -0.22 if step < 18 else 0.22
    return np.stack([np.full(len(aim), side), aim[:, 1], aim[:, 2]], axis=1), memory


def _returning(
    hand: np.ndarray, aim: np.ndarray, memory: np.ndarray, step: int
) -> tuple[np.ndarray, np.ndarray]:
    """Comes, draws back half-way, and comes again."""
    del step
    arrived = np.linalg.norm(aim - hand, axis=1) < 0.08
    memory = np.where((memory == 0) & arrived, 1.0, memory)
    back = (memory == 1) & (hand[:, 1] < 0.2)
    memory = np.where(back, 2.0, memory)
    half = np.stack([0.3 * aim[:, 0], np.full(len(aim), 0.15), 0.3 * aim[:, 2]], axis=1)
    return np.where((memory == 1)[:, None], half, aim), memory


HABITS: Mapping[str, Habit] = {
    "plain": _plainly,
    "drift": _drifting,
    "pause": _pausing,
    "change of sides": _changing_sides,
    "return": _returning,
}


def fit_policy(
    observation: Float[np.ndarray, "n o"],
    action: Float[np.ndarray, "n a"],
    *,
    std: float,
    seed: int,
    steps: int = 3000,
) -> GaussianPolicy:
    """Behaviour cloning: the network whose mean is nearest to `action`, in least squares.

    Args:
        observation: What was seen.
        action: What was done.
        std: Action noise of the policy.
        seed: Of weights and minibatches.
        steps: Gradient steps of Adam on 512 rows.
    """
    rows, targets = (jnp.asarray(x, jnp.float32) for x in (observation, action))
    sizes = rows.shape[1], targets.shape[1]
    keys = jax.random.split(jax.random.key(seed))
    blank = init_gaussian(keys[0], *sizes, HIDDEN, std=std)
    moments = (rows.mean(axis=0), rows.var(axis=0), jnp.asarray(float(len(rows))))
    start = blank._replace(normaliser=Normaliser(*moments))
    optimiser = optax.adam(optax.cosine_decay_schedule(3e-3, steps))

    def loss(network: MLP, batch: Array) -> Array:
        policy: GaussianParameters = start._replace(network=network)
        return ((mean_action(policy, rows[batch]) - targets[batch]) ** 2).mean()

    def improve(carry: tuple[MLP, Any], key: Array) -> tuple[tuple[MLP, Any], None]:
        network, state = carry
        batch = jax.random.randint(key, (512,), 0, len(rows))
        updates, state = optimiser.update(jax.grad(loss)(network, batch), state)
        better: MLP = optax.apply_updates(network, updates)
        return (better, state), None

    first = (start.network, optimiser.init(start.network))
    (network, _), _ = jax.lax.scan(improve, first, jax.random.split(keys[1], steps))
    return GaussianPolicy(start._replace(network=network))
