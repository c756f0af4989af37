"""Recordings become control steps; each bad episode is named with its reason, and the rest used."""

from __future__ import annotations

import json

import numpy as np
import pytest

from rigid.data.episodes import load_episodes, save_episodes
from rigid.errors import UserError
from rigid.tasks.protocol import AgentSpec
from tests.data.takes import TASK, brought_in, samples, write
from tests.toys import ToyReach

GOOD = {f"e{i}": samples(speed=0.8 + 0.1 * i) for i in range(4)}


@pytest.fixture
def path(tmp_path):
    return tmp_path / "people.csv"


def refused(imported):
    return {verdict.episode: verdict.reason for verdict in imported.verdicts if not verdict.used}


@pytest.mark.parametrize("hz", [10.0, 25.0, 120.0, 4.0])
def test_samples_of_any_rate_become_control_steps(path, hz):
    found = brought_in(write(path, {"a": samples(hz=hz)})).episodes
    # Features are of the state that each step led to.
    np.testing.assert_allclose(found.features[0, :, 0], np.arange(1, 11) / 10, atol=3e-3)
    np.testing.assert_allclose(found.times[0], np.arange(1, 11) / 10)
    assert (found.features[0, :, 1] == 1).all()
    assert found.about.recorded_rate == hz


def test_observations_and_actions_are_those_before_the_step(path):
    time = np.arange(51) / 50
    told = {f"observation_{i}": time + i for i in range(3)} | {"action_0": 0.5 * time}
    found = brought_in(write(path, {"a": samples(**told)})).episodes
    before = np.arange(10) / 10
    np.testing.assert_allclose(found.observations[0, :, 2], before + 2, atol=1e-6)
    np.testing.assert_allclose(found.actions[0, :, 0], 0.5 * before, atol=1e-6)


def test_labels_come_from_the_nearest_sample(path):
    goal = np.where(np.arange(9) / 8 < 0.55, -1, 1)  # 8 Hz: the samples beside are 0.5 and 0.625 s.
    found = brought_in(write(path, {"a": samples(hz=8, goal=goal)})).episodes
    assert found.features[0, 4:6, 1].tolist() == [-1, 1]
    assert set(found.features[0, :, 1]) == {-1.0, 1.0}


def test_rewards_are_summed_over_the_steps_and_make_the_return(path):
    reward = np.where(np.arange(51) < 50, 0.2, 100.0)  # The last sample begins no step.
    found = brought_in(write(path, {"a": samples(reward=reward)})).episodes
    np.testing.assert_allclose(found.rewards[0], np.ones(10), atol=1e-6)
    assert found.returns[0] == pytest.approx(10.0)


def test_what_was_told_of_a_whole_that_is_cut_is_unknown(path):
    whole = {"a": samples(**{"return": 7.0}), "b": samples(seconds=2, speed=0.9)}
    whole["b"]["return"] = np.full(101, 7.0)
    found = brought_in(write(path, whole))
    assert [verdict.remark for verdict in found.verdicts] == [
        "", "cut to the first 10 steps (1.0 s left out)",
    ]  # fmt: skip
    assert found.episodes.returns[0] == 7.0
    assert np.isnan(found.episodes.returns[1])


def test_rows_that_are_steps_are_taken_as_they_are(path):
    columns = {name: column[:10] for name, column in samples(hz=10).items() if name != "time"}
    steps = {"step": np.arange(10), **columns, "seed": np.full(10, 42)}
    found = brought_in(write(path, {"a": steps})).episodes
    np.testing.assert_array_equal(found.features[0, :, 0], columns["hand"].astype(np.float32))
    assert (found.seeds[0], found.provenance["seeds"]) == (42, "recorded")


def test_counted_samples_are_sampled_at_the_rate_that_is_given(path):
    counted = samples(hz=50)
    counted = {"step": np.arange(51), **{n: c for n, c in counted.items() if n != "time"}}
    found = brought_in(write(path, {"a": counted}), rate=50.0).episodes
    np.testing.assert_allclose(found.features[0, :, 0], np.arange(1, 11) / 10, atol=3e-3)


