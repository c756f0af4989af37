"""The synthetic human as if the other itch itched: moves naturally, and no robot can help."""

import mujoco

from rigid.tasks.itch_scratching.scene import LIMBS

TIP, TIP_TO_ITCH, ITCH = slice(0, 3), slice(7, 10), slice(10, 13)  # Of the human's observation.


def mistaken(task, world, human, rng):
    """Acts for the human of every episode of `world`."""
    data = mujoco.MjData(task.model)

    def other_itch(row):
        data.qpos[:] = row[: task.model.nq]
        mujoco.mj_kinematics(task.model, data)
        return data.site(f"itch_{LIMBS[1 - int(row[-2])]}").xpos - task.chest

    def act(observation):
        misled = observation.copy()
        misled[:, ITCH] = [other_itch(row) for row in world.snapshot()]
        misled[:, TIP_TO_ITCH] = misled[:, TIP] - misled[:, ITCH]
        return human.act(misled, (), rng)[0]

    return act
