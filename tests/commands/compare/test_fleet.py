"""`rigid compare --robots` and `--executor`: what is refused, and a fleet on this machine."""

from __future__ import annotations

import pytest

from rigid.commands.compare.fleet import FleetBar, OneOfFleet, names_of
from rigid.compute.listening import Workload
from rigid.errors import UserError
from rigid.policies.native import save_policy
from tests.compute.tiny import FilmedReach
from tests.toys import untrained


@pytest.fixture
def compare(rigid, toys, tmp_path):
    """`rigid compare` on the toy robot; later options win."""

    def command(*options):
        toy = ("--task", "toy-reach", "--human", toys / "human", "--preset", "tiny")
        return rigid("compare", "--out", tmp_path / "fleet", *toy, *options)

    return command


@pytest.fixture
def other(toys):
    """Another toy robot."""
    task, place = FilmedReach(), toys / "other"
    save_policy(
        untrained(task.robot, seed=2), place, agent="robot", task=task.describe(), provenance={}
    )
    return place


def test_robots_are_measured_into_their_folders_then_compared(compare, toys, other, tmp_path):
    robots = ("--robots", toys / "robot", other, "--seeds", "0")
    code, out, err = compare(*robots)
    assert code == 0
    for name in ("robot", "other"):
        assert (tmp_path / "fleet" / name / "frontier.json").exists()
        assert f"{name}: " in err
    assert "minus robot, on the search seeds that both have" in out
    assert compare(*robots)[:2] == (0, out)


REFUSED = {
    "no place": (("--robots", "a", "b"), "--robots need --out DIR, where they are measured"),
    "one robot": (
        ("--robots", "a", "--out", "o"),
        "compare takes two or more: run directories, or --robots to be measured",
    ),
    "no robots": (
        ("runs/a", "runs/b", "--executor", "ray"),
        "--executor is for --robots: name the robots to be measured",
    ),
    "place without robots": (
        ("runs/a", "runs/b", "--out", "o"),
        "--out is for --robots: name the robots to be measured",
    ),
}


@pytest.mark.parametrize(("options", "message"), REFUSED.values(), ids=REFUSED)
def test_options_that_do_not_go_together_exit_with_2(rigid, options, message):
    assert rigid("compare", *options) == (2, "", f"rigid: {message}\n")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--executor", "rey"), "executor 'rey' is unknown, did you mean 'ray'?"),
        (("--seeds", "x"), "--seeds 'x': 'x' is no seed"),
        (("--preset", "tyni"), "preset 'tyni' is unknown; presets: demo, standard, "),
    ],
)
def test_a_bad_value_exits_with_2_and_measures_nothing(
    compare, toys, other, tmp_path, options, message
):
    code, out, err = compare("--robots", toys / "robot", other, *options)
    assert (code, out) == (2, "")
    assert message in err
    assert not (tmp_path / "fleet").exists()


def test_a_robot_that_does_not_load_stops_the_fleet_before_any_work(compare, toys, tmp_path):
    code, _, err = compare("--robots", toys / "robot", "nowhere")
    assert code == 2
    assert err.startswith("rigid: robot 'nowhere' is no directory")
    assert not (tmp_path / "fleet").exists()


def test_files_that_can_run_code_are_opened_for_a_fleet_only_with_trust(compare, toys, tmp_path):
    (tmp_path / "model.zip").write_bytes(b"no zip")
    robots = ("--robots", toys / "robot", f"sb3:{tmp_path / 'model.zip'}")
    assert "say --trust if you trust whoever made it" in compare(*robots)[2]
    code, _, err = compare(*robots, "--trust")
    assert code == 2
    assert "--trust" not in err


def test_frontier_refuses_an_executor_that_nobody_knows(rigid, toy_options, tmp_path):
    given = ("--preset", "tiny", "--out", tmp_path / "run", "--executor", "rey")
    code, _, err = rigid("frontier", *toy_options, *given)
    assert code == 2
    assert "executor 'rey' is unknown, did you mean 'ray'? executors: local, ray or ray:" in err
    assert not (tmp_path / "run").exists()


def test_robots_of_one_name_are_refused():
    with pytest.raises(UserError) as caught:
        names_of(["builtin:vanilla", "runs/vanilla/"])
    assert str(caught.value) == (
        "--robots 'builtin:vanilla' and 'runs/vanilla/' would both be measured in the folder "
        "'vanilla': rename one, or measure it with `rigid frontier` and compare directories"
    )


@pytest.mark.parametrize(
    ("robot", "name"),
    [("a/b.onnx", "b.onnx"), ("exec:./play --fast", "play---fast"), ("..", "robot")],
)
def test_any_robot_gets_a_folder_of_its_own(robot, name):
    assert names_of([robot]) == [name]


class Terminal:
    """Remembers what the bar stands for, and what was said."""

    def __init__(self) -> None:
        self.total, self.done, self.lines = 0, 0, []

    def expect(self, steps):
        self.total = steps

    def resume(self, work):
        self.done += work.done

    def advance(self, steps):
        self.done += steps

    def say(self, text):
        self.lines.append(text)


def test_one_bar_stands_for_all_robots_also_those_that_nobody_expected():
    terminal = Terminal()
    bar = FleetBar(terminal, 300)
    totals = []
    for name, steps in (("a", 100), ("b", 200), ("c", 50)):
        robot = OneOfFleet(bar, name)
        robot.begin(Workload(training_steps=steps // 2, steps=steps, done=10, steps_per_second=1.0))
        robot.advance(steps - 10)
        totals.append(terminal.total)
    assert totals == [300, 300, 350]
    assert terminal.done == 350
    assert terminal.lines[0] == "a: 50 training steps"
