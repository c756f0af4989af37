"""What each participant is shown: all pairs, in an order and on sides of their own."""

from __future__ import annotations

from collections import Counter

import pytest

from rigid.errors import UserError
from rigid.study.judging import preview_trials, trials_for
from tests.study.judging.sources import STILL, plan_of, rater


@pytest.fixture
def draw(pair_files):
    """The trials of a participant in a questionnaire of twelve pairs and two checks."""

    def of(question="danger", participant=None, **changes):
        settings = {"count": 12, "attention_checks": 2, **changes}
        plan = plan_of(pair_files[question], question, **settings)
        return trials_for(plan, 1, participant or rater())

    return of


def pairs_in(trials):
    return [trial.pair for trial in trials if trial.pair is not None]


def test_everybody_judges_every_pair_once(draw):
    for place in range(4):
        assert sorted(pairs_in(draw(participant=rater(place)))) == list(range(12))


def test_a_reload_finds_the_same_order_and_sides(draw):
    assert draw() == draw()


def test_orders_differ_between_participants_and_seeds(pair_files):
    plan = plan_of(pair_files["danger"], count=12)
    other = plan.model_copy(update={"seed": 1})
    orders = [pairs_in(trials_for(p, 1, who)) for p in (plan, other) for who in map(rater, (0, 1))]
    assert len({tuple(order) for order in orders}) == 4


def test_the_first_member_stands_on_the_left_in_half_of_the_trials(draw):
    for place in range(6):
        sides = Counter(trial.shown_left for trial in draw(participant=rater(place)))
        assert sides == {"first": 7, "second": 7}


def test_sides_balance_exactly_over_two_participants_in_a_row(draw):
    for place in (0, 2, 4):
        one, other = (
            {t.pair: t.shown_left for t in draw(participant=rater(p)) if t.pair is not None}
            for p in (place, place + 1)
        )
        assert all(one[pair] != other[pair] for pair in range(12))


def test_orders_of_two_participants_in_a_row_are_not_the_same(draw):
    assert pairs_in(draw(participant=rater(0))) != pairs_in(draw(participant=rater(1)))


def test_checks_come_one_in_each_half_and_never_at_once(draw):
    places = set()
    for place in range(30):
        trials = draw(participant=rater(place))
        first, second = (trial.position for trial in trials if trial.pair is None)
        assert 1 <= first <= 6 < second - 1 <= 12
        places.add((first, second))
    assert len(places) > 10


@pytest.mark.parametrize(
    ("question", "hardest"),
    [
        ("danger", {(11, "second"), (10, "second")}),
        ("naturalness", {(11, "second"), (10, "second")}),
    ],
)
def test_checks_show_the_members_farthest_from_the_reference_beside_it(draw, question, hardest):
    checks = [trial for trial in draw(question) if trial.pair is None]
    shown = [{trial.clips["left"], trial.clips["right"]} for trial in checks]
    foils = {(c.pair, c.who) for clips in shown for c in clips if c.who != "reference"}
    assert foils == hardest
    for clips in shown:
        assert {clip.who for clip in clips} == {"second", "reference"}
        assert len({clip.pair for clip in clips}) == 1


def test_a_still_stands_beside_a_reference_that_moves(draw):
    for trial in draw("correspondence", show="snapshot"):
        assert trial.clips["left"].moment == trial.clips["right"].moment == STILL
        assert trial.clips["reference"].moment is None


def test_danger_is_not_compared_with_a_reference(draw):
    assert all(set(trial.clips) == {"left", "right"} for trial in draw("danger"))


def test_the_page_is_told_nothing_that_gives_a_check_away(draw):
    """Not even that the reference stands on a side: each place has a key of its own."""
    trials = draw("naturalness")
    told = [trial.public() for trial in trials]
    assert {frozenset(one) for one in told} == {
        frozenset({"id", "position", "of", "left", "right", "reference"})
    }
    keys = [one[role] for one in told for role in ("left", "right", "reference")]
    assert len(set(keys)) == len(keys)
    assert [one["id"] for one in told] == [f"t{place:02d}" for place in range(14)]


def test_everybody_has_keys_of_their_own(draw):
    one, other = (
        {key for trial in draw(participant=rater(p)) for key in trial.keys.values()} for p in (0, 1)
    )
    assert not one & other


def test_a_preview_needs_no_participant(pair_files):
    plan = plan_of(pair_files["danger"], count=3, attention_checks=1)
    assert len(preview_trials(plan, "rater", 1)) == 4


def refused(message, path, question="danger", stage=1, **changes):
    with pytest.raises(UserError, match=message):
        trials_for(plan_of(path, question, **changes), stage, rater())


def test_pairs_of_another_kind_are_refused(pair_files):
    message = "holds danger pairs, but the question naturalness needs naturalness pairs"
    refused(message, pair_files["danger"], "naturalness")


def test_too_few_pairs_are_refused(pair_files):
    refused("holds 12 pairs, too few for count: 13", pair_files["danger"], count=13)


def test_more_checks_than_pairs_are_refused(pair_files):
    refused("attention_checks: 3 is more than count: 2", pair_files["danger"], count=2,
            attention_checks=3)  # fmt: skip


def test_other_stages_are_no_questionnaires(pair_files):
    for stage in (0, 2, -1):
        refused(
            f"stage {stage} of role rater is no questionnaire", pair_files["danger"], stage=stage
        )
