"""Programs that break: each is ended, leaves nothing behind, and its user is told what to mend."""

import io
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from rigid.errors import UserError
from rigid.serving.child import Command
from rigid.serving.rigid_serve import MAX_BODY, pack
from rigid.serving.session import Promise, Session
from tests.serving.programs import DOUBLER, children, write_program

PROMISE = {"protocol": 1, "serves": "policy", "fingerprint": "f", "timeout": 60}


@pytest.fixture(autouse=True)
def _nobody_is_left_behind():
    before = children()
    yield
    assert children() <= before


@pytest.fixture
def start(tmp_path):
    """Starts a program and waits until it serves."""

    def session(text, *, seconds=20.0):
        return Session(Command(write_program(tmp_path, text), tmp_path), Promise, seconds=seconds)

    return session


def answering(*frames):
    """A program that answers every call with the next of `frames`, then ends."""
    return f"""
        import sys
        for data in {list(frames)!r}:
            sys.stdin.buffer.read1(1 << 16)
            sys.stdout.buffer.write(data)
            sys.stdout.buffer.flush()
    """


@pytest.mark.parametrize(
    ("text", "message"),
    [
        pytest.param("import sys; sys.exit(3)", "ended (exit code 3) before it ans", id="ends"),
        pytest.param("import nowhere", "No module named 'nowhere'", id="its-last-words"),
        pytest.param(
            "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)",
            "was ended by signal 11 (Segmentation fault)", id="crashes",
        ),
        pytest.param("print('x' * 70000)", "which is no answer to RIGID", id="prints-only"),
        pytest.param("import time; time.sleep(60)", "did not answer within 0.4 s", id="hangs"),
        pytest.param(
            "import os, time; os.close(0); os.close(1); time.sleep(60)",
            "closed its standard input and output", id="closes-its-pipes",
        ),
        pytest.param(
            answering(pack("hello", {**PROMISE, "protocol": 2})),
            "speaks version 2 of the protocol of rigid_serve.py, but this RIGID speaks 1: write "
            "that file again with `rigid export --serve rigid_serve.py`", id="other-version",
        ),
        pytest.param(
            answering(pack("hello", {**PROMISE, "serves": "tea"})),
            "serves a tea, which is not what it was named for: --task takes programs that call "
            "serve_task, --robot and --human those that call serve_policy", id="other-role",
        ),
        pytest.param(
            answering(pack("hello", {**PROMISE, "timeout": -1})), "said timeout: ", id="bad-promise"
        ),
        pytest.param(answering(pack("tea")), "answered 'tea' where 'hello' was due", id="kind"),
        pytest.param(
            answering(pack("hello")[:8] + b"\xff" * 8),
            "sent what is no answer: a frame of 8589934590 bytes is too long", id="huge-frame",
        ),
    ],
)  # fmt: skip
def test_a_program_that_does_not_begin_to_serve_is_told_of(start, text, message):
    patience = 0.4 if "sleep" in text and "close" not in text else 20.0
    with pytest.raises(UserError) as caught:
        start(text, seconds=patience)
    assert str(caught.value).startswith("the program ")
    assert message in str(caught.value)


def test_what_it_prints_before_it_serves_is_no_answer(start):
    session = start(
        "print('pybullet build time: today', flush=True)" + DOUBLER.replace("\n    ", "\n")
    )
    session.close()
    assert session.promise.serves == "policy"


