"""What people write on a command line, as numbers or as a message that says how to write it."""

from __future__ import annotations

import math

import pytest

from rigid.commands.parsing import at_least, parse_budget, parse_lambdas, parse_seeds, spoken
from rigid.errors import UserError


@pytest.mark.parametrize("parse", [parse_seeds, parse_lambdas, parse_budget])
def test_what_is_not_given_stays_none(parse):
    assert parse(None) is None


@pytest.mark.parametrize(
    ("text", "seeds"),
    [("0,1,2", (0, 1, 2)), ("0..3", (0, 1, 2, 3)), ("8", (8,)), (" 5 , 1..1", (5, 1))],
)
def test_seeds(text, seeds):
    assert parse_seeds(text) == seeds


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.5", r"--seeds '0\.5': '0\.5' is no seed; write 0,1,2 or 0\.\.9"),
        ("0,,1", "'' is no seed"),
        ("", "'' is no seed"),
        ("0..", r"'0\.\.' is no seed"),
        ("3..1", r"'3\.\.1' runs backwards"),
        ("0..2,1", "must be distinct and not negative"),
        ("-1", "must be distinct and not negative"),
    ],
)
def test_bad_seeds_are_named(text, message):
    with pytest.raises(UserError, match=message):
        parse_seeds(text)


def test_lambdas_keep_their_order_and_may_be_infinite():
    assert parse_lambdas("1,0,0.01,inf") == (1.0, 0.0, 0.01, math.inf)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "--lambdas '': write numbers as 0,0.01,1,inf"),
        ("a,1", "write numbers as"),
        ("-1", "a weight is 0 or more, or inf"),
        ("nan", "a weight is 0 or more, or inf"),
        ("1,1.0", "names a weight twice"),
    ],
)
def test_bad_lambdas_are_named(text, message):
    with pytest.raises(UserError, match=message):
        parse_lambdas(text)


@pytest.mark.parametrize(("text", "seconds"), [("90s", 90), ("30m", 1800), ("1.5h", 5400)])
def test_budgets_are_seconds(text, seconds):
    assert parse_budget(text) == seconds


@pytest.mark.parametrize("text", ["", "30", "m", "30 d", "ten m", "nanm"])
def test_a_budget_without_number_or_unit_is_named(text):
    with pytest.raises(UserError, match=r"--budget '.*'(: write a time as| must be more than)"):
        parse_budget(text)


@pytest.mark.parametrize("text", ["0s", "-5m", "infh"])
def test_a_budget_has_to_be_some_time(text):
    with pytest.raises(UserError, match="must be more than nothing"):
        parse_budget(text)


def test_counts_have_a_least_value():
    at_least("--episodes", 1, 1)
    with pytest.raises(UserError, match="--episodes is 0, but must be at least 1"):
        at_least("--episodes", 0, 1)


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.4, "0 s"), (89, "89 s"), (91, "2 min"), (5399, "1 h 30 min")]
)
def test_durations_are_said_as_people_say_them(seconds, text):
    assert spoken(seconds) == text
