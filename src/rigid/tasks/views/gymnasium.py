"""One player of a task as a Gymnasium environment; the other one is played by a policy."""

from __future__ import annotations

from typing import Any, Literal

import gymnasium
import numpy as np
from jaxtyping import Float32

from rigid.errors import UserError
from rigid.policies.passive import PassivePolicy
from rigid.policies.protocol import Policy, State
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task
from rigid.tasks.views.single import AGENTS, SingleWorld

Agent = Literal["robot", "human"]
ITCH_SCRATCHING = "rigid/ItchScratching-v0"
FEEDING = "rigid/Feeding-v0"
BED_BATHING = "rigid/BedBathing-v0"
_TASKS = {ITCH_SCRATCHING: "itch-scratching", FEEDING: "feeding", BED_BATHING: "bed-bathing"}


def register() -> None:
    """Makes `gymnasium.make("rigid/ItchScratching-v0")` and the like work; may be called again."""
    for name, task in _TASKS.items():
        if name not in gymnasium.registry:
            gymnasium.register(name, entry_point=f"{__name__}:play", kwargs={"task": task})


def play(
    task: str,
    player: str = "robot",
    partner: Policy | str | None = None,
    *,
    partner_noise: bool = False,
    **parameters: Any,
) -> SinglePlayerEnv:
    """A registered task for one player; see `SinglePlayerEnv` and the task's parameters.

    Raises:
        UserError: No such player, partner or parameter.
    """
    built = make_task(task, **parameters)
    return SinglePlayerEnv(built, player, partner, partner_noise=partner_noise)


class SinglePlayerEnv(gymnasium.Env[np.ndarray, np.ndarray]):
    """The reward, the fixed length and the info are those of the two-player task.

    Spaces are boxes: observations have the task's bounds where it says them, actions are reals in
    [-1, 1] (of a discrete action a score for each choice, of which the largest is taken).
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - Gymnasium declares no ClassVar

    def __init__(
        self,
        task: Task,
        player: str = "robot",
        partner: Policy | str | None = None,
        *,
        partner_noise: bool = False,
    ) -> None:
        """Builds the environment.

        Args:
            task: The two-player task.
            player: Who is played through this environment, `robot` or `human`.
            partner: The policy of the other agent, or what would stand after `--robot` or
                `--human` to name it; None holds still.
            partner_noise: Whether the partner samples its actions instead of taking their mean.

        Raises:
            UserError: No such player or partner, or a partner of another size.
        """
        if player not in AGENTS:
            raise UserError(f"player is {player!r}, but must be one of {AGENTS}")
        other: Agent = "human" if player == "robot" else "robot"
        self._player, self._partner_name, self._partner_noise = player, other, partner_noise
        self._partner = _resolve(partner, task, other)
        self._world = SingleWorld(task)
        self._state: State = ()
        self.observation_space = self._world.observation_spaces[player]
        self.action_space = self._world.action_spaces[player]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Float32[np.ndarray, " n"], dict[str, Any]]:
        """Begins an episode; the player's observation and info.

        Args:
            seed: Plays the episode that this seed starts in every world of the task. Resets
                without a seed then draw theirs from a generator seeded with it.
            options: Not used.
        """
        super().reset(seed=seed, options=options)
        self._world.reset(int(self.np_random.integers(2**31)) if seed is None else seed)
        self._state = self._partner.initial_state(1)
        return self._world.observation(self._player), self._world.info()

    def step(
        self, action: np.ndarray
    ) -> tuple[Float32[np.ndarray, " n"], float, bool, bool, dict[str, Any]]:
        """Advances one control step: observation, reward, terminated (never), truncated, info.

        Raises:
            ValueError: The episode is over, or the action is not finite or of another shape than
                the space.
        """
        noise = self.np_random if self._partner_noise else None
        seen = self._world.unclipped(self._partner_name)
        answer, self._state = self._partner.act(seen, self._state, noise)
        reward = self._world.step({self._player: action, self._partner_name: answer[0]})
        over = self._world.over
        return self._world.observation(self._player), reward, False, over, self._world.info()


def _resolve(partner: Policy | str | None, task: Task, agent: Agent) -> Policy:
    """The partner's policy; loading one by name reads files, and checking one imports JAX."""
    if partner is None:
        spec = {"robot": task.robot, "human": task.human}[agent]
        return PassivePolicy(spec.observation_size, spec.action_size)
    from rigid.policies.loading import check_sizes, load_policy

    if isinstance(partner, str):
        return load_policy(partner, task=task, agent=agent)
    check_sizes(partner, type(partner).__name__, task=task, agent=agent)
    return partner
