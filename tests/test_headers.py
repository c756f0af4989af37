"""Headers of files say what is wrong with them."""

from __future__ import annotations

import json

import pytest
from pydantic import BaseModel

from rigid.errors import UserError
from rigid.headers import parse_header


class Header(BaseModel):
    format: int
    names: tuple[str, ...]


def parse(value):
    text = value if isinstance(value, str) else json.dumps(value)
    return parse_header(Header, text, version=2, where="file.x", cure="make it again")


@pytest.mark.parametrize(
    ("value", "message"),
    [
        pytest.param("{", "file.x: the header: Invalid JSON.*: make it again", id="no-json"),
        pytest.param({}, "file.x: format: Field required: make it again", id="no-version"),
        pytest.param({"format": 3}, "version 3, but this RIGID reads up to 2: install", id="newer"),
        pytest.param({"format": 0}, "unknown format version 0: make it again", id="no-such"),
        pytest.param({"format": 2, "names": ["a", 1]}, r"file.x: names\.1: .*string", id="type"),
    ],
)
def test_a_bad_header_is_refused_with_place_and_cure(value, message):
    with pytest.raises(UserError, match=message):
        parse(value)


def test_a_header_may_say_more_than_is_read():
    assert parse({"format": 2, "names": ["a"], "comment": "more"}).names == ("a",)
