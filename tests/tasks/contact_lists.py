"""What MuJoCo's own contact list says, beside what a task's sensors record."""

import mujoco
import numpy as np

from rigid.tasks.bodies import jaco


def swept(task, seed, human_share):
    """A robot sweeps over the person: world and, per step, state, control, sensors, the step.

    Random but steady actions.

    Args:
        task: Any assistive one.
        seed: Of the actions.
        human_share: How much of a full action the person takes.
    """
    world, rng = task.make_world(24, threads=1), np.random.default_rng(seed)
    world.reset(np.arange(24))
    sizes = task.robot.action_size, task.human.action_size
    rows, action = [], np.zeros((24, sum(sizes)))
    for number in range(100):
        if number % 25 == 0:
            action = rng.choice([-1.0, 1.0], action.shape) * rng.uniform(0.2, 1, action.shape)
        state = world._batch.state.copy()
        step = world.step(action[:, : sizes[0]], human_share * action[:, sizes[0] :])
        data = world._scene.records["sensordata"].copy()
        rows.append((state, world._batch.bind("ctrl").copy(), data, step))
    return world, rows


def substeps(task, state, control, recorded):
    """The scene after each physics step of a control step that was recorded.

    Args:
        task: Whose step it was.
        state: Before it, of one world.
        control: In it.
        recorded: What its sensors said after each physics step; they have to say it again.
    """
    data = mujoco.MjData(task.model)
    mujoco.mj_setState(task.model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION.value)
    data.ctrl[:] = control
    for sensors in recorded:
        mujoco.mj_step(task.model, data)
        np.testing.assert_array_equal(data.sensordata, sensors)
        yield data


def touches(model, data, parts):
    """Contacts of robot and person: normal force [N], place, and the bodies' names.

    Args:
        model: The scene.
        data: Its state.
        parts: Names of the person's bodies.
    """
    robot, force = model.body(jaco.BASE_BODY).id, np.zeros(6)
    for index, contact in enumerate(data.contact):
        bodies = model.geom_bodyid[list(contact.geom)]
        names = {model.body(int(body)).name for body in bodies}
        if robot in model.body_rootid[bodies] and names & set(parts):
            mujoco.mj_contactForce(model, data, index, force)
            yield force[0], contact.pos, names
