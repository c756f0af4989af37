"""What examples/ shows how to write works as it stands there."""

import ast
import tomllib
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path

import pytest

from rigid.tasks import registry
from rigid.tasks.conformance import broken_promises
from rigid.tasks.registry import make_task

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def own_task(monkeypatch):
    """The template, as if it were installed."""
    folder = EXAMPLES / "own_task"
    project = tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))
    offered = project["project"]["entry-points"][registry.ENTRY_POINTS]
    points = EntryPoints(
        EntryPoint(name, place, registry.ENTRY_POINTS) for name, place in offered.items()
    )
    monkeypatch.syspath_prepend(folder)
    monkeypatch.setattr(registry, "entry_points", points.select)
    return folder


def test_the_template_of_a_task_keeps_its_promises(own_task):
    del own_task
    assert broken_promises(make_task("hand-over")) == ()


def test_the_template_of_a_task_is_short(own_task):
    assert len((own_task / "own_task.py").read_text(encoding="utf-8").splitlines()) <= 80


def test_the_handover_of_gymnasium_keeps_its_promises(monkeypatch):
    monkeypatch.syspath_prepend(EXAMPLES / "tasks")
    task = make_task("gymnasium:handover:make")
    assert broken_promises(task) == ()
    assert task.feature_names == ("x", "y", "speed x", "speed y")


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("tasks/*.py")), ids=lambda file: file.stem)
def test_every_example_names_itself_in_its_command(file):
    module = ast.parse(file.read_text(encoding="utf-8"))
    functions = {part.name for part in module.body if isinstance(part, ast.FunctionDef)}
    place = ast.get_docstring(module).split("--task ")[1].split()[0]
    _, name, factory = place.split(":")
    assert name == file.stem
    assert factory in functions
