"""What is kept of a study is laid out again, and made by nobody twice."""

from __future__ import annotations

import pytest

from benchmarks.kept import has_policy, keep_policy
from benchmarks.paper.making import Making
from benchmarks.paper.measuring import Measuring
from benchmarks.paper.places import Places
from benchmarks.paper.plan import Plan
from benchmarks.paper.running import jobs
from rigid.data.episodes import load_episodes
from rigid.policies.loading import policy_hash
from rigid.tasks.registry import make_task
from tests.benchmarks.paper.samples import PLAN

TASK = make_task("itch-scratching")
SHORT = Plan(
    preset=PLAN.preset, thorough=None, robot_seeds=(0,), command="none", canonical_episodes=2
)


def making(tmp_path, *, out="raw"):
    def scout(seed):
        pytest.fail(f"seed {seed} was searched")

    return Making(SHORT, Places(tmp_path / out, tmp_path / "results"), TASK, scout)


def test_seed_0_is_what_is_bundled(tmp_path):
    robot = making(tmp_path).robot("vanilla", 0)
    assert policy_hash(robot) == policy_hash(_bundled("vanilla"))
    assert has_policy(tmp_path / "results" / "robots" / "seed-0" / "vanilla")


def test_what_is_kept_goes_on_elsewhere_with_canonical_episodes_of_its_own(tmp_path):
    """Another recipe's robot, so that nothing bundled stands in for it."""
    here = making(tmp_path)
    here.pair(0)
    kept = Places(tmp_path / "raw", tmp_path / "results").kept_policy("gleave", 0)
    keep_policy(here.robot("vanilla", 0), kept)
    elsewhere = making(tmp_path, out="elsewhere")
    assert elsewhere.has_robot("gleave", 0)
    robot = elsewhere.robot("gleave", 0)
    assert policy_hash(robot) == policy_hash(kept)
    assert len(load_episodes(robot / "canonical.npz", task=TASK)) == 2


def test_every_recipe_of_the_first_seed_comes_before_those_of_the_next(tmp_path):
    measuring = Measuring(PLAN, Places(tmp_path / "raw", tmp_path / "results"), TASK)
    names = [job.name for job in jobs(PLAN, measuring, TASK.horizon)]
    assert names[:3] == ["pair 0", "robot vanilla 0", "frontier of vanilla 0"]
    assert names.index("frontier of robust-gt 0") < names.index("pair 1")
    assert names[-1] == "frontier of robust-gt 0 with preset paper"
    assert sum("frontier" in name for name in names) == 2 * 4 + 2 + 6 + 4


def _bundled(name):
    from rigid.policies.loading import BUNDLED

    return BUNDLED / "itch-scratching" / name