class TestCalls:
    HELLO = pack("hello", PROMISE)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            pytest.param(answering(HELLO), "ended (exit code 0) before it answered", id="ends"),
            pytest.param(answering(HELLO, b"Good morning to all"), "begins no frame", id="prints"),
            pytest.param(answering(HELLO, pack("moment")), "'action' was due", id="other-kind"),
        ],
    )
    def test_a_program_that_breaks_off_is_told_of(self, start, text, message):
        session = start(text)
        with pytest.raises(UserError) as caught:
            _ask_twice(session)
        assert message in str(caught.value)
        assert session.broken

    def test_a_program_that_hangs_is_waited_for_as_long_as_it_asked(self, start):
        hello = pack("hello", {**PROMISE, "timeout": 0.3})
        session = start(answering(hello) + "\n        import time; time.sleep(60)")
        session.send("act")
        with pytest.raises(UserError, match=r"did not answer within 0\.3 s: .* larger `timeout`"):
            session.receive("action")

    def test_a_program_that_does_not_listen_holds_up_nobody(self, start):
        hello = pack("hello", {**PROMISE, "timeout": 0.3})
        session = start(answering(hello) + "\n        import time; time.sleep(60)")
        with pytest.raises(UserError, match=r"did not answer within 0\.3 s"):
            session.send("act", arrays={"observation": np.zeros(1_000_000)})

    def test_a_program_that_says_that_it_works_is_waited_for(self, start, monkeypatch):
        session = start(answering(self.HELLO))
        frames = [pack("busy")] * 4 + [pack("action")]
        clock = iter(range(0, 10_000, 50))  # Each wait is shorter than the 60 s that it asked for.
        monkeypatch.setattr(time, "monotonic", lambda: next(clock))
        stream = io.BytesIO(b"".join(frames))
        deadlines = []

        def read(count, deadline, _):
            deadlines.append(deadline)
            return stream.read(count)

        monkeypatch.setattr(session._child, "read", read)
        assert session.receive("action").kind == "action"
        assert sorted(set(deadlines)) == [60, 110, 160, 210, 260]
        session.close()

    def test_an_interrupted_call_ends_the_program(self, start, monkeypatch):
        session = start(answering(self.HELLO, pack("action")))
        session.send("act")

        def interrupt(*_):
            raise KeyboardInterrupt

        monkeypatch.setattr(session._child, "read", interrupt)
        with pytest.raises(KeyboardInterrupt):
            session.receive("action")
        assert session.broken


class TestEnding:
    def test_a_dropped_session_ends_its_program(self, start):
        before = children()
        session = start(answering(pack("hello", PROMISE), b""))
        assert len(children() - before) == 1
        del session
        assert children() <= before

    def test_what_the_program_started_ends_with_it(self, tmp_path):
        shell = f"{sys.executable} -c 'import time; time.sleep(60)' & echo $!>&2; wait"
        with pytest.raises(UserError, match=r"did not answer within 0\.5 s") as caught:
            Session(Command(f"sh -c {shell!r}", tmp_path), Promise, seconds=0.5)
        pid = int(str(caught.value).split()[-1])
        assert not _runs(pid)


def _ask_twice(session):
    for _ in range(2):  # A program that has just ended may still seem to listen.
        session.send("act")
        session.receive("action")


def _runs(pid):
    """Whether a process works on, a little later at most."""
    for _ in range(100):
        try:
            if Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return False
        except FileNotFoundError:
            return False
        time.sleep(0.02)
    return True


@pytest.mark.parametrize(
    ("text", "message"),
    [
        pytest.param("", "which is empty: write a program and its arguments", id="empty"),
        pytest.param("python3 'my policy.py", "No closing quotation", id="quote"),
        pytest.param("no-such-program x", "no-such-program: No such file or directory", id="none"),
        pytest.param("/", "/: Permission denied", id="folder"),
    ],
)
def test_a_command_that_cannot_be_started_is_shown(tmp_path, text, message):
    with pytest.raises(UserError) as caught:
        Session(Command(text, tmp_path), Promise)
    assert message in str(caught.value)


def test_a_command_is_no_shell_line(tmp_path):
    with pytest.raises(UserError):
        Session(Command("echo x; touch made", tmp_path), Promise, seconds=5.0)
    assert not (tmp_path / "made").exists()


def test_a_folder_that_is_not_here_is_named(tmp_path):
    with pytest.raises(UserError, match=r"gone: No such file or directory"):
        Session(Command(sys.executable, tmp_path / "gone"), Promise)


def test_the_longest_answer_is_bounded():
    assert MAX_BODY <= 2**28