class Moving(ToyReach):
    """The toy task with a velocity among its features."""

    feature_names = ("hand", "hand_velocity")


@pytest.mark.parametrize("hz", [4.0, 10.0, 20.0, 25.0, 120.0])
@pytest.mark.parametrize("left_out", [0, 1])
def test_velocities_are_finite_and_right_with_and_without_a_sample_at_the_end(path, hz, left_out):
    whole = samples(hz=hz, speed=0.7)
    rows = {name: column[: len(column) - left_out] for name, column in whole.items()}
    found = brought_in(write(path, {"a": rows}), task=Moving())
    if hz == 4 and left_out:  # More than a control period is missing then.
        assert refused(found) == {"a": "too short: 0.75 s of 1 s"}
    else:
        np.testing.assert_allclose(found.episodes.features[0, :, 1], 0.7, atol=0.06)


@pytest.mark.parametrize(
    ("unit", "factor", "spacing"), [("ms", 1e3, "20"), ("us", 1e6, "2e+04"), ("ns", 1e9, "2e+07")]
)
def test_a_clock_in_another_unit_is_refused_with_the_unit_for_the_map(path, unit, factor, spacing):
    columns = samples()
    columns["time"] = columns["time"] * factor
    (reason,) = refused(brought_in(write(path, {"a": columns}))).values()
    assert reason == (
        f"one sample every {spacing} s, but a step of the task is 0.1 s: is `time` in {unit}? "
        f'give "unit": "{unit}" in --map'
    )


def test_samples_too_far_apart_to_show_motion_are_refused_with_the_rate_that_is_needed(path):
    found = brought_in(write(path, {"a": samples(hz=2)}))
    assert refused(found)["a"].endswith("a step of the task is 0.1 s: record at 3.33 Hz or more")


@pytest.mark.parametrize("seed", [-1, 1.7])
def test_a_seed_that_is_no_whole_number_from_0_on_is_refused(path, seed):
    episodes = {"a": samples(seed=3), "b": samples(seed=seed, speed=0.9)}
    found = brought_in(write(path, episodes))
    assert refused(found) == {"b": f"seed {seed:g} is none: a seed is a whole number, 0 or more"}


def test_success_of_a_whole_that_is_cut_is_unknown(path):
    whole = {"a": samples(seconds=2, success=1), "b": samples(speed=0.9, success=1)}
    found = brought_in(write(path, whole))
    np.testing.assert_array_equal(found.episodes.success, [np.nan, 1])


def aimed(path, tmp_path, aims):
    """The episode with a text for its goal, and a map that looks for 'left'."""
    write(path, {"a": {**samples(), "aim": np.asarray(aims, dtype=object)}})
    (tmp_path / "map.json").write_text('{"goal": {"from": "aim", "equals": "left"}}')
    return brought_in(path, map_=tmp_path / "map.json")


def test_a_text_that_no_table_holds_is_refused_with_those_that_are_there(path, tmp_path):
    with pytest.raises(
        UserError, match=r"'aim' nowhere holds 'left', .*; it holds 'Left', 'right'"
    ):
        aimed(path, tmp_path, ["Left"] * 26 + ["right"] * 25)


def test_an_empty_cell_is_unknown_and_no_other_text(path, tmp_path):
    found = aimed(path, tmp_path, ["left"] * 20 + [""] * 31)
    assert refused(found) == {"a": "no number in 31 rows of 'goal', the first is row 21"}


def test_damage_beside_a_table_is_said_with_its_entry(path):
    write(path, GOOD)
    path.with_name("people.csv.json").write_text('{"about": {"consent": true}}')
    with pytest.raises(UserError, match=r"people\.csv is damaged: about\.consent: Input should be"):
        brought_in(path)


def test_velocities_that_are_missing_are_computed_and_told(path):
    found = brought_in(write(path, {"a": samples(speed=0.7)}), task=Moving())
    assert found.computed == ("hand",)
    np.testing.assert_allclose(found.episodes.features[0, :, 1], 0.7, atol=0.03)


