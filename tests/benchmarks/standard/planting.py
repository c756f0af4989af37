"""Measurements of the study that are planted at once, and the robot that it would train."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace

from benchmarks.robots import OWN_HUMAN, RobotPlan
from benchmarks.standard import running
from benchmarks.standard.plan import PLAN, Robot
from rigid.compute.run.directory import open_run
from rigid.policies.loading import BUNDLED, load_policy, policy_hash
from tests.benchmarks.standard.samples import frontier

VANILLA = Robot("vanilla")
TRAINED = Robot("i100-s0", RobotPlan(iterations=100, seed=0))  # As the bundled one was made.
SMALL = replace(PLAN, robots=(VANILLA, TRAINED), seeds=(0, 1))


def store_robot(out):
    """The robot that the study would train."""
    bundled = str(BUNDLED / "itch-scratching" / "vanilla")
    shutil.copytree(bundled, out / "i100-s0" / "robot")


def planting(patch, until=None):
    """Lets every measurement be planted at once, and returns the list of them, in their order.

    Args:
        patch: Of pytest.
        until: Number of the measurement at which the study is interrupted.
    """
    parts = []

    def measure_each(orders, executor):
        del executor
        for order in orders:
            if len(parts) == until:
                raise KeyboardInterrupt
            parts.append(order.out.parts[-3:])
            plant(order)
            order.listener.advance(order.env_steps)
            yield order

    patch.setattr(running, "measure_each", measure_each)
    return parts


def plant(order):
    """A finished run directory: `standard` finds attacks that are lower by 0.2."""
    (seed,) = order.seeds
    opened = open_run(order.out, identity(order), [seed], ["a test"])
    height = 0.5 + 0.1 * seed - (0.2 if order.preset.name == "standard" else 0.0)
    data = frontier({seed: height}).data
    opened.directory.frontier.write_text(json.dumps(data), encoding="utf-8")


def identity(order):
    """Of a measurement of the bundled robot, which is the trained one as well."""
    budget = order.preset.describe()
    del budget["seeds"]
    task = order.subject.task
    robot, human = (
        policy_hash(load_policy(spec, task=task, agent=agent))
        for spec, agent in (("builtin:vanilla", "robot"), (OWN_HUMAN, "human"))
    )
    return {
        "preset": budget, "robot": robot, "human": human, "task": dict(task.describe()),
        "measure": "lsgan", "adversary": {"rate": order.preset.name},
    }  # fmt: skip
