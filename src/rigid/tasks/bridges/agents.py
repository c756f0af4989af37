"""Which agents of a PettingZoo environment are the human, and which the robot."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from rigid.errors import UserError
from rigid.factories import told


def agents_of(env: Any) -> tuple[Any, ...]:
    """All agents, in the environment's order."""
    return tuple(getattr(env, "possible_agents", None) or getattr(env, "agents", None) or ())


def checked_agents(env: Any, name: str) -> tuple[str, ...]:
    """The names of all agents.

    Raises:
        UserError: There are fewer than two, or the environment fails.
    """
    try:
        if not agents_of(env):
            env.reset(seed=0)  # Those that do not say before.
    except Exception as error:  # noqa: BLE001 - Somebody else's code may raise anything.
        raise UserError(
            f"{name}: the environment fails at its first reset: {told(error)}"
        ) from None
    found = agents_of(env)
    if len(found) < 2:
        raise UserError(f"{name}: the environment has agents {found}, but must have two or more")
    return tuple(map(str, found))


def divided(
    agents: Sequence[str], human_agent: str | None, robot_agent: str | None, name: str
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Agents of the human and of the robot, each in the environment's order.

    Args:
        agents: All of them.
        human_agent: What the user wrote, names separated by commas; None for nothing.
        robot_agent: Likewise.
        name: Of the task; begins every message.

    Raises:
        UserError: A name is no agent's, or an agent is on both sides or on none.
    """
    human, robot = _named(human_agent), _named(robot_agent)
    listed = ", ".join(agents)
    for option, side in (("--human-agent", human), ("--robot-agent", robot)):
        unknown = [agent for agent in side if agent not in agents]
        if unknown:
            raise UserError(f"{name}: {option} {unknown[0]!r} is no agent; agents: {listed}")
    both = set(human) & set(robot)
    if both:
        raise UserError(f"{name}: agent {min(both)!r} cannot be both human and robot")
    if not human and not robot:
        if set(agents) != {"human", "robot"}:
            raise UserError(
                f"{name}: who is the human? Say it with --human-agent AGENT; agents: {listed}"
            )
        human = ("human",)
    human = human or tuple(agent for agent in agents if agent not in robot)
    robot = robot or tuple(agent for agent in agents if agent not in human)
    if not human or not robot:
        lacking = "robot" if human else "human"
        raise UserError(f"{name}: nobody is left for the {lacking}; agents: {listed}")
    left = [agent for agent in agents if agent not in {*human, *robot}]
    if left:
        raise UserError(
            f"{name}: nobody plays {', '.join(left)}: add them to --robot-agent or --human-agent"
        )
    return tuple(_ordered(human, agents)), tuple(_ordered(robot, agents))


def _ordered(side: Sequence[str], agents: Sequence[str]) -> Iterator[str]:
    return (agent for agent in agents if agent in side)


def _named(text: str | None) -> tuple[str, ...]:
    return tuple(part.strip() for part in (text or "").split(",") if part.strip())
