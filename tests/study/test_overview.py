"""What `rigid study show` says of a study."""

from __future__ import annotations

from rigid.study.overview import advice, overview
from rigid.study.plan import load_plan
from tests.study.plan_texts import TEXT


def test_an_overview_says_what_each_role_does_and_how_long_it_takes():
    plan = load_plan("builtin:paper-exhaustiveness")
    novice, expert = overview(plan, episode_seconds=10.0)[1:]
    before = "consent, demographics, watch 3, practise 2, play 5"
    assert novice == f"novice       8      ≈ 6  {before} in their own way"
    assert expert == f"expert       1      ≈ 6  {before} to make it fail"


def test_players_who_practise_once_are_advised_to_practise_twice(parsed):
    plan = parsed(
        TEXT.replace("      - {kind: practise}\n", "      - {kind: practise, episodes: 1}\n")
    )
    assert advice(plan)[0] == (
        "novice: practises once, which does not tell the device from the person: ask for {kind: "
        "practise, episodes: 2} or more"
    )


def test_players_who_never_practise_are_advised_against(parsed):
    plan = parsed(TEXT.replace("      - {kind: practise}\n", ""))
    assert advice(plan)[0] == (
        "novice: nobody practises before they play, so that nothing can be claimed of their "
        "device: add - {kind: practise, episodes: 2}"
    )
