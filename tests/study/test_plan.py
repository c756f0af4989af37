"""Study files: what is read, and what is refused and how."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from rigid.errors import UserError
from rigid.study.plan import (
    JudgeStage,
    PlayStage,
    PractiseStage,
    WatchStage,
    default_plan,
    load_plan,
)
from rigid.study.plan_file import parse_plan
from tests.study.plan_texts import JUDGING, TEXT

ROOT = Path(__file__).parents[2]


@pytest.fixture
def message_of(tmp_path):
    """What is said about a file that is refused."""

    def read(text):
        with pytest.raises(UserError) as error:
            parse_plan(text, where="s.yaml", folder=tmp_path)
        return str(error.value)

    return read


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


def test_a_consent_file_that_is_missing_names_the_line(message_of):
    assert message_of(TEXT + "consent: {text: consent.md}\n").endswith(
        "consent.md does not exist: s.yaml, line 10, names it as consent.text: mend the name, or "
        "write the text"
    )


def test_without_a_file_novices_watch_practise_and_play():
    plan = default_plan("itch-scratching", {"a": "builtin:vanilla"})
    assert [stage.kind for stage in plan.roles["novice"].stages] == ["watch", "practise", "play"]


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
