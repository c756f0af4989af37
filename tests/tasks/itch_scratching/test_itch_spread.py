"""Itches anywhere along the limbs: drawn, felt, scratched and shown at one place."""

from __future__ import annotations

import json

import mujoco
import numpy as np
import pytest

from rigid.files import first_difference
from rigid.tasks.itch_scratching.scene import LIMBS, build_spec
from rigid.tasks.itch_scratching.sensing import Sensors
from rigid.tasks.registry import task_from_description
from tests.tasks.scripted import Scratcher, still

SEEDS = np.arange(6)


@pytest.fixture(scope="module")
def spread(task):
    """The itch lies up to a tenth of half a limb from the middle: scratching there finds most."""
    return task.with_parameters(itch_spread=0.1)


@pytest.fixture(scope="module")
def scratched(spread):
    """A scripted robot scratches the middle: per step state, control, snapshot and Step."""
    world = spread.make_world(len(SEEDS), threads=1)
    step = world.reset(SEEDS)
    robot, rows = Scratcher(spread, world), [(None, None, world.snapshot(), step)]
    for _ in range(40):
        state = world._batch.state.copy()
        step = world.step(robot.act(world.itch), still(len(SEEDS))[1])
        rows.append((state, world._batch.bind("ctrl").copy(), world.snapshot(), step))
    return world, rows


def itch_in(model, snapshot):
    """The model with the itch of a snapshot moved to where it was, and the limb."""
    limb = int(snapshot[-2])
    site = model.site(f"itch_{LIMBS[limb]}")
    site.pos[2] -= snapshot[-3]
    return model, site.name


def test_a_fixed_itch_is_described_as_ever_and_a_spread_one_is_not(task, spread):
    assert "itch_spread" not in task.describe()["parameters"]
    assert spread.describe()["parameters"]["itch_spread"] == 0.1
    assert task.diversified().parameters.itch_spread == 1.0
    assert task.with_parameters(itch_spread=0.0).describe() == task.describe()
    again = task_from_description(json.loads(json.dumps(spread.describe())))
    assert again.parameters == spread.parameters


def test_what_belongs_to_fixed_itches_is_told_from_what_belongs_to_spread_ones(task, spread):
    """Both ways, and of an age that did not know of spread ones."""
    told = ("version", 0, "0-spread")
    assert first_difference(task.describe(), spread.describe()) == told
    wider = task.with_parameters(itch_spread=0.2)
    assert first_difference(spread.describe(), wider.describe()) == (
        "parameters.itch_spread", 0.1, 0.2
    )  # fmt: skip


def test_everything_else_of_an_episode_is_drawn_as_without_spread(task, spread):
    fixed, moved = (one.make_world(len(SEEDS), threads=1) for one in (task, spread))
    fixed.reset(SEEDS)
    moved.reset(SEEDS)
    np.testing.assert_array_equal(fixed.itch, moved.itch)
    np.testing.assert_array_equal(fixed._start, moved._start)
    assert fixed.snapshot().shape[1] + 1 == moved.snapshot().shape[1]


def test_itches_lie_along_the_whole_limb_on_its_outer_side(task):
    world = task.diversified().make_world(200, threads=1)
    step = world.reset(np.arange(200))
    seen = step.human_observation[:, 10:13]
    arm = step.human_observation[:, 23:32].reshape(-1, 3, 3)
    for index, limb, (upper, lower) in ((0, "forearm", (1, 2)), (1, "upper_arm", (0, 1))):
        rows = world.itch == index
        down = arm[rows, lower] - arm[rows, upper]
        down /= np.linalg.norm(down, axis=1, keepdims=True)
        along = ((seen[rows] - arm[rows, upper]) * down).sum(axis=1)
        middle = -task.model.site(f"itch_{limb}").pos[2]
        assert 0 < along.min() < 0.1 * middle
        assert 1.9 * middle < along.max() < 2 * middle
        away = np.linalg.norm(seen[rows] - arm[rows, upper] - along[:, None] * down, axis=1)
        radius = task.model.geom(f"right_{limb}").size[0]
        np.testing.assert_allclose(away, radius, atol=1e-5)


@pytest.fixture(scope="module")
def again(spread, scratched):
    """Every world's steps again, each on a model whose site was moved to its own itch.

    Yields per world: limb, sensors of that model, and per step its sensordata, scene and Step.
    """
    _, rows = scratched
    worlds = []
    for number, snapshot in enumerate(rows[0][2]):
        model, site = itch_in(build_spec(spread.parameters).compile(), snapshot)
        data, steps = mujoco.MjData(model), []
        for state, control, _, step in rows[1:]:
            whole = mujoco.mjtState.mjSTATE_INTEGRATION.value
            mujoco.mj_setState(model, data, state[number], whole)
            data.ctrl[:] = control[number]
            records = []
            for _ in range(spread.parameters.substeps):
                mujoco.mj_step(model, data)  # Leaves the kinematics of before its integration.
                records.append(data.sensordata.copy())
            steps.append((np.array(records)[None], data.site(site).xpos.copy(), step))
        worlds.append((np.array([int(snapshot[-2])]), Sensors(model), steps))
    return worlds


def test_the_person_feels_the_itch_where_a_moved_site_is(spread, again):
    for number, (_, _, steps) in enumerate(again):
        for _, place, step in steps:
            felt = step.human_observation[number]
            np.testing.assert_allclose(felt[10:13], place - spread.chest, atol=1e-6)
            np.testing.assert_allclose(felt[7:10], felt[:3] - felt[10:13], atol=1e-6)
            gap = np.linalg.norm(felt[7:10])
            assert step.info["distance"][number] == pytest.approx(gap, abs=1e-6)


def test_contacts_are_those_that_count_at_a_moved_site(again, scratched):
    moved, seen = [], []
    for number, (limb, sensors, steps) in enumerate(again):
        for data, _, step in steps:
            moved.append(sensors.contacts(data, limb).force_itch.max())
            seen.append(step.info["force_itch"][number])
    np.testing.assert_allclose(seen, moved, atol=1e-9)
    assert max(moved) > 0
    assert (scratched[0]._shift != 0).all()


def test_the_replay_marks_the_itch_where_it_was(spread, scratched):
    _, rows = scratched
    snapshots = np.stack([row[2] for row in rows], axis=1)
    for number in (0, 1):
        shown = spread.replay(snapshots[number])
        middle = spread.model.site(f"itch_{shown['itch']['limb'].replace(' ', '_')}").pos
        assert shown["itch"]["pos"][2] == pytest.approx(
            middle[2] - snapshots[number, 0, -3], abs=1e-5
        )
        assert shown["itch"]["pos"][:2] == pytest.approx(middle[:2], abs=1e-5)
        # Distances of the replay are those of the end of a step, the reward's are a step older.
        told = [row[3].info["distance"][number] for row in rows[1:]]
        np.testing.assert_allclose(shown["distance"][1:], told, atol=0.02)
