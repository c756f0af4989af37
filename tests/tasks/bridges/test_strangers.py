"""Environments that we did not write, from examples/tasks: `pytest -m slow` with `environments`.

`pip install -e .[environments]` installs them.
"""

from pathlib import Path

import numpy as np
import pytest

from rigid.factories import call_factory
from rigid.tasks.bridges.spaces import deed_of
from rigid.tasks.conformance import broken_promises
from rigid.tasks.registry import make_task

EXAMPLES = Path(__file__).parents[3] / "examples" / "tasks"
STEPS = 60

pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("default"),  # Theirs.
]


@pytest.mark.parametrize(
    ("place", "human"),
    [
        ("particles:speaker_listener", "speaker_0"),
        ("particles:reference", "agent_0"),
        ("particles:spread", "agent_1"),
        ("bodies:ant", "agent_0"),
        ("bodies:half_cheetah", "agent_1"),
        ("walkers:multiwalker", "walker_0"),
        ("walkers:pursuit", "pursuer_3"),
        ("kitchen:cramped_room", "0"),
    ],
)
def test_it_is_a_sound_task_and_its_return_is_the_environments_own(place, human, monkeypatch):
    monkeypatch.syspath_prepend(EXAMPLES)
    task = make_task(f"pettingzoo:{place}", human_agent=human, horizon=STEPS)
    assert broken_promises(task) == ()
    rng = np.random.default_rng(0)
    actions = [rng.uniform(-1, 1, (STEPS, 1, s.action_size)) for s in (task.robot, task.human)]
    world = task.make_world(1, threads=1)
    world.reset(np.array([4]))
    rewards = [world.step(*pair).reward[0] for pair in zip(*actions, strict=True)]
    assert sum(rewards) == pytest.approx(played_without_us(task, actions), rel=1e-6)


def played_without_us(task, actions):
    """The return of the robot's agents, from the environment itself."""
    env = call_factory(task.name, str(EXAMPLES))
    parameters = task.describe()["parameters"]
    sides = [parameters[f"{side}_agent"].split(",") for side in ("robot", "human")]
    env.reset(seed=4)
    names = {str(agent): agent for agent in env.possible_agents}
    total = 0.0
    for time in range(STEPS):
        chosen = {}
        for side, rows in zip(sides, actions, strict=True):
            row = rows[time, 0]
            for name in side:
                deed = deed_of(env.action_space(names[name]), name)
                chosen[names[name]], row = deed.action(row[: deed.size]), row[deed.size :]
        _, reward, terminations, truncations, _ = env.step(chosen)
        total += sum(reward[names[name]] for name in sides[0])
        if any(terminations.values()) or any(truncations.values()):
            break
    return total
