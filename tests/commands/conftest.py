"""The toy task behind the command line. Imports stand in the fixtures, as in tests/compute."""

from __future__ import annotations

import json
import shutil

import pytest


@pytest.fixture(scope="session")
def base(tmp_path_factory):
    """Where the toy policies lie, in `pair`."""
    from tests.compute.tiny import store_pair

    base = tmp_path_factory.getbasetemp()
    store_pair(base / "pair")
    return base


@pytest.fixture(scope="session")
def small_run(base):
    """A measurement with two seeds, and its report; the one of tests/compute."""
    from tests.compute.tiny import measured_once

    return measured_once(base, "small")


@pytest.fixture(scope="session")
def single_run(base):
    """The first seed of `small_run` alone; the one of tests/compute."""
    from tests.compute.tiny import measured_once

    return measured_once(base, "single", seeds=[0])


@pytest.fixture
def toys(base, monkeypatch):
    """Installs the toy task and the preset `tiny`; returns the folder of the toy pair."""
    from rigid import presets
    from tests.compute.tiny import TINY, hasten_referees, install_toy

    monkeypatch.syspath_prepend(install_toy(base))
    monkeypatch.setitem(presets.PRESETS, "tiny", TINY)
    hasten_referees(monkeypatch)
    return base / "pair"


@pytest.fixture
def rigid(capsys):
    """Runs a command; returns its exit code, standard output and standard error."""
    from rigid.cli import run

    def command(*arguments):
        code = run([str(argument) for argument in arguments])
        return code, *capsys.readouterr()

    return command


@pytest.fixture
def toy_options(toys):
    """Options that name the toy task and its pair."""
    return (
        "--task", "toy-reach", "--robot", str(toys / "robot"), "--human", str(toys / "human"),
    )  # fmt: skip


@pytest.fixture
def two_runs(small_run, tmp_path):
    """The toy measurement, and one of a robot that fares worse by a fifth with every human."""
    worse = tmp_path / "worse"
    shutil.copytree(small_run.directory, worse)
    data = json.loads((worse / "frontier.json").read_text())
    for point in data["points"]:
        point["adversarialness"] = min(point["adversarialness"] + 0.2, 1.0)
    (worse / "frontier.json").write_text(json.dumps(data))
    return small_run.directory, worse
