"""Failures of known cause get that kind, with the moment and the numbers that were planted."""

from __future__ import annotations

import numpy as np
import pytest

from rigid.report.episodes import arm_of, read_episode
from rigid.report.failure_kinds import KINDS, words
from rigid.report.failure_rules import RULES, classify
from tests.report import planted_episodes as plant
from tests.report.planted_episodes import canonical, moved, planted, seen, still, swinging, touching

ITCH, START = plant.ITCH, plant.START
PLAY = plant.canonical_replay()
AWAY = np.array([0.0, 0.06, 0.0])
ASIDE = ITCH + AWAY
REACH = np.linalg.norm(START + plant.FORE - plant.SHOULDER) + np.linalg.norm(plant.FORE)


def judge(replay, beside=None):
    return classify(seen(replay), canonical() if beside is None else beside)


def kind(replay, beside=None):
    return judge(replay, beside)["kind"]


def lost(since=20, count=15, away=AWAY):
    tip = moved(still(ITCH), since, away)
    return planted(tip, counted=range(since - count, since))


def wandering(far=0.1):
    """Neither still nor fast nor anywhere near: the tip drifts to and fro between two places."""
    tip = still(START)
    tip[:, 0] += far * np.sin(np.linspace(0, 4 * np.pi, plant.FRAMES))
    return tip


PLANTED = {
    "unwanted_contact": planted(
        still(), outcome="unwanted_contact", force=[(29, 3.0), (30, 12.0)],
        contacts=touching([30], START, plant.HEAD, plant.UNWANTED, 9.0)
        + touching([60], START, plant.FOREARM, plant.ITCHES, 40.0),
    ),
    "out_of_reach": planted(still(), moved(still(ITCH), 50, (2.0, 0, 0))),
    "spilled": planted(swinging(START, 0.03), spilled=[10, 30, 50, 90]),
    "thrashing": planted(swinging(START, 0.03)),
    "lost_contact": lost(),
    "wrong_limb": planted(
        still(), contacts=touching(range(40, 70), START, plant.UPPER_ARM, plant.ARM)
    ),
    "missed_spot": planted(
        still(ASIDE), contacts=touching(range(30, 60), ASIDE, plant.FOREARM, plant.ITCHES)
    ),
    "too_little": planted(moved(still(ASIDE), 40, -AWAY), counted=[50, 60, 70]),
    "stuck": planted(moved(still(), 20, (0.1, 0, 0))),
    "strayed": planted(np.linspace(START, START + (0, 0.5, 0), plant.FRAMES)),
    "kept_away": planted(wandering(), moved(still(ITCH), 40, (0.1, 0, 0))),
    "unclear": planted(wandering()),
}  # fmt: skip

FOUND = {  # Moment [s], and what is said of it.
    "unwanted_contact": (3.0, "the tool touched the head, at its hardest with 12.0 N"),
    "out_of_reach": (
        5.0,
        f"the itch was up to 2.40 m from the robot's shoulder; its arm reaches {REACH:.2f} m",
    ),
    "spilled": (5.0, "4 pieces of food fell, the third when the tool was 20 cm from the itch"),
    "thrashing": (
        0.1, "the tool went 3.0 m (canonical play: 1.6 m), and was up to 20 cm from the itch"
    ),
    "lost_contact": (
        1.9,
        "15 counted contacts and none after 1.9 s: from then on the tool was 6 cm from the itch",
    ),
    "wrong_limb": (
        4.0, "it touched the right upper arm for 3.0 s, but the itch was on the right forearm"
    ),
    "missed_spot": (3.0, "it touched the right forearm for 3.0 s, 6 cm from the itch"),
    "too_little": (4.0, "at the itch for 6.1 s, but 3 contacts counted"),
    "stuck": (2.0, "the tool hardly moved from 2.0 s on, 22 cm from the itch"),
    "strayed": (6.1, "the tool ended 70 cm from the itch, which had moved by 0 cm"),
    "kept_away": (
        4.0,
        "the itch was up to 50 cm from the robot's shoulder, in canonical play up to 40 cm",
    ),
    "unclear": (0.0, "the tool came no nearer to the itch than 20 cm"),
}  # fmt: skip


