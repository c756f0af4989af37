"""`rigid export --serve`, and programs that it lets play, as users call them."""

import pytest

from tests.serving.programs import DOUBLER, REACH, SERVE_FILE, write_program


def test_the_file_is_written_and_written_again(rigid, tmp_path):
    path = tmp_path / "new" / "rigid_serve.py"
    for _ in range(2):
        code, said, _ = rigid("export", "--serve", path)
        assert (code, said) == (
            0, f"{path}: import it in a program of yours (docs/exec.md says how)\n",
        )  # fmt: skip
        assert path.read_bytes() == SERVE_FILE.read_bytes()
        path.write_bytes(SERVE_FILE.read_bytes() + b"# of an older RIGID")


def test_a_file_of_the_user_s_own_is_kept(rigid, tmp_path):
    path = tmp_path / "my_policy.py"
    path.write_text("import rigid_serve\n")
    code, _, said = rigid("export", "--serve", path)
    assert (code, path.read_text()) == (2, "import rigid_serve\n")
    assert "would overwrite a file of your own: name another one" in said


def test_it_goes_alone(rigid, tmp_path):
    code, _, said = rigid("export", "--serve", tmp_path / "x.py", "--seed", 3)
    assert code == 2
    assert "--serve FILE goes alone" in said


def test_a_robot_in_a_program_is_evaluated(rigid, toys, tmp_path):
    code, said, _ = rigid(
        "evaluate", "--task", "toy-reach", "--human", toys / "human", "--episodes", 3,
        "--robot", f"exec:{write_program(tmp_path, DOUBLER)}",
    )  # fmt: skip
    assert code == 0
    assert "so does this" not in said


def test_a_task_in_a_program_is_evaluated(rigid, tmp_path):
    task = f"exec:{write_program(tmp_path, REACH)}"
    robot = f"exec:{write_program(tmp_path, DOUBLER, 'robot.py')}"
    code, said, _ = rigid(
        "evaluate", "--task", task, "--robot", robot, "--human", "builtin:passive", "--episodes", 3
    )
    assert code == 0
    assert "return                 -10.000" in said, "nobody moves, and the goal is 1 away"


@pytest.mark.parametrize(
    "option", [pytest.param(("--task", "analytic/offset-catch", "--robot"), id="robot"), ["--task"]]
)
def test_a_broken_program_says_its_last_words_in_lines(rigid, tmp_path, option):
    command = write_program(tmp_path, "import sys; sys.exit('first\\nsecond\\x1b[2J')")
    code, _, said = rigid("evaluate", *option, f"exec:{command}")
    lines = said.splitlines()
    assert code == 2
    assert lines[0].startswith("rigid: ")
    assert lines[1:] == ["  first", "  second\\x1b[2J"]
