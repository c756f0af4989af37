"""Players on the axes: by the strictest referee, devices apart, scripts never counted."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest

from rigid.study.analysis.counting import controls_of, counts_of
from rigid.study.analysis.placing import place
from rigid.study.analysis.players import players_of
from rigid.study.analysis.settings import AnalysisSettings
from tests.study.analysis.planted import episode, everybody, robot

SETTINGS = AnalysisSettings()


def placed_of(records, *, scripted=(), measured=None):
    measured = measured or robot()
    players = players_of(records, everybody(records, scripted))
    return place(measured, players), controls_of(measured, players, SETTINGS)


def played(code="P01", count=4, **changes):
    return [episode(code, number, **changes) for number in range(count)]


def practised(code="P01", **changes):
    return played(code, 2, kind="practise", **changes)


def test_x_is_what_the_strictest_referee_says_and_y_the_mean_over_episodes():
    (natural, not_natural), _ = placed_of(
        played("P01", hand=-0.5, harm=0.2) + played("P02", hand=0.5, harm=0.6)
    )
    assert (natural.naturalness, natural.adversarialness) == (1.0, pytest.approx(0.2))
    assert (not_natural.naturalness, not_natural.referee) == (0.0, "run/s1-r1-l1")


def test_a_natural_player_with_more_harm_than_canonical_play_lies_above():
    ((one,), _) = placed_of(played(hand=-0.5, harm=0.2))
    assert one.height == 0.1
    assert one.above
    assert one.above_clearly
    assert one.episodes_above == 0  # Each of them is at the quantile of canonical episodes.


def test_an_unnatural_player_is_dominated_by_plain_sabotage():
    ((one,), _) = placed_of(played(hand=0.5, harm=0.8))
    assert one.above is False


def test_one_half_of_the_episodes_chooses_and_the_other_is_judged():
    """Even ones suspect nobody, odd ones would: the referee chosen by the former says so."""
    odd = [episode(number=n, hand=0.5 if n % 2 else -0.5) for n in range(4)]
    ((one,), _) = placed_of(odd)
    assert (one.referee, one.naturalness) == ("run/s0-r1-l1", 1.0)


def test_kinds_of_device_are_players_of_their_own():
    records = played(count=2) + [
        episode(number=n, device=device) for n, device in ((2, "touch"), (3, "touch"))
    ]
    records += [episode(number=n, device="xr-hand") for n in (4, 5)]
    found, _ = placed_of(records)
    assert [one.player.device for one in found] == ["desktop", "touch", "vr"]


def test_scripted_players_are_placed_under_their_script_and_never_counted():
    about = {"script": "extend"}
    records = played("P01") + played("S01", device="scripted", about_device=about)
    found, controls = placed_of(records + practised(), scripted=["S01"])
    names = {one.player.name: one.player.scripted for one in found}
    assert names == {"P01": False, "extend": True}
    (count,) = counts_of("a", found, controls)
    assert (count.people.of, count.device) == (1, "desktop")
    assert list(controls) == ["desktop"]


def test_a_script_that_says_it_is_a_mouse_is_scripted_all_the_same():
    ((one,), controls) = placed_of(played("S01", device="mouse"), scripted=["S01"])
    assert one.player.scripted
    assert one.player.device == "scripted"
    assert not controls


def test_nothing_is_claimed_where_benign_players_are_told_apart():
    records = played() + practised(hand=0.5)
    found, controls = placed_of(records)
    control = controls["desktop"]
    assert (control.naturalness, control.claim) == (0.0, False)
    assert "below 0.5: what the referee sees there is the device" in control.why
    (count,) = counts_of("a", found, controls)
    assert not count.claim


def test_nothing_is_claimed_without_practice():
    _, controls = placed_of(played())
    assert not controls["desktop"].claim
    assert "nobody practised twice" in controls["desktop"].why


def test_people_of_one_device_are_no_control_of_another():
    records = practised("P01", device="touch") + played("P02", device="mouse")
    _, controls = placed_of(records)
    assert controls["touch"].claim
    assert not controls["desktop"].claim


def test_scripts_are_no_control():
    records = practised("S01", device="mouse", hand=0.5) + practised("P01") + played("P01")
    _, controls = placed_of(records, scripted=["S01"])
    assert (controls["desktop"].people, controls["desktop"].naturalness) == (1, 1.0)


def test_against_practice_what_is_the_devices_own_counts_for_nothing():
    records = played(hand=0.5, harm=0.5) + practised(hand=0.5)
    ((one,), _) = placed_of(records)
    assert (one.naturalness, one.on_device) == (0.0, 1.0)
    assert one.above is False
    assert one.above_on_device is True


def test_an_episode_that_ran_away_is_shorter_and_has_no_harm():
    short = episode(number=4)
    cut = {f.name: getattr(short.arrays, f.name)[:4] for f in fields(short.arrays)}
    cut["faulted"][-1] = True
    away = replace(
        short, arrays=type(short.arrays)(**cut), episode_return=float("nan"), success=float("nan")
    )
    ((one,), _) = placed_of([*played(harm=0.2), away])
    assert len(one.harm) == 4
    assert one.adversarialness == pytest.approx(0.2)


def test_one_episode_has_no_place():
    ((one,), controls) = placed_of(played(count=1))
    assert one.unplaced == (
        "played 1 episode(s), of which one half chooses the referee: 2 are needed"
    )
    assert not counts_of("a", [one], controls)


def test_k_of_n_counts_people_and_not_episodes():
    records = practised() + played("P01", harm=0.05) + played("P02", harm=0.3)
    (count,) = counts_of("a", *placed_of(records))
    assert (count.people.above, count.people.of) == (1, 2)
    assert (count.episodes_above, count.episodes) == (4, 8)
    assert (count.people_with_episodes_above.above, count.clearly) == (1, 1)
