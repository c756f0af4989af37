"""Files that are whole or absent, and places that are refused with what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from rigid.errors import UserError
from rigid.files import (
    first_difference,
    json_text,
    lies_there,
    make_room,
    read_bytes,
    write_atomically,
)


def test_a_write_replaces_the_old_file_and_leaves_nothing_else(tmp_path):
    path = tmp_path / "file"
    write_atomically(path, b"old")
    write_atomically(path, b"new")
    assert path.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_write_that_fails_leaves_nothing_behind(tmp_path):
    taken = tmp_path / "taken"
    taken.mkdir()
    with pytest.raises(IsADirectoryError):
        write_atomically(taken, b"data")
    assert list(tmp_path.iterdir()) == [taken]


def test_others_may_read_what_was_written(tmp_path):
    write_atomically(tmp_path / "ours", b"")
    (tmp_path / "theirs").write_bytes(b"")
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "theirs").stat().st_mode


@pytest.mark.parametrize("place", ["", "file/result.json"])
def test_a_file_has_no_room_where_there_is_a_directory_or_below_a_file(tmp_path, place):
    (tmp_path / "file").touch()
    with pytest.raises(UserError, match=r"cannot write to .* \(.*\): choose another .* --x"):
        make_room(tmp_path / place, "--x")


def test_room_is_made_without_leaving_a_file(tmp_path):
    make_room(tmp_path / "deep" / "result.json")
    assert list(tmp_path.rglob("*")) == [tmp_path / "deep"]


@pytest.mark.parametrize(
    ("name", "message"),
    [("absent", "absent does not exist: look again"), ("", r"cannot be read \(Is a directory\)")],
)
def test_an_unreadable_file_is_named_with_the_cure(tmp_path, name, message):
    with pytest.raises(UserError, match=message):
        read_bytes(tmp_path / name, cure="look again")


def test_equal_values_give_equal_text():
    assert json_text({"b": (1, 2), "a": 0.5}) == json_text({"a": 0.5, "b": [1, 2]})


def test_json_knows_no_nan():
    with pytest.raises(ValueError, match="JSON compliant"):
        json_text({"a": float("nan")})


@pytest.mark.parametrize(
    ("mine", "theirs", "difference"),
    [
        pytest.param({"a": (1, 2)}, {"a": [1, 2]}, None, id="tuple-and-list-are-equal"),
        pytest.param({"a": 1, "b": 2}, {"a": 1}, None, id="only-shared-entries-count"),
        pytest.param({"p": {"x": 1}}, {"p": {"x": 2}}, ("p.x", 1, 2), id="nested"),
        pytest.param({"p": {"x": 1}}, {"p": None}, ("p", {"x": 1}, None), id="mapping-and-none"),
        pytest.param({"b": 1, "a": 1}, {"b": 2, "a": 2}, ("a", 1, 2), id="first-by-name"),
    ],
)
def test_the_first_difference_is_named_with_both_values(mine, theirs, difference):
    assert first_difference(mine, theirs) == difference


@pytest.mark.parametrize("written", ["", "x" * 5000, "a/file/below"])
def test_what_is_no_path_lies_nowhere(tmp_path, monkeypatch, written):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a").touch()
    assert lies_there("a", Path.is_file)
    assert not any(lies_there(written, found) for found in (Path.exists, Path.is_dir, Path.is_file))
