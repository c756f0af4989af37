"""Text in lines that a terminal shows whole."""

from __future__ import annotations

import pytest

from rigid.commands.terminal.wrapping import NO_BREAK, columns, show, wrapped


def test_no_line_is_wider_but_one_of_a_single_word():
    path = "/where/nobody/would/put/a/run/of/their/own"
    lines = wrapped(f"look in {path} first, and then elsewhere", 20).split("\n")
    assert lines == ["look in", f"  {path}", "  first, and then", "  elsewhere"]


@pytest.mark.parametrize("number", ["≥ 0.9", "95 %", "t: 0.071", "[0.8, 1]", "at 0.9"])
def test_a_number_keeps_its_sign_at_every_width(number):
    for width in range(12, 40):
        assert number in wrapped(f"a number of some words is {number} and so on", width)


def test_spaces_that_hold_are_ordinary_ones_in_the_end():
    held = f"a limit{NO_BREAK}of{NO_BREAK}ours"
    assert wrapped(held, 12) == "a\n  limit of ours"
    assert wrapped(held, 80) == "a limit of ours"


def test_lines_of_the_text_stay_lines():
    assert wrapped("one\n  two three", 10, hanging="    ") == "one\n  two\n    three"


@pytest.mark.parametrize(
    ("told", "width"), [("120", 120), ("7", 40), ("0", 80), ("wide", 80), (None, 80)]
)
def test_where_nothing_says_how_wide_it_is_there_are_80_columns(monkeypatch, capsys, told, width):
    del capsys  # Standard output is no terminal.
    monkeypatch.delenv("COLUMNS", raising=False)
    if told is not None:
        monkeypatch.setenv("COLUMNS", told)
    assert columns() == columns(of_errors=True) == width


def test_a_result_is_one_line_in_a_pipe_and_wrapped_for_a_terminal(capsys, monkeypatch):
    text = "word " * 30 + "end"
    show(text)
    assert capsys.readouterr().out == f"{text}\n"
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    show(text)
    assert max(map(len, capsys.readouterr().out.splitlines())) <= 80
