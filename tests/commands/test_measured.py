"""Run directories and methods, as people write them."""

from __future__ import annotations

from pathlib import Path

import pytest

from rigid.commands.measured import parse_methods
from rigid.errors import UserError


def test_methods_keep_the_order_of_their_robots():
    named = parse_methods(["v=runs/v-1,runs/v-0", "r=runs/r-1, runs/r-0"])
    assert list(named.methods) == ["v", "r"]
    assert named.methods["r"] == [Path("runs/r-1"), Path("runs/r-0")]
    assert named.grouped


def test_a_name_given_again_adds_robots():
    """As a shell writes v=runs/v-{0,1}."""
    named = parse_methods(["v=runs/v-0", "r=runs/r-0", "v=runs/v-1"])
    assert named.methods == {"v": [Path("runs/v-0"), Path("runs/v-1")], "r": [Path("runs/r-0")]}


def test_a_plain_directory_beside_methods_is_one_of_one_robot():
    named = parse_methods(["runs/mine", "v=runs/v-0,runs/v-1"])
    assert named.methods["mine"] == [Path("runs/mine")]
    assert list(named.methods) == ["mine", "v"]
    assert named.grouped


def test_directories_alone_are_robots():
    named = parse_methods(["runs/a"], [Path("fleet/b")])
    assert named == ({"a": [Path("runs/a")], "b": [Path("fleet/b")]}, False)


def test_a_path_with_an_equals_sign_is_a_path():
    assert not parse_methods(["runs/rate=0.1", "runs/rate=0.2"]).grouped


def test_a_directory_that_exists_is_one(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rate=0.1").mkdir()
    assert parse_methods(["rate=0.1"]) == ({"rate=0.1": [Path("rate=0.1")]}, False)


def test_robots_of_one_folder_name_are_called_by_their_paths():
    assert list(parse_methods(["a/run", "b/run"]).methods) == ["a/run", "b/run"]


def test_a_name_cannot_steer_the_terminal():
    assert list(parse_methods(["\x1b[2J=runs/a,runs/b"]).methods) == [r"\x1b[2J"]


REFUSED = {
    "no name": (["=runs/a"], "'=runs/a' is no method: write NAME=DIR or NAME=DIR,DIR"),
    "no directory": (["v="], "'v=' is no method"),
    "an empty one": (["v=runs/a,"], "'v=runs/a,' is no method"),
    "twice in a method": (["v=runs/a,runs/a"], "was given the same run directory twice: runs/a"),
    "in two methods": (["v=runs/a", "r=runs/b,./runs/a"], "the same run directory twice"),
    "two of a name": (["v=runs/a", "runs/v"], "two methods are called 'v': name the run dir"),
}


@pytest.mark.parametrize(("arguments", "message"), REFUSED.values(), ids=REFUSED)
def test_what_has_no_sense_is_refused(arguments, message):
    with pytest.raises(UserError, match=message):
        parse_methods(arguments)
