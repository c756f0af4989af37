"""What the record says of the command that made a measurement."""

from __future__ import annotations

import pytest

from rigid.compute.run.provenance import command_line


@pytest.mark.parametrize(
    ("program", "said"),
    [
        ("/usr/bin/rigid", "rigid --seeds 0"),
        ("/somewhere/rigid/__main__.py", "rigid --seeds 0"),
        ("/somewhere/benchmarks/paper/__main__.py", "python -m benchmarks.paper --seeds 0"),
        ("mine.py", "mine.py --seeds 0"),
    ],
)
def test_a_command_is_recorded_as_it_may_be_typed_again(monkeypatch, program, said):
    monkeypatch.setattr("sys.argv", [program, "--seeds", "0"])
    assert " ".join(command_line()) == said