@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_failure_gets_its_kind_its_moment_and_its_numbers(name):
    found = judge(PLANTED[name])
    assert found["kind"] == name
    assert (found["time"], found["says"]) == FOUND[name]
    assert found["frame"] == round(found["time"] / plant.DT)
    assert found["part"] == ("head" if name == "unwanted_contact" else None)


def test_every_rule_is_planted_and_has_words_and_the_last_one_always_holds():
    assert tuple(PLANTED) == KINDS == tuple(name for name, _ in RULES)
    assert RULES[-1][1](canonical(), None) is not None


def test_a_helped_episode_did_not_fail():
    assert judge({**PLANTED["thrashing"], "outcome": "helped"}) is None


@pytest.mark.parametrize("name", ["poses", "itch", "contacts", "outcome", "distance"])
def test_a_task_that_does_not_tell_has_no_kind(name):
    replay = {key: value for key, value in PLANTED["stuck"].items() if key != name}
    assert judge(replay) is None


@pytest.mark.parametrize("name", ["lost_contact", "wrong_limb", "missed_spot", "too_little"])
def test_a_task_that_counts_no_contacts_knows_nothing_of_scratching(name):
    replay = {key: value for key, value in PLANTED[name].items() if key != "counted"}
    assert kind(replay) in {"stuck", "unclear"}


def test_two_pieces_of_food_may_fall():
    assert kind(planted(swinging(START, 0.03), spilled=[10, 30])) == "thrashing"


@pytest.mark.parametrize("name", ["out_of_reach", "spilled", "thrashing", "stuck", "strayed",
                                  "kept_away", "unclear"])  # fmt: skip
def test_what_is_said_of_an_episode_names_the_goal_of_the_task(name):
    pair = [read_episode({**plant.SCENE, "goal": "mouth"}, one) for one in (PLANTED[name], PLAY)]
    said = classify(*pair)["says"]
    assert said == FOUND[name][1].replace("itch", "mouth")
    assert "mouth" in said
    assert "itch" not in f"{words(name, 'mouth')}"


def test_what_hurts_names_the_failure_whatever_else_went_wrong():
    contacts = touching([30], START, plant.HEAD, plant.UNWANTED)
    harmed = {**PLANTED["thrashing"], "contacts": contacts, "outcome": "unwanted_contact"}
    assert kind(harmed) == "unwanted_contact"


def test_an_unwanted_touch_that_no_frame_shows_has_its_moment_but_no_part():
    found = judge(planted(still(), force=[(44, 3.0)], outcome="unwanted_contact"))
    assert (found["part"], found["frame"]) == (None, 44)
    assert found["says"] == "a touch too brief for the replay to show"


def test_what_touched_what_is_read_where_the_force_is_greatest():
    contacts = [
        *touching([10], START, plant.HEAD, plant.UNWANTED, 9.0),
        *touching([20], START, plant.UPPER_ARM, plant.UNWANTED, 4.0),
        *touching([20], START, plant.FOREARM, plant.UNWANTED, 5.0),
    ]
    force = [(10, 9.0), (21, 9.5)]  # No contact shows at the very moment.
    found = judge(planted(still(), contacts=contacts, force=force, outcome="unwanted_contact"))
    assert (found["part"], found["frame"]) == ("right forearm", 20)
    assert found["says"] == "the tool touched the right forearm, at its hardest with 9.5 N"


def test_contacts_that_do_not_name_their_bodies_still_have_their_moment():
    contacts = [mark[:6] for mark in touching([12], START, plant.HEAD, plant.UNWANTED, 7.0)]
    found = judge(planted(still(), contacts=contacts, outcome="unwanted_contact"))
    assert (found["part"], found["frame"]) == (None, 12)
    assert found["says"] == "the robot touched the person, at its hardest with 7.0 N"


