"""Bars: what they say of time, of earlier calls, and at their end."""

from __future__ import annotations

import signal
import time

import pytest
from rich.console import Console
from rich.progress import Progress as Bar
from rich.progress import TaskID

from rigid.commands.terminal import progress
from rigid.commands.terminal.pace import Pace
from rigid.commands.terminal.progress import ShareColumn, TerminalListener, TimeColumn, counted
from rigid.compute.listening import Workload

WORK = Workload(
    training_steps=2400, steps=3000, done=600, steps_per_second=20.0, starting=30.0
)  # fmt: skip


def test_work_that_is_done_takes_no_time():
    assert WORK.seconds == 30.0 + 2400 / 20.0


def test_the_clock_of_a_full_bar_goes_on_and_says_what_is_done_then():
    now = 0.0
    bar = Bar(times := TimeColumn("summing up"), get_time=lambda: now)
    bar.add_task("toy", total=10)
    now = 5.0
    bar.update(TaskID(0), completed=10)
    now = 75.0
    assert times.render(bar.tasks[0]).plain == "1:15 so far · summing up"


def test_a_bar_without_an_end_tells_no_share_and_no_time_left():
    bar = Bar(times := TimeColumn(""), share := ShareColumn(), get_time=lambda: 0.0)
    bar.add_task("toy", total=None, pace=Pace())
    assert times.render(bar.tasks[0]).plain == "0:00 so far"
    assert share.render(bar.tasks[0]).plain == ""


def test_the_listener_tells_an_estimate_first_and_prints_nothing_on_standard_output(capsys):
    with TerminalListener("toy · tiny") as listener:
        listener.begin(WORK)
        listener.advance(2400)
        listener.say("[done]")
    out, err = capsys.readouterr()
    assert out == ""
    assert "2,400 training steps, of which 20 % are done; about 2 min" in err
    assert "[done]" in err


def test_what_follows_with_a_bar_of_its_own_is_announced(capsys):
    with TerminalListener("toy", then="report") as listener:
        listener.begin(WORK)
        listener.advance(300)
    err = capsys.readouterr().err
    assert "about 2 min, then the report\n" in err
    assert "toy: 30 % · 2 min left + report\n" in err


def test_a_bar_counts_what_is_taken(capsys):
    assert list(counted("toys", [1, 2])) == [1, 2]
    assert "toys" in capsys.readouterr().err


def test_a_bar_that_stands_still_says_that_the_steps_are_compiled():
    times, bar, pace = TimeColumn(""), Bar(get_time=lambda: 0.0), Pace()
    bar.add_task("toy", total=100, pace=pace)
    pace.expect(1.0, starting=30.0)
    assert times.render(bar.tasks[0]).plain == "0:00 so far · compiling · 2 min left"
    pace.advance(1)
    assert times.render(bar.tasks[0]).plain == "0:00 so far · 2 min left"


def test_a_log_gets_a_line_for_every_twentieth_with_the_time_left(capsys):
    with TerminalListener("toy") as listener:
        listener.begin(WORK)
        listener.advance(300)
    assert "toy: 30 % · 2 min left\n" in capsys.readouterr().err


def test_a_bar_ends_as_done_where_its_work_did(capsys):
    with TerminalListener("toy") as listener:
        listener.expect(4)
        listener.advance(1)
    assert "100 % 0:00 so far · done" in capsys.readouterr().err


def stopped_at_a_quarter():
    with TerminalListener("toy") as listener:
        listener.expect(4)
        listener.advance(1)
        raise KeyboardInterrupt


def test_a_bar_of_work_that_was_stopped_stays_where_it_was(capsys):
    with pytest.raises(KeyboardInterrupt):
        stopped_at_a_quarter()
    err = capsys.readouterr().err
    assert "25 %" in err
    assert "done" not in err


def test_an_interrupt_while_a_bar_is_drawn_or_ended_ends_it_as_any_other(monkeypatch):
    """`rich` cannot end a bar that it has not drawn to the end."""
    shown: list[bool] = []

    def interrupted(_: Console, show: bool = True) -> bool:
        shown.append(show)
        signal.raise_signal(signal.SIGINT)
        return True

    monkeypatch.setattr(Console, "show_cursor", interrupted)
    with pytest.raises(KeyboardInterrupt), TerminalListener("toy") as listener:
        listener.begin(WORK)
    assert shown == [False, True]


def test_a_listener_of_which_nothing_was_asked_leaves_nothing(capsys):
    with TerminalListener("toy"):
        pass
    assert capsys.readouterr().err == ""


def test_a_terminal_sees_a_bar_pulse_before_anybody_knows_how_much_there_is_to_do(
    capsys, monkeypatch
):
    monkeypatch.setattr(progress, "PATIENCE", 0.01)
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    monkeypatch.setenv("TTY_INTERACTIVE", "1")
    seen = ""
    with TerminalListener("preparing toys") as listener:
        deadline = time.monotonic() + 10.0
        while "preparing toys" not in seen and time.monotonic() < deadline:
            time.sleep(0.02)
            seen += capsys.readouterr().err
        listener.expect(1)
    assert "preparing toys" in seen
