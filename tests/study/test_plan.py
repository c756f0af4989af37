"""Study files: what is read, what is refused and how, and what their hash says."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from rigid.errors import UserError
from rigid.study.overview import advice, overview
from rigid.study.plan import (
    JudgeStage,
    PlayStage,
    PractiseStage,
    WatchStage,
    as_written,
    default_plan,
    load_plan,
    plan_hash,
)
from rigid.study.plan_file import copy_of, parse_plan, protocol_names, protocol_text

ROOT = Path(__file__).parents[2]
TEXT = """\
title: Scratching
robots: {a: "builtin:vanilla"}
roles:
  novice:
    participants: 8
    stages:
      - {kind: watch, episodes: 3}
      - {kind: practise}
      - {kind: play, episodes: 5, manner: own-way}
"""
JUDGING = """\
title: Judging
robots: {a: "builtin:vanilla"}
roles:
  rater:
    participants: 15
    stages:
      - {kind: judge, question: danger, pairs: pairs/danger.json}
"""


@pytest.fixture
def message_of(tmp_path):
    """What is said about a file that is refused."""

    def read(text):
        with pytest.raises(UserError) as error:
            parse_plan(text, where="s.yaml", folder=tmp_path)
        return str(error.value)

    return read


@pytest.fixture
def parsed(tmp_path):
    return lambda text: parse_plan(text, where="s.yaml", folder=tmp_path)


def test_a_short_file_gets_every_default(parsed):
    plan = parsed(TEXT)
    assert (plan.task, plan.language, plan.seed, plan.demographics) == (
        "itch-scratching", "en", 0, True,
    )  # fmt: skip
    assert plan.roles["novice"].stages == (
        WatchStage(episodes=3), PractiseStage(episodes=2), PlayStage(episodes=5),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        pytest.param(
            "participants", "particpants",
            "s.yaml has 2 mistakes:\n"
            "  line 4: roles.novice.participants is missing: write participants: 8\n"
            "  line 5: roles.novice.particpants is unknown, did you mean 'participants'? there may "
            "stand participants, stages, instructions",
            id="misspelt-field",
        ),
        pytest.param(
            "{kind: play, episodes: 5, manner: own-way}", "{kind: play, maner: own-way}",
            "s.yaml: line 9: roles.novice.stages[2].maner is unknown, did you mean 'manner'? there "
            "may stand kind, episodes, manner",
            id="misspelt-field-of-a-stage",
        ),
        pytest.param(
            "own-way", "own way",
            "s.yaml: line 9: roles.novice.stages[2].manner: 'own way' is unknown: write own-way, "
            "make-it-fail",
            id="unknown-word",
        ),
        pytest.param(
            "kind: watch", "kind: look",
            "s.yaml: line 7: roles.novice.stages[0]: kind 'look' is unknown: write watch, practise,"
            " play, judge",
            id="unknown-kind",
        ),
        pytest.param(
            "{kind: practise}", "{episodes: 2}",
            "s.yaml: line 8: roles.novice.stages[1]: kind is missing: write kind: watch, practise, "
            "play or judge",
            id="no-kind",
        ),
        pytest.param(
            "participants: 8", 'participants: "8"',
            "s.yaml: line 5: roles.novice.participants: '8' must be a whole number",
            id="number-in-quotes",
        ),
        pytest.param(
            "participants: 8", "participants: yes",
            "s.yaml: line 5: roles.novice.participants: True must be a whole number",
            id="yes-is-no-number",
        ),
        pytest.param(
            "participants: 8", "participants: 0",
            "s.yaml: line 5: roles.novice.participants: 0 must be more than 0",
            id="nobody",
        ),
        pytest.param(
            "title: Scratching", "title: 7",
            "s.yaml: line 1: title: 7 must be text: put it in quotes",
            id="text-without-quotes",
        ),
        pytest.param(
            "title: Scratching\n", "",
            "s.yaml: title is missing: write title: Scratching an itch with a robot",
            id="no-title",
        ),
        pytest.param(
            "{a:", "{A:",
            "s.yaml: line 2: robots.A: 'A' must be a name of small letters, digits and dashes, "
            "such as novice or a",
            id="name-of-a-robot",
        ),
        pytest.param(
            "    participants: 8", "    participants: 8\n    participants: 9",
            "s.yaml: line 6: roles.novice.participants stands there twice, first in line 5: remove "
            "one",
            id="twice",
        ),
        pytest.param(
            "title: Scratching", "title: Scratching\npaths: {}",
            "s.yaml: line 2: paths is unknown: remove it",
            id="field-of-the-plan-alone",
        ),
        pytest.param(
            "title: Scratching", "title: Scratching\nformat: 2",
            "s.yaml has format 2, but this RIGID reads up to 1: install a newer rigid-frontier",
            id="newer-format",
        ),
        pytest.param(
            "title: Scratching", "title: [Scratching",
            "s.yaml: line 2: this is no YAML (expected ',' or ']', but got ':'): mind indentation, "
            "colons and quotes",
            id="no-yaml",
        ),
        pytest.param(
            "title: Scratching", "title: 2026-13-01",
            "s.yaml: month must be in 1..12: write such a value in quotes",
            id="no-date",
        ),
        pytest.param(
            "title: Scratching", "title: &a [*a]",
            "s.yaml: this is no YAML (fields are nested too deeply, or an anchor holds itself): "
            "mind indentation, colons and quotes",
            id="endless-anchor",
        ),
    ],
)  # fmt: skip
def test_a_mistake_is_named_with_its_line_and_its_cure(message_of, before, after, said):
    assert message_of(TEXT.replace(before, after)) == said


def test_what_repeats_itself_beyond_measure_is_refused(message_of):
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 9)]
    assert message_of("\n".join(lines)).startswith("s.yaml has more than 10000 entries")


@pytest.mark.parametrize("text", ["", "- a\n", "just words\n"])
def test_what_is_no_mapping_is_no_study(message_of, text):
    assert message_of(text) == (
        "s.yaml is no study, which begins with `title: …`: docs/study.md shows every field"
    )


def test_a_completion_address_is_a_web_address(message_of):
    assert message_of(TEXT + "completion: {url: 'javascript:alert(1)'}\n") == (
        "s.yaml: line 10: completion.url: 'javascript:alert(1)' must be an address, such as "
        "https://example.org/done"
    )


def test_a_file_that_is_missing_says_how_to_get_one(tmp_path):
    with pytest.raises(UserError, match="does not exist: copy a study to start from with `rigid"):
        load_plan(tmp_path / "none.yaml")


def test_a_file_that_is_no_text_is_refused(tmp_path):
    path = tmp_path / "s.yaml"
    path.write_bytes(b"title: \xff\xfe")
    with pytest.raises(UserError, match="no text in UTF-8"):
        load_plan(path)


def test_paths_begin_at_the_file(tmp_path):
    folder = tmp_path / "studies"
    folder.mkdir()
    path = folder / "s.yaml"
    path.write_text(JUDGING.replace("builtin:vanilla", "robots/mine"))
    plan = load_plan(path)
    assert plan.robots["a"] == str(folder / "robots" / "mine")
    (stage,) = plan.roles["rater"].stages
    assert isinstance(stage, JudgeStage)
    assert stage.pairs == folder / "pairs" / "danger.json"


def test_the_hash_does_not_change_where_the_folder_moves(tmp_path):
    text = JUDGING.replace("builtin:vanilla", "robots/mine")
    hashes = {plan_hash(parse_plan(text, where="s.yaml", folder=tmp_path / name)) for name in "ab"}
    assert len(hashes) == 1


def test_the_hash_does_not_change_with_layout_comments_and_spelt_out_defaults(parsed):
    longer = "# A comment.\nseed: 0\nformat: 1\n" + TEXT.replace(
        "{kind: practise}", "{episodes: 2, kind: practise}"
    )
    assert plan_hash(parsed(longer)) == plan_hash(parsed(TEXT))


@pytest.mark.parametrize(
    "change",
    [("seed: 0", "seed: 1"), ("episodes: 5", "episodes: 6"), ("vanilla", "palm"),
     ("version: '1'", "version: '2'")],
)  # fmt: skip
def test_the_hash_changes_with_what_the_study_says(parsed, change):
    text = "seed: 0\nconsent: {version: '1'}\n" + TEXT
    assert plan_hash(parsed(text.replace(*change))) != plan_hash(parsed(text))


def test_the_hash_covers_the_words_of_a_consent_file(tmp_path, parsed):
    text = TEXT + "consent: {text: consent.md}\n"
    hashes = set()
    for words in ("You may stop at any time.", "You may never stop."):
        (tmp_path / "consent.md").write_text(words)
        plan = parsed(text)
        assert plan.consent.text == words
        hashes.add(plan_hash(plan))
    assert len(hashes) == 2


def test_a_consent_file_that_is_missing_names_the_line(message_of):
    assert message_of(TEXT + "consent: {text: consent.md}\n").endswith(
        "consent.md does not exist: s.yaml, line 10, names it as consent.text: mend the name, or "
        "write the text"
    )


def test_what_is_written_reads_as_the_same_study(parsed):
    plan = parsed(JUDGING)
    assert plan_hash(parsed(json.dumps(as_written(plan)))) == plan_hash(plan)


def test_without_a_file_novices_watch_practise_and_play():
    plan = default_plan("itch-scratching", {"a": "builtin:vanilla"})
    assert [stage.kind for stage in plan.roles["novice"].stages] == ["watch", "practise", "play"]


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


def test_the_file_that_the_guide_shows_is_read_and_names_every_field(parsed):
    page = (ROOT / "docs" / "study.md").read_text(encoding="utf-8")
    (shown,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    plan = parsed(shown)
    stages = [stage for role in plan.roles.values() for stage in role.stages]
    parts = [plan, plan.consent, plan.completion, *plan.roles.values(), *stages]
    for part in parts:
        fields = {name for name, field in type(part).model_fields.items() if not field.exclude}
        assert all(f"{name}:" in shown for name in fields)
    assert {stage.kind for stage in stages} == {"watch", "practise", "play", "judge"}


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
