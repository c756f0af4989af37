"""Factories by name: found in the working directory, and explained when they are not."""

import pytest

from rigid.errors import UserError
from rigid.factories import call_factory
from rigid.tasks.registry import make_task

HERE = "pettingzoo:tests.tasks.bridges.environments"


def test_a_module_of_the_working_directory_is_found(tmp_path, monkeypatch):
    (tmp_path / "strangers_tasks.py").write_text("def five():\n    return 5\n")
    monkeypatch.setattr("sys.path", ["/nowhere"])
    assert call_factory("gymnasium:strangers_tasks:five", str(tmp_path)) == 5


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("pettingzoo:", "'pettingzoo:' names no factory in a module: write pettingzoo:MODULE:FACT"),
        ("pettingzoo:mine", "write pettingzoo:MODULE:FACTORY, as pettingzoo:my_code:make"),
        ("pettingzoo:a/b.py:make", "names no factory in a module"),
        ("pettingzoo:not_there:make", "there is no module 'not_there', neither in /.* nor inst"),
        (f"{HERE}:not_there", r"environments:not_there: the module has no 'not_there'"),
        (f"{HERE}:REAL", r"environments:REAL is a Box, but must be a function"),
        (f"{HERE}:REALL", r"has no 'REALL', did you mean 'REAL'\? write pettingzoo:MODULE"),
        (f"{HERE}:broken", r"calling the factory fails: RuntimeError: no licence found \(.*:\d+\)"),
        (f"{HERE}:with_argument", r"takes no arguments: write one that calls with_argument"),
        ("gymnasium:tests.tasks.mistaken_import:x", "there is no module 'tests.tasks.mistaken_imp"),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(name, message):
    with pytest.raises(UserError, match=message):
        make_task(name)


def test_a_module_that_fails_is_named_with_the_place(tmp_path):
    (tmp_path / "strangers_mistake.py").write_text("import no_such_library\n")
    message = (
        r"importing strangers_mistake fails: ModuleNotFoundError: .*'no_such_library' \(.*:1\)"
    )
    with pytest.raises(UserError, match=message):
        call_factory("gymnasium:strangers_mistake:make", str(tmp_path))


def test_an_unknown_kind_is_answered_with_the_known_ones():
    with pytest.raises(UserError, match=r"unknown task 'petting:a:b'.*exec:…, gymnasium:…, pett"):
        make_task("petting:a:b")
