"""Episodes of any assistive task, and what is seen at their start."""

import mujoco
import numpy as np


def drawn(task, rng, batch):
    """Uniform actions of robot and human."""
    return tuple(
        rng.uniform(-1, 1, (batch, agent.action_size)) for agent in (task.robot, task.human)
    )


def at_rest(task, batch):
    """Zero actions of robot and human."""
    return tuple(np.zeros((batch, agent.action_size)) for agent in (task.robot, task.human))


def played(task, robot, human, seeds, steps=None):
    """The world after an episode, its steps and its snapshots.

    Args:
        task: Any.
        robot: A policy.
        human: Actions (B, a_h) of a step's number.
        seeds: Of the worlds.
        steps: By default a whole episode.
    """
    world = task.make_world(len(seeds), threads=1)
    rows, snapshots = [world.reset(seeds)], [world.snapshot()]
    state = robot.initial_state(len(seeds))
    for number in range(steps or task.horizon):
        action, state = robot.act(rows[-1].robot_observation, state, None)
        rows.append(world.step(action, human(number)))
        snapshots.append(world.snapshot())
    return world, rows, np.array(snapshots)


def seen_alike(task, world, seeds, steps=15):
    """What both players see in every world, with the same random actions in all of them."""
    rng, seen = np.random.default_rng(0), []
    step = world.reset(np.array(seeds))
    for _ in range(steps):
        seen.append(np.concatenate([step.robot_observation, step.human_observation], axis=1))
        actions = drawn(task, rng, 1)
        step = world.step(*(np.repeat(action, world.batch, 0) for action in actions))
    return np.array(seen)


def start_by_name(task, seed):
    """The scene at the start of an episode, and what robot and human see of it by name."""
    world = task.make_world(1, threads=1)
    step = world.reset(np.array([seed]))
    data = mujoco.MjData(task.model)
    data.qpos[:] = world._batch.bind("qpos")[0]
    mujoco.mj_forward(task.model, data)
    robot, human = (
        dict(zip(agent.observation_names, seen[0], strict=True))
        for agent, seen in (
            (task.robot, step.robot_observation), (task.human, step.human_observation)
        )
    )  # fmt: skip
    return data, robot, human


def point(seen, name):
    """A place of what is seen by name."""
    return np.array([seen[f"{name}_{axis}"] for axis in "xyz"])


def deepest_overlap(world):
    """Of all bodies of all worlds, in the last step [m]."""
    return world._scene.penetration(world._scene.records["sensordata"]).max()


def check_bounds(task, rows):
    """Everything that is seen in these steps lies within the task's finite bounds."""
    for agent in ("robot", "human"):
        low, high = task.bounds(agent).T
        assert np.isfinite([low, high]).all()
        for step in rows:
            seen = getattr(step, f"{agent}_observation")
            assert (seen >= low).all()
            assert (seen <= high).all()


def check_sums(rows):
    """The reward of each step is the sum of its named terms."""
    for step in rows:
        terms = [value for name, value in step.info.items() if name.startswith("reward_")]
        np.testing.assert_allclose(step.reward, np.sum(terms, axis=0), rtol=1e-12)