def test_without_canonical_play_nothing_is_judged_by_it():
    for name in ("out_of_reach", "thrashing", "kept_away"):
        assert classify(seen(PLANTED[name]), None)["kind"] != name


@pytest.mark.parametrize(("frame", "expected"), [(50, "out_of_reach"), (51, "stuck")])
def test_out_of_reach_takes_half_of_the_episode(frame, expected):
    assert kind(planted(still(), moved(still(ITCH), frame, (2.0, 0, 0)))) == expected


@pytest.mark.parametrize(("step", "expected"), [(0.0241, "thrashing"), (0.0239, "stuck")])
def test_swinging_about_is_half_as_much_again_as_in_canonical_play(step, expected):
    assert kind(planted(swinging(START, step))) == expected


def test_a_robot_that_hardly_moves_in_canonical_play_does_not_swing_about_when_it_moves_a_bit():
    assert kind(planted(swinging(START, 0.009)), canonical(0.001)) == "stuck"
    assert kind(planted(swinging(START, 0.011)), canonical(0.001)) == "thrashing"


@pytest.mark.parametrize(("count", "expected"), [(5, "lost_contact"), (4, "stuck")])
def test_whoever_never_began_lost_nothing(count, expected):
    assert kind(lost(count=count)) == expected


def test_contact_lost_at_the_very_end_is_not_what_went_wrong():
    assert kind(lost(since=90, count=15)) == "too_little"


def test_a_robot_that_rests_on_the_itch_has_not_lost_it():
    assert kind(planted(still(ITCH), counted=range(5, 20))) == "too_little"


def test_what_else_touches_while_the_tip_is_at_the_itch_is_beside_the_point():
    contacts = touching(range(20, 80), ASIDE, plant.FOREARM, plant.ITCHES)
    assert kind(planted(still(ITCH), contacts=contacts)) == "too_little"


def test_only_arms_are_limbs():
    contacts = touching(range(20, 80), START, plant.HEAD, plant.UNWANTED)
    assert kind(planted(still(), contacts=contacts)) == "stuck"


@pytest.mark.parametrize(("frames", "expected"), [(26, "wrong_limb"), (25, "stuck")])
def test_the_wrong_limb_takes_a_quarter_of_the_episode(frames, expected):
    contacts = touching(range(40, 40 + frames), START, plant.UPPER_ARM, plant.ARM)
    assert kind(planted(still(), contacts=contacts)) == expected


def test_where_both_limbs_are_touched_the_longer_touch_names_the_failure():
    contacts = [
        *touching(range(30, 60), START, plant.UPPER_ARM, plant.ARM),
        *touching(range(60, 91), START, plant.FOREARM, plant.ITCHES),
    ]
    assert kind(planted(still(), contacts=contacts)) == "missed_spot"


def test_the_upper_arm_is_the_right_limb_where_it_itches():
    contacts = touching(range(30, 60), START, plant.UPPER_ARM, plant.ITCHES)
    assert kind(planted(still(), contacts=contacts, itching=plant.UPPER_ARM)) == "missed_spot"


@pytest.mark.parametrize(("by", "expected"), [(0.09, "stuck"), (0.11, "unclear")])
def test_a_tool_that_leaves_its_place_by_more_than_five_centimetres_is_not_stuck(by, expected):
    tip = still()
    tip[51:76, 0] += by  # Half of the second half, so the mean is in the middle.
    assert kind(planted(tip)) == expected


def test_it_is_not_the_robot_that_leaves_where_the_itch_went_farther():
    assert (
        kind(planted(wandering(0.1), np.linspace(ITCH, ITCH - (0, 0.5, 0), plant.FRAMES)))
        != "strayed"
    )


def test_an_arm_is_as_long_as_its_links_beyond_the_last_body_that_stays():
    arm = arm_of([seen(PLANTED["strayed"]), canonical()])
    np.testing.assert_allclose(arm.shoulder, plant.SHOULDER)
    assert arm.length == pytest.approx(REACH)


def test_an_arm_that_never_moves_is_unknown():
    assert arm_of([seen(planted(still()))]) is None
