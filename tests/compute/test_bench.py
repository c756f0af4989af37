"""Speed is measured on the real task, and what is timed against each other does the same work."""

from __future__ import annotations

import json

import numpy as np
import pytest

from rigid import presets
from rigid.compute import bench
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.compute.tiny import TINY
from tests.tasks.scripted import random_actions


@pytest.fixture
def _small(monkeypatch):
    monkeypatch.setitem(presets.PRESETS, "paper", TINY)


def test_the_bare_physics_goes_through_the_same_motion():
    task, rng = ItchScratching(), np.random.default_rng(0)
    world = task.make_world(6, threads=1)
    world.reset(np.arange(6))
    motion = [world.snapshot()]
    for _ in range(20):
        world.step(*random_actions(rng, 6))
        motion.append(world.snapshot())
    end = bench.step_through(task, np.stack(motion))
    # Snapshots are of single precision.
    np.testing.assert_allclose(end, motion[-1][:, : task.model.nq], atol=1e-3)


@pytest.mark.usefixtures("_small")
def test_bench_writes_what_the_contract_names_and_shows_the_last_run(capsys, tmp_path):
    from rigid.cli import run

    file = tmp_path / "latest.json"
    file.write_text('{"startup_s": 0.125}')
    assert run(["bench", "--repeats", "1", "--json", str(file)]) == 0
    found = json.loads(file.read_text())
    for name in ("physics_env_steps_per_s", "training_env_steps_per_s", "training_over_physics",
                 "paper_core_hours", "startup_s"):  # fmt: skip
        assert found[name] > 0, name
    assert found["standard_wall_s"] is None
    assert found["threads"] >= 1
    assert (found["physics_step"], found["substeps"]) == (0.02, 5)
    shown = capsys.readouterr().out
    assert f"{found['startup_s']:,} s   (last run: 0.125)" in shown
    assert "preset standard         not measured" in shown


def test_bench_without_repeats_exits_with_2(capsys):
    from rigid.cli import run

    assert run(["bench", "--repeats", "0"]) == 2
    assert "--repeats is 0, but must be at least 1" in capsys.readouterr().err