def broken():
    """One episode of each kind of fault, and the words that name it."""
    nan, gap, frozen = samples(speed=1.5), samples(speed=1.6), samples(speed=1.7)
    nan["hand"][20] = None
    gap = {name: np.delete(column, range(20, 30)) for name, column in gap.items()}
    frozen["hand"][15:] = frozen["hand"][15]
    back = samples(speed=1.8)
    back["time"][10] = 0.0
    who = samples(speed=1.9)
    who["participant"] = np.array(["P1"] * 25 + ["P2"] * 26, dtype=object)
    return {
        "short": (samples(seconds=0.6, speed=1.4), "too short: 0.60 s of 1 s"),
        "nan": (nan, "no number in 1 rows of 'hand', the first is row 21"),
        "gap": (gap, "gap: no sample for 0.22 s from 0.38 s on"),
        "frozen": (frozen, "frozen: 'hand' holds one number for 80% of the episode"),
        "back": (back, "time does not rise: row 11 is at 0 s, after one at 0.18 s"),
        "twin": (samples(speed=0.8), "the same as episode 'e0'"),
        "who": (who, "mixed: participants 'P1', 'P2' in one episode"),
    }


@pytest.mark.parametrize("kind", broken())
def test_a_broken_episode_is_named_and_the_good_ones_are_used(path, kind):
    bad, reason = broken()[kind]
    episodes = {**GOOD, "bad": bad}
    if "participant" in bad:
        episodes = {
            name: {"participant": np.full(len(columns["time"]), "P1", dtype=object), **columns}
            for name, columns in episodes.items()
        }
    found = brought_in(write(path, episodes))
    assert refused(found) == {"bad": reason}
    assert len(found.episodes) == 4


def test_an_action_in_other_units_is_out_of_range(path):
    told = {f"observation_{i}": 0.0 for i in range(3)}
    episodes = {"a": samples(**told, action_0=0.5), "b": samples(**told, action_0=35.0, speed=2.0)}
    found = brought_in(write(path, episodes))
    assert refused(found) == {"b": "out of range: action 0 is 35, outside [-1, 1]"}


def test_joints_beyond_their_limits_are_out_of_range():
    from rigid.data.importing import feature_limits
    from rigid.tasks.itch_scratching.task import ItchScratching

    low, high = feature_limits(ItchScratching())["elbow"]
    assert low < -2.2 < 0 < high < 1  # -128° to 0°, and a little slack: 90 "rad" is far outside.


def test_choices_become_scores_and_others_are_named(path):
    class Choosing(ToyReach):
        def __init__(self):
            super().__init__()
            self.human = AgentSpec(3, 2, ("robot", "hand", "goal"), choices=(2,))

    told = {f"observation_{i}": 0.0 for i in range(3)}
    episodes = {"a": samples(**told, action=1), "b": samples(**told, action=2, speed=2.0)}
    found = brought_in(write(path, episodes), task=Choosing())
    assert (found.episodes.actions[0] == [-1, 1]).all()
    assert refused(found) == {"b": "out of range: 'action' is 2, no choice from 0 to 1"}


def test_episodes_of_several_robots_need_a_choice(path):
    episodes = {
        name: {**columns, "robot": np.full(51, "jaco" if name != "e0" else "kuka", dtype=object)}
        for name, columns in GOOD.items()
    }
    write(path, episodes)
    with pytest.raises(UserError, match=r"2 robots \('jaco', 'kuka'\).*choose it, as with --met"):
        brought_in(path)
    found = brought_in(path, robot="jaco")
    assert refused(found) == {"e0": "met robot 'kuka', not 'jaco'"}


