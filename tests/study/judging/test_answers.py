"""From what a page sends to records: whom an answer is about, and whether it may be one."""

from __future__ import annotations

import math

import pytest

from rigid.errors import UserError
from rigid.study.judging import asked, read_answer, remaining, trials_for
from tests.study.judging.sources import plan_of, rater


@pytest.fixture
def sitting(pair_files):
    """A questionnaire, with one participant who answers."""

    class Sitting:
        def __init__(self, question):
            self.plan = plan_of(pair_files[question], question, count=6, attention_checks=1)
            self.trials = trials_for(self.plan, 1, rater())

        def one(self, *, check=False, left=None):
            return next(
                trial
                for trial in self.trials
                if (trial.pair is None) == check and left in (None, trial.shown_left)
            )

        def answer(self, trial, responses, **changes):
            said = {"trial": getattr(trial, "id", trial), "responses": responses, "rt": 2.5}
            return read_answer(self.plan, 1, rater(), **said | changes, answered="now")

    return Sitting


def ratings(question, **values):
    """Names with underscores; what is not given is 3."""
    return {name: values.get(name.replace("-", "_"), 3) for name in asked(question)}


@pytest.mark.parametrize(
    ("left", "side", "response"),
    [("first", "left", 0), ("first", "right", 1), ("second", "left", 1), ("second", "right", 0)],
)
def test_a_choice_counts_one_for_the_second_member(sitting, left, side, response):
    at = sitting("correspondence")
    trial = at.one(left=left)
    (found,) = at.answer(trial, {"correspondence": side})
    assert (found.question, found.of, found.response) == ("correspondence", "both", response)
    assert (found.pair, found.shown_left, found.position) == (trial.pair, left, trial.position)
    assert (found.participant, found.stage, found.rt, found.passed) == ("P01", 1, 2.5, None)


@pytest.mark.parametrize("left", ["first", "second"])
def test_danger_asks_two_scales_of_each_member(sitting, left):
    at = sitting("danger")
    values = {"goal-left": 0, "goal-right": 7, "danger-left": 5, "danger-right": 2}
    found = at.answer(at.one(left=left), values)
    by_member = {(one.question, one.of): one.response for one in found}
    right = "second" if left == "first" else "first"
    assert by_member == {
        ("goal", left): 0, ("goal", right): 7, ("danger", left): 5, ("danger", right): 2,
    }  # fmt: skip


def test_naturalness_asks_one_scale_of_each_member(sitting):
    at = sitting("naturalness")
    found = at.answer(at.one(), ratings("naturalness"))
    assert {(one.question, one.of) for one in found} == {
        ("naturalness", "first"), ("naturalness", "second"),
    }  # fmt: skip


def sides(trial):
    """On which sides the other member and the reference itself stand in a check."""
    return ("left", "right") if trial.shown_left == "first" else ("right", "left")


@pytest.mark.parametrize(
    ("other", "itself", "passed"),
    [(2, 6, True), (5, 7, True), (6, 6, False), (2, 5, False), (7, 6, False)],
)
def test_a_check_of_naturalness_wants_the_reference_to_resemble_itself(
    sitting, other, itself, passed
):
    at = sitting("naturalness")
    trial = at.one(check=True)
    foil, reference = sides(trial)
    found = at.answer(trial, {f"naturalness-{foil}": other, f"naturalness-{reference}": itself})
    assert {one.passed for one in found} == {passed}
    assert {one.pair for one in found} == {None}


@pytest.mark.parametrize(
    ("goals", "dangers", "passed"),
    [((1, 5), (6, 1), True), ((1, 5), (3, 3), True), ((4, 4), (6, 1), False),
     ((1, 5), (1, 2), False)],
)  # fmt: skip
def test_a_check_of_danger_wants_the_reference_to_help_more_and_harm_no_more(
    sitting, goals, dangers, passed
):
    at = sitting("danger")
    trial = at.one(check=True)
    said = {}
    for side, goal, danger in zip(sides(trial), goals, dangers, strict=True):
        said |= {f"goal-{side}": goal, f"danger-{side}": danger}
    assert {one.passed for one in at.answer(trial, said)} == {passed}


@pytest.mark.parametrize("right", [True, False])
def test_a_check_of_correspondence_wants_the_reference(sitting, right):
    at = sitting("correspondence")
    trial = at.one(check=True)
    (found,) = at.answer(trial, {"correspondence": sides(trial)[right]})
    assert found.passed is right


@pytest.mark.parametrize("value", [8, -1, 3.0, 3.5, True, "3", None, math.nan, [3]])
def test_only_whole_numbers_from_0_to_7_are_ratings(sitting, value):
    at = sitting("naturalness")
    with pytest.raises(UserError, match=r"naturalness-left .* is no whole number from 0 to 7"):
        at.answer(at.one(), ratings("naturalness", naturalness_left=value))


@pytest.mark.parametrize("value", ["first", "LEFT", 1, None, ["left"], {}])
def test_only_sides_are_choices(sitting, value):
    at = sitting("correspondence")
    with pytest.raises(UserError, match=r"correspondence .* is no side: answer left or right"):
        at.answer(at.one(), {"correspondence": value})


@pytest.mark.parametrize("value", [-0.1, math.nan, math.inf, True, "2", None])
def test_time_is_finite_and_not_negative(sitting, value):
    at = sitting("naturalness")
    with pytest.raises(UserError, match=r"rt .* is no time in seconds"):
        at.answer(at.one(), ratings("naturalness"), rt=value)


@pytest.mark.parametrize(
    "said", [{}, [], None, "x", {"naturalness-left": 1}, {**ratings("naturalness"), "goal-left": 1}]
)
def test_exactly_what_is_asked_must_be_answered(sitting, said):
    at = sitting("naturalness")
    message = "responses must hold exactly naturalness-left, naturalness-right"
    with pytest.raises(UserError, match=message):
        at.answer(at.one(), said)


@pytest.mark.parametrize("trial", ["t99", "", None, 3, ["t00"], "x" * 9999])
def test_unknown_trials_are_refused_briefly(sitting, trial):
    with pytest.raises(UserError, match="is none of this questionnaire") as refused:
        sitting("danger").answer(trial, ratings("danger"))
    assert len(str(refused.value)) < 120


def test_a_trial_is_left_until_all_its_answers_are_there(sitting):
    at = sitting("danger")
    first, *others = at.trials
    answers = at.answer(first, ratings("danger"))
    assert remaining(at.trials, answers[:3]) == at.trials
    assert remaining(at.trials, answers) == tuple(others)
