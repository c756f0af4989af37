"""Pairs survive the disk, and what is damaged, foreign or changed is refused with a cure."""

from __future__ import annotations

import json

import pytest

from rigid.data.pair_file import (
    FoundMember,
    Pair,
    PairFile,
    PairRule,
    RecordedMember,
    RecordingSource,
    Reference,
    RunSource,
    check_sources,
    file_hash,
    load_pairs,
    relative_to,
    save_pairs,
    source_path,
)
from rigid.errors import UserError

MEMBER = {
    "episode": 3, "seed": 17, "naturalness": 0.5, "naturalness_se": None, "adversarialness": 0.25,
    "snapshot": 40, "snapshot_by": "deviation",
}  # fmt: skip


@pytest.fixture
def path(tmp_path):
    """A file of one pair, in a folder beside that of its sources."""
    kept = tmp_path / "runs" / "a" / "adversaries" / "s0-r1-l1" / "episodes.npz"
    kept.parent.mkdir(parents=True)
    kept.write_bytes(b"episodes")
    recording = tmp_path / "anna.npz"
    recording.write_bytes(b"recording")
    out = tmp_path / "study" / "pairs.json"
    out.parent.mkdir()
    pairs = PairFile(
        kind="faithfulness",
        rule=PairRule(
            alike="naturalness", alike_below=0.1, different=None, different_above=0.3,
            recorded_with_found=True, same_start=True, reuse=False, snapshot="the last step",
        ),
        seed=0,
        eligible=4,
        task={"name": "toy-reach"},
        runs=(
            RunSource(
                path=relative_to(tmp_path / "runs" / "a", out), robot="builtin:vanilla",
                robot_sha256="0" * 64, episodes_sha256={"s0-r1-l1": file_hash(kept)},
            ),
        ),
        recordings=(
            RecordingSource(
                path=relative_to(recording, out), sha256=file_hash(recording), source="recorded"
            ),
        ),
        pairs=(
            Pair(
                run=0,
                first=FoundMember(point="s0-r1-l1", shown="worst", **MEMBER),
                second=RecordedMember(recording=0, referee_run=0, referee="s0-r1-l1", **MEMBER),
                reference=Reference(point="s0-r1-l1", shown="median", seed=5),
            ),
        ),
    )  # fmt: skip
    save_pairs(out, pairs)
    return out


def edit(path, change):
    """Rewrites the file after `change` of its JSON."""
    data = json.loads(path.read_text(encoding="utf-8"))
    change(data)
    path.write_text(json.dumps(data), encoding="utf-8")


def refused(path, message):
    with pytest.raises(UserError, match=message) as caught:
        load_pairs(path)
    assert str(caught.value).startswith(str(path))


def test_pairs_come_back_as_they_were_and_are_stored_in_equal_bytes(path):
    before = path.read_bytes()
    save_pairs(path, load_pairs(path))
    assert path.read_bytes() == before


def test_members_know_where_they_come_from(path):
    (pair,) = load_pairs(path).pairs
    assert (pair.first.origin, pair.second.origin) == ("run", "recording")


def test_file_and_sources_may_move_together(path, tmp_path):
    check_sources(path, load_pairs(path))
    moved = tmp_path.rename(tmp_path.with_name("moved")) / "study" / "pairs.json"
    found = load_pairs(moved)
    check_sources(moved, found)
    assert source_path(moved, found.runs[0]).resolve() == moved.parents[1] / "runs" / "a"


@pytest.mark.parametrize("name", ["anna.npz", "runs/a/adversaries/s0-r1-l1/episodes.npz"])
def test_a_source_that_changed_is_named(path, name):
    source = path.parents[1] / name
    source.write_bytes(b"other")
    with pytest.raises(UserError, match=rf"{source.name} has changed since pairs were picked"):
        check_sources(path, load_pairs(path))
    source.unlink()
    with pytest.raises(UserError, match=rf"{source.name} does not exist: pairs name episodes"):
        check_sources(path, load_pairs(path))


def test_a_missing_file_is_named_with_the_command_that_makes_one(tmp_path):
    refused(tmp_path / "pairs.json", "does not exist: pick pairs with `rigid pairs`")


def test_a_damaged_file_is_refused(path):
    path.write_bytes(path.read_bytes()[:100])
    refused(path, "Invalid JSON.*or pick the pairs again with `rigid pairs`")


def test_a_newer_format_is_refused(path):
    edit(path, lambda data: data.update(format=2))
    refused(path, "has format version 2, but this RIGID reads up to 1: install a newer")


def test_fields_of_a_later_rigid_are_passed_over(path):
    before = load_pairs(path)
    edit(path, lambda data: data["pairs"][0]["first"].update(colour="red"))
    assert load_pairs(path) == before


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda data: data["pairs"][0].update(run=1), "pair 0 is of a run that is not listed"),
        (
            lambda data: data["pairs"][0]["second"].update(recording=1),
            "pair 0 is of a recording that is not listed",
        ),
        (
            lambda data: data["pairs"][0]["second"].update(referee_run=1),
            "pair 0 was judged by a run that is not listed",
        ),
        (
            lambda data: data["pairs"][0]["reference"].update(point="s9-r1-l1"),
            "pair 0 needs 's9-r1-l1', whose hash is not listed",
        ),
        (
            lambda data: data["pairs"][0]["first"].update(point="../../etc"),
            r"pairs\.0\.first\.run\.point: String should match pattern",
        ),
        (
            lambda data: data["pairs"][0]["first"].update(naturalness=1.5),
            r"pairs\.0\.first\.run\.naturalness: Input should be less than or equal to 1",
        ),
        (lambda data: data.update(pairs=[]), "pairs: .*at least 1 item"),
        (lambda data: data.pop("task"), "task: Field required"),
    ],
)
def test_what_refers_to_nothing_or_means_nothing_is_refused(path, change, message):
    edit(path, change)
    refused(path, message)
