"""Which episodes are shown: those of a run's points, by rules that are stated, or a new one."""

from __future__ import annotations

import json

import pytest

from rigid.errors import UserError
from rigid.report.sources import open_run, played, point_called, scene_of, stored, worst_by_band
from tests.report.struck import POINTS, run_of_strikes


@pytest.fixture(scope="module")
def directory(sample_payload, struck_task, tmp_path_factory):
    payload = sample_payload(seeds=1, replays=0)
    return run_of_strikes(tmp_path_factory.mktemp("struck"), struck_task, payload)


@pytest.fixture(scope="module")
def run(directory):
    return open_run(directory)


def test_in_each_band_of_naturalness_the_worst_sound_point_is_picked(run):
    assert [point["id"] for point in worst_by_band(run.frontier.points)] == ["s0-r1-l0", "s0-r1-l2"]


def test_a_point_at_the_end_of_a_band_belongs_to_the_more_natural_one(run):
    (point, *_) = run.frontier.points
    ends = [{**point, "id": str(x), "naturalness": x} for x in (0.0, 0.39, 0.4, 0.79, 0.8, 1.0)]
    picked = worst_by_band(ends)  # Equally bad ones: the most natural.
    assert [point["id"] for point in picked] == ["1.0", "0.79", "0.39"]


def test_a_run_whose_every_point_ran_away_shows_nothing(run):
    ran_away = [point for point in run.frontier.points if point["faults"]]
    with pytest.raises(UserError, match="no adversary whose physics held"):
        worst_by_band(ran_away)


def test_a_point_is_found_by_its_id_or_all_ids_are_told(run):
    assert point_called(run.frontier, "s0-r1-l3")["faults"] == 50
    with pytest.raises(UserError, match=f"'l3' is none of this run's: {', '.join(POINTS)}"):
        point_called(run.frontier, "l3")


def test_the_worst_episode_stands_beside_canonical_motion(run):
    shown = stored(run, run.frontier.points[0], "worst")
    assert shown.title == (
        "s0-r1-l0 · λ 0.25 · naturalness 0.85 · adversarialness 0.30\n"
        "worst episode: return -7.0, unwanted contact"
    )
    assert len(shown.motion.touches) > 0
    assert shown.canonical.touches == ()


def test_the_median_episode_is_another(run):
    shown = stored(run, run.frontier.points[0], "median")
    assert shown.title.endswith("median episode: return 9.0, helped")
    assert shown.motion.touches == ()


def test_the_task_of_strangers_is_looked_up_only_when_the_user_names_it(
    directory, struck_task, tmp_path
):
    for name in ("frontier.json", "settings.json"):
        (tmp_path / name).write_bytes((directory / name).read_bytes())
    settings = json.loads((tmp_path / "settings.json").read_text())
    settings["identity"]["task"]["name"] = "evil"
    (tmp_path / "settings.json").write_text(json.dumps(settings))
    with pytest.raises(UserError, match="measured on 'evil', which is none of RIGID's own tasks"):
        open_run(tmp_path)
    assert (
        open_run(tmp_path, "itch-scratching").task.horizon == struck_task.horizon
    )  # The parameters are the run's.


def test_a_task_without_a_scene_cannot_be_drawn():
    from rigid.tasks.registry import make_task

    with pytest.raises(UserError, match="task 'analytic/hand-tracking' has no picture"):
        scene_of(make_task("analytic/hand-tracking"))


def test_a_new_episode_is_the_one_that_evaluate_measures(struck_task):
    from rigid.compute.evaluation import evaluate
    from rigid.policies.loading import load_policy

    names = {"robot": "builtin:vanilla", "human": "builtin:passive"}
    policies = [load_policy(name, task=struck_task, agent=agent) for agent, name in names.items()]
    found = evaluate(struck_task, *policies, episodes=1, seed=3)
    shown = played(struck_task, names["robot"], names["human"], seed=3)
    first, second = shown.title.split("\n")
    assert first == "builtin:vanilla with builtin:passive"
    assert second == f"seed 3: return {found['return']:.1f}, unhelped"
    assert shown.motion.last == struck_task.horizon
    assert shown.canonical is None
