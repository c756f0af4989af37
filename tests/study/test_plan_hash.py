"""What the hash of a study covers."""

from __future__ import annotations

import json

import pytest

from rigid.study.plan import as_written, plan_hash
from rigid.study.plan_file import parse_plan
from tests.study.plan_texts import JUDGING, TEXT


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


def test_what_is_written_reads_as_the_same_study(parsed):
    plan = parsed(JUDGING)
    assert plan_hash(parsed(json.dumps(as_written(plan)))) == plan_hash(plan)