def test_a_map_renames_converts_and_tells_units(path, tmp_path):
    hand = np.rad2deg(np.arange(51) / 50)
    raw = {"trial": "x", "ms": np.arange(51) * 20, "Hand_deg": hand, "aim": "left"}
    rows = zip(*(np.broadcast_to(np.asarray(c, dtype=object), 51) for c in raw.values()),
               strict=True)  # fmt: skip
    text = "\n".join([";".join(raw), *(";".join(map(str, row)) for row in rows)])
    path.write_text("\ufeff" + text + "\n", encoding="utf-8")
    (tmp_path / "map.json").write_text(json.dumps({
        "episode": "trial", "time": {"from": "ms", "unit": "ms"},
        "hand": {"from": "Hand_deg", "unit": "deg"}, "goal": {"from": "aim", "equals": "left"},
    }))  # fmt: skip
    found = brought_in(path, map_=tmp_path / "map.json").episodes
    np.testing.assert_allclose(found.features[0, :, 0], np.arange(1, 11) / 10, atol=1e-6)
    assert (found.features[0, :, 1] == 1).all()
    assert found.about.units == {"hand": "rad"}


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"from": "x", "unit": "furlong"}, "hand: unit 'furlong' is unknown, known are rad, deg"),
        ({"unit": "deg"}, r'hand: give either "from" \(a column\) or "value" \(a number\)'),
        ({"from": "x", "equals": "a", "unit": "m"}, 'hand: "equals" gives 1 or 0, so leave "unit"'),
        ({"from": "x", "skale": 2}, "hand.skale: Extra inputs are not permitted"),
        ("nothing", "people has no column 'nothing', from which the map takes 'hand'"),
    ],
)
def test_a_bad_map_is_refused_with_its_entry(path, tmp_path, entry, message):
    write(path, GOOD)
    (tmp_path / "map.json").write_text(json.dumps({"hand": entry}))
    with pytest.raises(UserError, match=message):
        brought_in(path, map_=tmp_path / "map.json")


def test_every_file_of_a_folder_is_an_episode(tmp_path):
    for name, columns in GOOD.items():
        write(tmp_path / f"{name}.csv", {name: columns})
        text = (tmp_path / f"{name}.csv").read_text().splitlines()
        stripped = "\n".join(line.partition(",")[2] for line in text)
        (tmp_path / f"{name}.csv").write_text(stripped)
    found = brought_in(tmp_path)
    assert [verdict.episode for verdict in found.verdicts] == list(GOOD)
    assert len(found.episodes) == 4


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty or no table: give a CSV file with a header line"),
        ("time,hand,goal\n", "has a header and no rows"),
        ("time,hand,goal\n0,1\n", "row 1 has 2 cells, but the header 3"),
        ("time,hand,hand\n0,1,1\n", "has two columns 'hand': name each one once"),
        ("time,hand,goal\n0,1;2,1\n", "row 1, column 'hand' holds '1;2', which is no number"),
        ("hand,goal\n0,1\n", r"has neither a column 'time' \[s\] nor 'step'; it has goal, hand"),
        ("time,hnd,goal\n0,1,1\n", r"has no column 'hand' \(is it 'hnd'\?\); missing are hand"),
        (
            "time,hand,goal,observation_1\n0,1,1,1\n",
            "only some observations; missing are",
        ),
    ],
)
def test_a_table_that_cannot_be_read_is_refused_with_its_cure(path, text, message):
    path.write_text(text)
    with pytest.raises(UserError, match=message):
        brought_in(path)


def test_where_the_task_declares_no_features_observations_and_actions_are_needed(path):
    class Bare(ToyReach):
        feature_names = ()

    write(path, GOOD)
    with pytest.raises(UserError, match="declares no features, so that they are what naturalness"):
        brought_in(path, task=Bare())


def test_what_was_imported_can_be_stored(path, tmp_path):
    people = {
        name: {**columns, "participant": np.full(51, f"P{i}"), "notes": np.full(51, "calm")}
        for i, (name, columns) in enumerate(GOOD.items())
    }
    save_episodes(tmp_path / "people.npz", brought_in(write(path, people)).episodes)
    found = load_episodes(tmp_path / "people.npz", task=TASK)
    assert found.source == "recorded"
    assert found.about.participants == ("P0", "P1", "P2", "P3")
    assert found.about.episodes[2].name == "e2"
    assert found.about.episodes[2].notes == "calm"
