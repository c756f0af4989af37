"""The file that users copy: frames, what it may depend on, how it knows what it serves."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rigid.serving import rigid_serve
from rigid.serving.child import Command
from rigid.serving.environment import for_programs
from rigid.serving.rigid_serve import MAGIC, MAX_BODY, PREFIX, FrameError, pack, read_frame
from rigid.serving.session import Promise, Session
from tests.serving.programs import DOUBLER, SERVE_FILE, write_program

EXAMPLE = Path(__file__).parents[2] / "examples" / "assistive_gym" / "serve_scratch_itch.py"


def reader(data):
    """Reads from bytes; fails where a test asks for more than there is."""
    rest = memoryview(data)

    def read(count):
        nonlocal rest
        assert count <= len(rest), "asked for bytes that were never announced"
        part, rest = bytes(rest[:count]), rest[count:]
        return part

    return read


def frame(header, body=b""):
    text = json.dumps(header).encode()
    return PREFIX.pack(MAGIC, len(text), len(body)) + text + body


class TestFrames:
    @pytest.mark.parametrize(
        "array",
        [
            pytest.param(np.arange(6, dtype="<f4").reshape(2, 3), id="float32"),
            pytest.param(np.array([[np.nan, 1e300]]), id="float64"),
            pytest.param(np.array([2**62, -1]), id="int64"),
            pytest.param(np.array([True, False]), id="bool"),
            pytest.param(np.zeros((3, 0), "<f4"), id="no-columns"),
            pytest.param(np.arange(6.0).reshape(2, 3).T, id="not-contiguous"),
            pytest.param(np.arange(3, dtype=">f8"), id="big-endian"),
        ],
    )
    def test_arrays_arrive_as_they_were_sent(self, array):
        found = read_frame(reader(pack("act", {"n": 1}, {"x": array})))
        assert (found.kind, found.fields) == ("act", {"n": 1})
        np.testing.assert_array_equal(found.arrays["x"], array)

    @pytest.mark.parametrize(
        ("data", "message"),
        [
            pytest.param(b"Hello, world! Hi", "begins no frame", id="text"),
            pytest.param(PREFIX.pack(MAGIC, 2**32 - 1, 0), "is too long", id="huge-header"),
            pytest.param(PREFIX.pack(MAGIC, 2, MAX_BODY + 1), "is too long", id="huge-body"),
            pytest.param(PREFIX.pack(MAGIC, 3, 0) + b"{ha", "cannot be read", id="no-json"),
            pytest.param(frame([1]), "cannot be read", id="no-object"),
            pytest.param(frame({"arrays": []}), "cannot be read: 'kind'", id="no-kind"),
            pytest.param(
                frame({"kind": "x", "arrays": [["a", "|O8", [1]]]}, b"12345678"),
                "|O8", id="objects",
            ),
            pytest.param(
                frame({"kind": "x", "arrays": [["a", "<f4", [-1]]]}), "[-1]", id="negative"
            ),
            pytest.param(
                frame({"kind": "x", "arrays": [["a", "<f4", [10**9]]]}, b"1234"),
                "cannot be read", id="shorter-than-its-shape",
            ),
            pytest.param(
                frame({"kind": "x", "arrays": [["a", "<f4", [1]]]}, b"12345678"),
                "8 bytes for arrays of 4", id="longer-than-its-shape",
            ),
        ],
    )  # fmt: skip
    def test_what_is_no_frame_is_refused_before_more_is_read(self, data, message):
        with pytest.raises(FrameError) as caught:
            read_frame(reader(data))
        assert message in str(caught.value)


class TestFile:
    @pytest.mark.parametrize("path", [SERVE_FILE, EXAMPLE], ids=["file", "example"])
    def test_python_3_7_reads_it(self, path):
        ast.parse(path.read_text(encoding="utf-8"), feature_version=(3, 7))

    def test_it_imports_the_standard_library_and_numpy_alone(self):
        tree = ast.parse(SERVE_FILE.read_text(encoding="utf-8"))
        imported = {
            name.partition(".")[0]
            for node in ast.walk(tree)
            for name in (
                [alias.name for alias in node.names] if isinstance(node, ast.Import)
                else [node.module] if isinstance(node, ast.ImportFrom) else []
            )
        }  # fmt: skip
        assert imported - sys.stdlib_module_names == {"numpy"}

    def test_started_by_hand_it_says_how_to_use_it(self, monkeypatch):
        monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
        monkeypatch.setattr(sys, "argv", ["my_policy.py"])
        with pytest.raises(SystemExit) as caught:
            rigid_serve.serve_policy(abs, observation_size=1, action_size=1)
        assert "rigid evaluate --robot 'exec:python3 my_policy.py'" in str(caught.value)

    def test_it_ends_by_itself_when_rigid_is_gone(self, tmp_path):
        command = Command(write_program(tmp_path, DOUBLER), tmp_path)
        found = subprocess.run(
            command.words, input=b"", capture_output=True, check=False, env=for_programs(),
            timeout=120,
        )  # fmt: skip
        assert (found.returncode, found.stdout) == (
            0, b"this goes to whoever looks at standard error\n",
        )  # fmt: skip


class TestFingerprint:
    @pytest.fixture
    def fingerprint(self, tmp_path):
        """What a program that imports `helper` and names weights.bin says of itself."""
        text = """
            import helper
            import rigid_serve
            rigid_serve.serve_policy(
                helper.act, observation_size=2, action_size=1, files=["weights.bin"],
                version={},
            )  # {}
        """

        def ask(*, version=None, comment="", helper="def act(o): return o", weights=b"1"):
            (tmp_path / "helper.py").write_text(helper)
            (tmp_path / "weights.bin").write_bytes(weights)
            command = write_program(tmp_path, text.format(repr(version), comment))
            session = Session(Command(command, tmp_path), Promise)
            session.close()
            return session.promise.fingerprint

        return ask

    def test_the_same_files_give_the_same_fingerprint(self, fingerprint):
        assert fingerprint() == fingerprint()

    @pytest.mark.parametrize(
        "change",
        [
            pytest.param({"comment": "new"}, id="program"),
            pytest.param({"helper": "def act(o): return -o"}, id="module-beside-it"),
            pytest.param({"weights": b"2"}, id="named-file"),
        ],
    )
    def test_any_other_file_gives_another(self, fingerprint, change):
        assert fingerprint() != fingerprint(**change)

    def test_a_version_of_the_user_s_own_replaces_the_files(self, fingerprint):
        assert fingerprint(version="1") == fingerprint(version="1", weights=b"2")
        assert fingerprint(version="1") != fingerprint(version="2")
