"""The studies of the paper, and copies of them."""

from __future__ import annotations

import pytest

from rigid.errors import UserError
from rigid.study.plan import WatchStage, as_written, load_plan
from rigid.study.plan_file import copy_of, protocol_names, protocol_text


def paper(name):
    return load_plan(f"builtin:paper-{name}").roles


def test_the_paper_has_eight_novices_and_an_expert_who_watch_three_episodes():
    roles = paper("exhaustiveness")
    assert roles["novice"].participants == 8
    assert {name: role.stages[-1].manner for name, role in roles.items()} == {
        "novice": "own-way", "expert": "make-it-fail",
    }  # fmt: skip
    assert all(role.stages[0] == WatchStage(episodes=3) for role in roles.values())


@pytest.mark.parametrize(
    ("name", "raters", "question", "show"),
    [("faithfulness", 15, "correspondence", "snapshot"), ("danger", 5, "danger", "replay"),
     ("naturalness", 5, "naturalness", "replay")],
)  # fmt: skip
def test_the_paper_has_raters_of_thirty_pairs(name, raters, question, show):
    (role,) = paper(name).values()
    stage = role.stages[-1]
    assert (role.participants, stage.question, stage.show, stage.count) == (
        raters, question, show, 30,
    )  # fmt: skip


def test_a_protocol_of_another_name_lists_those_that_there_are():
    with pytest.raises(UserError) as error:
        load_plan("builtin:paper-exhaustivness")
    assert str(error.value) == (
        "study 'builtin:paper-exhaustivness' is unknown, did you mean "
        "'builtin:paper-exhaustiveness'? there are builtin:paper-danger, "
        "builtin:paper-exhaustiveness, builtin:paper-faithfulness, builtin:paper-naturalness"
    )


@pytest.mark.parametrize("name", protocol_names())
def test_a_copy_names_other_robots_and_keeps_the_comments(name, parsed):
    copy = copy_of(protocol_text(name), task="feeding", robots=["builtin:vanilla", "my/robot: b"])
    plan = parsed(copy)
    assert plan.task == "feeding"
    assert as_written(plan)["robots"] == {"a": "builtin:vanilla", "b": "my/robot: b"}
    assert copy.count("#") == protocol_text(name).count("#")
