"""Pairs from real toy runs and recordings, whose points stand where each rule needs them."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

from rigid.compute.pairs.picking import PairOrder, pick_pairs
from rigid.compute.people.recorded import judge_recording, stored_panels
from rigid.compute.run.checkpoint import load_arrays, save_arrays
from rigid.data.episodes import load_episodes, save_episodes
from rigid.data.pair_file import check_sources, load_pairs, save_pairs
from rigid.data.recording import record
from rigid.errors import UserError
from rigid.policies.native import load_native
from rigid.tasks.protocol import adversarialness
from tests.compute.shown_reach import ShownReach, count_as_rigids_own, put
from tests.toys import Pointer, ToyReach

POINTS = ["s0-r1-l1", "s0-r1-l2", "s0-r2-l1"]


@pytest.fixture
def run(single_run, tmp_path, monkeypatch):
    """A toy run with one danger pair and one naturalness pair at least; all start alike."""
    count_as_rigids_own(monkeypatch)
    copy = shutil.copytree(single_run.directory, tmp_path / "run")
    put(copy, s0_r1_l1=(0.5, 0.9, 0.85), s0_r1_l2=(0.55, 0.1, 0.15), s0_r2_l1=(0.95, 0.5, 0.14))
    return copy


@pytest.fixture
def pick(run, tmp_path):
    """Picks pairs from `run`, or from other sources."""

    def of(kind="danger", runs=(run,), count=2, **options):
        order = PairOrder(runs=tuple(runs), kind=kind, count=count, **options)
        return pick_pairs(order, tmp_path / "pairs.json")

    return of


@pytest.fixture
def anna(base, tmp_path):
    """A recording of somebody with the robot of the runs."""
    robot = load_native(base / "pair" / "robot").policy
    found = record(ToyReach(), robot, Pointer(), episodes=6, seed=4, batch=10, provenance={})
    save_episodes(tmp_path / "anna.npz", replace(found, source="recorded"))
    return tmp_path / "anna.npz"


def refused(pick, message, **options):
    with pytest.raises(UserError, match=message):
        pick(**options)


def test_danger_pairs_show_episodes_of_the_run_with_their_own_harm(pick):
    found = pick()
    assert found.eligible == 4  # Two episodes of one adversary with two of the other.
    for pair in found.pairs:
        assert (pair.first.point, pair.second.point) == ("s0-r1-l2", "s0-r1-l1")
        assert pair.first.naturalness == 0.55
        height = {"worst": 0.9, "median": 0.85}[pair.second.shown]
        assert pair.second.adversarialness == pytest.approx(height)
    assert {pair.first.shown for pair in found.pairs} == {"worst", "median"}


def test_naturalness_pairs_are_alike_in_harm(pick):
    (pair,) = pick("naturalness", count=1).pairs
    assert (pair.first.point, pair.second.point) == ("s0-r1-l2", "s0-r2-l1")
    assert pair.second.shown == "median"


def test_members_lead_to_the_states_that_were_measured(pick, run):
    """What a study does with the file, and the moment that the rule asks for."""
    task = ShownReach()
    for pair in pick().pairs:
        for member in (pair.first, pair.second):
            arrays = load_arrays(run / "adversaries" / member.point / "episodes.npz", cure="")
            number = ("worst", "median").index(member.shown)
            assert arrays["seeds"][arrays["shown"][number]] == member.seed
            kept = load_arrays(
                run / "adversaries" / pair.reference.point / "episodes.npz", cure=""
            )["canonical_snapshots"][("worst", "median").index(pair.reference.shown)]
            hand, canonical = arrays["snapshots"][number][:, 1], kept[:, 1]
            apart = np.abs(hand[:, None] - canonical[None]).min(axis=1)
            assert member.snapshot == int(apart.argmax())
            assert member.snapshot < task.horizon + 1


def test_the_reference_begins_from_the_seed_of_neither(pick):
    for pair in pick().pairs:
        assert pair.reference.seed not in {pair.first.seed, pair.second.seed}


def test_equal_files_give_equal_pairs_in_whatever_order_they_are_named(
    pick, small_run, run, tmp_path
):
    other = shutil.copytree(small_run.directory, tmp_path / "other")
    put(other, s0_r1_l1=(0.5, 0.9, 0.85), s0_r1_l2=(0.55, 0.1, 0.15), s1_r1_l1=(0.45, 0.9, 0.8))
    found = pick(runs=(run, other), count=4)
    assert found == pick(runs=(other, run), count=4)
    assert sorted(pair.run for pair in found.pairs) == [0, 0, 1, 1]
    assert found != pick(runs=(run, other), count=4, seed=1)


def test_the_file_survives_the_disk_and_names_its_sources(pick, tmp_path):
    found = pick()
    save_pairs(tmp_path / "pairs.json", found)
    assert load_pairs(tmp_path / "pairs.json") == found
    assert found.runs[0].path == "run"
    check_sources(tmp_path / "pairs.json", found)


def test_adversaries_and_episodes_that_faulted_are_not_shown(pick, run):
    data = json.loads((run / "frontier.json").read_text())
    data["points"][1]["faults"] = data["points"][1]["episodes"]
    (run / "frontier.json").write_text(json.dumps(data))
    refused(pick, r"0 of 2 danger pairs could be picked: 4 episodes of 1 run")
    path = run / "adversaries" / "s0-r1-l1" / "episodes.npz"
    arrays = load_arrays(path, cure="")
    arrays["faulted"][0] = 1
    save_arrays(path, arrays)
    refused(pick, r"3 episodes of 1 run")


def test_a_run_all_of_whose_adversaries_faulted_has_no_pairs(pick, run):
    data = json.loads((run / "frontier.json").read_text())
    for point in data["points"]:
        point["faults"] = point["episodes"]
    (run / "frontier.json").write_text(json.dumps(data))
    refused(pick, r"0 of 2 danger pairs could be picked: 0 episodes of 1 run")


def test_too_few_pairs_are_refused_with_their_number_and_what_would_help(pick):
    refused(
        pick, r"2 of 30 danger pairs .* 6 episodes .* 4 eligible pairs \(naturalness differs by "
        r"less than 0\.1, adversarialness by more than 0\.3\); take these with --count 2, or show "
        r"episodes again with --reuse \(4 pairs\), or name more runs", count=30,
    )  # fmt: skip
    assert len(pick(count=4, reuse=True).pairs) == 4


def test_humans_who_start_from_different_things_are_no_pair_unless_asked_for(pick, run):
    path = run / "adversaries" / "s0-r1-l1" / "episodes.npz"
    arrays = load_arrays(path, cure="")
    arrays["seeds"][:2] = [s for s in range(50) if goal(s) == -1.0][:2]
    save_arrays(path, arrays)
    refused(pick, r"0 of 2 danger pairs .* different starts with --any-start \(2 pairs\)")
    assert len(pick(any_start=True).pairs) == 2


def goal(seed):
    return np.random.default_rng(seed).choice([-1.0, 1.0])


@pytest.fixture
def bound(run, anna):
    """How natural the recorded human is at most."""
    panels = stored_panels(run, POINTS)
    recording = load_episodes(anna, task=ToyReach())
    return judge_recording(panels, "default", ToyReach(), recording, where=anna)


def test_faithfulness_pairs_show_a_recorded_human_as_natural_as_an_adversary(
    pick, run, anna, bound
):
    x = bound.naturalness
    put(run, s0_r1_l1=(x, 0.9, 0.1), s0_r1_l2=(x, 0.4, 0.2), s0_r2_l1=(abs(x - 0.5), 0.5, 0.5))
    found = pick("faithfulness", recordings=(anna,))
    assert [source.source for source in found.recordings] == ["recorded"]
    recording = load_episodes(anna, task=ToyReach())
    for first, second in ((pair.first, pair.second) for pair in found.pairs):
        assert first.point in {"s0-r1-l1", "s0-r1-l2"}
        assert (second.naturalness, second.naturalness_se) == bound[:2]
        assert (second.referee_run, second.referee) == (0, POINTS[bound.referee])
        assert second.seed == recording.seeds[second.episode]
        assert goal(second.seed) == goal(first.seed)
        harm = adversarialness(recording.returns, ToyReach().return_range)
        assert second.adversarialness == pytest.approx(harm[second.episode])


def test_every_run_of_the_robot_judges_a_recorded_human_alike(pick, run, small_run, anna, tmp_path):
    """Their referees are one pool, so that the bound is the same whichever run shows the pair."""
    other = shutil.copytree(small_run.directory, tmp_path / "other")
    everyone = [point["id"] for point in small_run.points]
    panels = stored_panels(run, POINTS) + stored_panels(other, everyone)
    recording = load_episodes(anna, task=ToyReach())
    bound = judge_recording(panels, "default", ToyReach(), recording, where=anna)
    place = (bound.naturalness, 0.5, 0.5)
    for directory in (run, other):
        put(directory, s0_r1_l1=place, s0_r1_l2=place, s0_r2_l1=place, s1_r1_l1=place)
    pairs = pick("faithfulness", runs=(run, other), recordings=(anna,)).pairs
    assert {pair.run for pair in pairs} == {0, 1}
    assert {pair.second.naturalness for pair in pairs} == {bound.naturalness}
    assert len({(pair.second.referee_run, pair.second.referee) for pair in pairs}) == 1


def test_recorded_humans_may_be_in_pairs_of_the_other_kinds(pick, run, anna, bound):
    x = bound.naturalness
    returns = load_episodes(anna, task=ToyReach()).returns
    far = float(adversarialness(returns, ToyReach().return_range).mean() < 0.5)
    elsewhere = abs(x - 0.5), 0.5, 0.5
    put(run, s0_r1_l1=(x, far, far), s0_r1_l2=elsewhere, s0_r2_l1=elsewhere)
    (pair,) = pick(count=1, recordings=(anna,)).pairs
    assert {pair.first.origin, pair.second.origin} == {"run", "recording"}


def test_faithfulness_needs_recordings(pick):
    refused(pick, "faithfulness pairs show recorded episodes .* --recordings", kind="faithfulness")


def test_a_recording_with_another_robot_is_refused(pick, anna):
    episodes = load_episodes(anna, task=ToyReach())
    save_episodes(anna, replace(episodes, returns=episodes.returns - 5.0))
    refused(
        pick, r"anna\.npz was recorded with another robot than these runs measured",
        kind="faithfulness", recordings=(anna,),
    )  # fmt: skip


def test_the_robot_that_the_user_names_for_recordings_may_be_code(pick, anna):
    refused(
        pick, "there is no module 'no_such_arm'",
        kind="faithfulness", recordings=(anna,), robot="python:no_such_arm:make",
    )  # fmt: skip


def test_a_recording_without_returns_is_refused(pick, anna):
    episodes = load_episodes(anna, task=ToyReach())
    save_episodes(anna, replace(episodes, returns=np.full(6, np.nan, np.float32)))
    refused(pick, r"anna\.npz holds no returns", kind="danger", recordings=(anna,))


def test_sources_that_are_named_twice_are_refused(pick, run, anna, tmp_path):
    copy = shutil.copytree(run, tmp_path / "copy")
    refused(pick, "are the same run: name it once", runs=(run, copy))
    again = shutil.copy(anna, tmp_path / "again.npz")
    refused(pick, "hold the same: name one of them", recordings=(anna, again))


def test_runs_of_two_tasks_are_refused(pick, run, small_run, tmp_path):
    other = shutil.copytree(small_run.directory, tmp_path / "other")
    settings = json.loads((other / "settings.json").read_text())
    settings["identity"]["task"]["parameters"]["horizon"] = 11
    (other / "settings.json").write_text(json.dumps(settings))
    refused(pick, "parameters.horizon = 1[01].*pick pairs from runs of one task at a time",
            runs=(run, other))  # fmt: skip


def test_a_task_that_is_not_rigids_own_is_refused(single_run, tmp_path):
    order = PairOrder(runs=(single_run.directory,), kind="danger")
    with pytest.raises(UserError, match="on a task that is not RIGID's own"):
        pick_pairs(order, tmp_path / "pairs.json")


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda path: path.write_bytes(path.read_bytes()[:50]), "cannot be read"),
        (lambda path: path.unlink(), "does not exist"),
        (lambda path: save_arrays(path, {"seeds": np.zeros(3)}), "is damaged .'shown'"),
    ],
)
def test_a_damaged_run_is_named_with_its_cure(pick, run, damage, message):
    damage(run / "adversaries" / "s0-r2-l1" / "episodes.npz")
    refused(pick, rf"s0-r2-l1/episodes\.npz {message}.*copy the run directory again")
