"""From parts set by hand to rows, verdicts and text."""

from __future__ import annotations

import pytest

from benchmarks.paired import find
from benchmarks.physics.account import failure, headline, shifts, softness, write_account
from benchmarks.physics.drawing import draw
from benchmarks.physics.plan import DEFAULT, FINEST, LIMITS, SETTINGS, SWINGS
from benchmarks.physics.tables import closed_rows, part_name, table
from benchmarks.physics.verdicts import judged, remedy, worst
from tests.benchmarks.physics import samples

RETURN, FAULTED = (
    next(one for one in LIMITS if one.number == name) for name in ("return", "faulted")
)
FREE = next(one for one in LIMITS if one.case == "free")


@pytest.fixture(scope="module")
def rows():
    return table(samples.parts(), samples.PLAN)


def row(low, high, *, difference=True):
    ends = {"difference": (low + high) / 2, "difference_low": low, "difference_high": high}
    values = {"value": low, "low": low, "high": high}
    return values | (ends if difference else dict.fromkeys(ends))


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [(-14, 14, "holds"), (-15, 2, "open"), (2, 15, "open"), (15, 16, "fails"), (-16, -15, "fails")],
)
def test_a_limit_is_held_or_broken_by_the_whole_interval(low, high, verdict):
    assert judged(row(low, high), RETURN) == verdict


@pytest.mark.parametrize(("low", "high", "verdict"), [(-1, 0.005, "holds"), (0.0, 0.02, "open")])
def test_less_is_fine_where_only_more_is_worse(low, high, verdict):
    assert judged(row(low, high, difference=False), FAULTED) == verdict


def test_differences_are_paired_and_those_of_the_reference_unknown(rows):
    mine = find(rows, part="closed", case="loud", step=0.02, number="impulse")
    # Forces are 1 + step times as large.
    assert mine["difference"] == pytest.approx(1.02 / 1.002 - 1)
    assert mine["difference_high"] - mine["difference_low"] < 1e-9
    finest = find(rows, part="closed", case="loud", step=FINEST.step, number="impulse")
    assert finest["difference"] is None


def test_an_episode_that_ran_away_counts_as_fault_and_nowhere_else():
    played = {one: samples.closed(one.step, episodes=10) for one in SETTINGS}
    played[DEFAULT]["faulted"][3] = 1.0
    played[DEFAULT]["return"][3] = -1e6
    mine = {
        row["number"]: row for row in closed_rows("loud", played) if row["step"] == DEFAULT.step
    }
    assert (mine["return"]["n"], mine["faulted"]["n"]) == (9, 10)
    assert mine["return"]["difference"] == pytest.approx(0.0)
    assert mine["faulted"]["value"] == pytest.approx(0.1)


def test_a_difference_is_parted_into_that_of_old_poses_and_the_rest():
    moved = table(samples.parts(loud=20.0), samples.PLAN)
    rest, age = (
        find(moved, part="aged", case="loud", step=one.step, number="return")["difference"]
        for one in (DEFAULT, FINEST)
    )
    assert (rest, age) == pytest.approx((15.0, 5.0))


def test_differences_within_a_limit_are_named_where_they_are_certain(rows):
    moved = table(samples.parts(loud=5.0), samples.PLAN)
    assert "are certain: return with *loud* +5.0 [+5.0, +5.0]" in shifts(moved)
    assert shifts(rows).startswith("No return, success or number of contacts")


def test_episodes_without_touch_say_nothing_about_forces(rows):
    numbers = {name: find(rows, part="windows", case="loud", step=0.02, number=name)
               for name in ("impulse", "angles")}  # fmt: skip
    assert (numbers["impulse"]["n"], numbers["angles"]["n"]) == (5, 6)


def test_a_verdict_speaks_of_the_worst_case():
    moved = table(samples.parts(loud=20.0), samples.PLAN)
    assert worst(moved, RETURN, DEFAULT) == "fails"
    assert worst(moved, RETURN, SETTINGS[1]) == "holds"
    assert worst(moved, RETURN, FINEST) is None


def test_the_remedy_is_the_coarsest_step_that_holds_and_has_a_price():
    setting, cost = remedy(table(samples.parts(loud=20.0), samples.PLAN), RETURN)
    assert setting == SETTINGS[1]
    assert cost == pytest.approx(2.05)


def test_what_a_limit_costs_is_said_where_it_fails():
    moved = table(samples.parts(loud=20.0), samples.PLAN)
    said = failure(moved, RETURN)
    assert "*loud* +20.0 [+20.0, +20.0]. 0.01 s × 10 holds it and costs 2.0 times" in said
    assert "canonical" not in said


def test_a_limit_that_no_step_holds_has_no_price():
    parts = samples.parts()
    parts[part_name("energy", "free")] = {
        speed: {one.name: [0.4, 0.5] for one in SETTINGS} for speed in ("0.566", "2")
    }
    said = failure(table(parts, samples.PLAN), FREE)
    assert said.endswith("No step holds it, 0.002 s × 50 neither.")


def test_each_kind_of_swing_has_a_limit_of_its_own(rows):
    found = {one.case: worst(rows, one, DEFAULT) for one in LIMITS if one.part == "energy"}
    assert set(found) == set(SWINGS)
    assert (found["free"], found["contact"], found["braked"]) == ("fails", "holds", "holds")


def test_the_headline_counts_and_names_what_does_not_hold(rows):
    said = headline(rows, DEFAULT)
    # Forces of the sample's half seconds are off by 38 % at the coarsest step.
    assert said == (
        f"0.02 s × 5 holds {len(LIMITS) - 3} of {len(LIMITS)} limits. It does not hold: impulse of "
        f"a half second: 10 %; peak force of a half second: 20 %; {FREE.text}."
    )


def test_unequal_contacts_are_called_so():
    equal = {"0.02 s × 5": samples.softness(), "0.01 s × 10": samples.softness()}
    assert "all 20 constraints" in softness([equal])
    assert "k = 692.5 /s² and b = 52.6 /s, at every step" in softness([equal])
    stiffer = equal | {"0.01 s × 10": samples.softness(2770.1)}
    assert softness([stiffer]).startswith("**They are not equal**: k from 692.5 to 2770.1 /s²")


def test_text_and_table_agree(rows, tmp_path):
    write_account(tmp_path / "README.md", samples.PLAN, rows, samples.parts())
    text = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert (
        "| return: 2 % of the range of adversarialness | holds | holds | holds | reference |"
        in text
    )
    mine = find(rows, part="closed", case="loud", step=0.02, number="impulse")
    assert f"+{100 * mine['difference']:.1f} %" in text
    assert "no braked swing is ever above its start" in text
    assert "{" not in text
    draw(tmp_path / "figure.svg", rows)
    assert (tmp_path / "figure.svg").stat().st_size > 10_000
