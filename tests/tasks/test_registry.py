"""Tasks by name, with what is said to names and parameters that do not exist."""

from importlib.metadata import EntryPoint, EntryPoints

import pytest

from rigid.errors import UserError
from rigid.tasks import registry
from rigid.tasks.itch_scratching.task import ItchScratching
from rigid.tasks.registry import make_task, task_names
from tests.toys import ToyReach


@pytest.fixture
def installed(monkeypatch):
    """A package is installed that offers two tasks."""
    points = EntryPoints(
        (
            EntryPoint("toy-reach", "tests.toys:ToyReach", registry.ENTRY_POINTS),
            EntryPoint("toy-open", "tests.tasks.test_registry:open_toy", registry.ENTRY_POINTS),
        )
    )
    monkeypatch.setattr(registry, "entry_points", points.select)


def open_toy(**parameters):
    return ToyReach(**parameters)


def test_itch_scratching_comes_with_its_defaults(task):
    made = make_task("itch-scratching")
    assert isinstance(made, ItchScratching)
    assert made.describe() == task.describe()
    assert not made.itch_visible


def test_parameters_are_handed_on():
    assert make_task("itch-scratching", horizon=7).horizon == 7


def test_a_task_can_be_built_again_from_its_description():
    described = make_task(
        "itch-scratching", itch_limbs=["forearm"], weights={"distance": 1.0}
    ).describe()
    again = make_task("itch-scratching", **described["parameters"])
    assert again.describe() == described
    assert again.describe()["parameters"]["itch_limbs"] == ("forearm",)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("itch-scraching", "'itch-scraching', did you mean 'itch-scratching'?"),
        ("chess", "'chess'."),
    ],
)
def test_an_unknown_task_is_answered_with_the_known_ones(name, message):
    with pytest.raises(UserError) as error:
        make_task(name)
    assert str(error.value).startswith(f"unknown task {message} Tasks: ")
    assert "itch-scratching" in str(error.value).rsplit(": ", 1)[1]


def test_an_unknown_parameter_is_answered_with_the_valid_ones():
    with pytest.raises(UserError) as error:
        make_task("itch-scratching", percentil=50)
    assert str(error.value) == (
        "itch-scratching: unknown parameter 'percentil', did you mean 'percentile'? Valid: body, "
        "percentile, impairment, severity, servo, weights, horizon, physics_step, substeps, "
        "itch_limbs, itch_spread"
    )


def test_an_unknown_weight_is_answered_with_the_valid_ones():
    with pytest.raises(UserError, match=r"unknown weight 'speed'\. Valid: distance, scratch, "):
        make_task("itch-scratching", weights={"speed": 1.0})


def test_a_value_of_another_type_is_refused():
    with pytest.raises(UserError, match=r"^itch-scratching: a parameter has the wrong type: "):
        make_task("itch-scratching", percentile="50")


@pytest.mark.usefixtures("installed")
def test_installed_tasks_are_found_by_name():
    assert {"toy-reach", "toy-open", "itch-scratching"} <= set(task_names())
    assert make_task("toy-reach", horizon=3).horizon == 3
    assert make_task("toy-open", horizon=4).horizon == 4


@pytest.mark.usefixtures("installed")
def test_parameters_of_installed_tasks_are_those_of_their_signature():
    with pytest.raises(UserError, match=r"^toy-reach: unknown parameter 'horzon', did you mean"):
        make_task("toy-reach", horzon=3)


def test_a_package_cannot_replace_a_task_of_rigid(monkeypatch):
    point = EntryPoint("itch-scratching", "tests.toys:ToyReach", registry.ENTRY_POINTS)
    monkeypatch.setattr(registry, "entry_points", EntryPoints((point,)).select)
    assert isinstance(make_task("itch-scratching"), ItchScratching)
