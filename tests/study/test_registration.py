"""What is fixed before the first participant stays so."""

import pytest

from rigid.errors import UserError
from rigid.study.analysis.settings import AnalysisSettings
from rigid.study.plan import JudgeStage, Role, default_plan
from rigid.study.registration import register_study, study_hashes, task_facts
from rigid.study.store import Store
from tests.study.toys import consented, toy_plan
from tests.toys import ToyReach, untrained

TASK = ToyReach()
ROBOTS = {"a": untrained(TASK.robot)}


@pytest.fixture
def pairs(tmp_path):
    file = tmp_path / "danger.json"
    file.write_text("pairs")
    return file


@pytest.fixture
def plan(pairs):
    stages = (JudgeStage(question="danger", pairs=pairs, count=1),)
    return toy_plan(roles={"novice": Role(participants=2, stages=stages)})


@pytest.fixture
def store(tmp_path, plan):
    with Store.open(tmp_path / "data", plan) as opened:
        yield opened


def test_everything_that_data_depends_on_is_registered(store, plan):
    found = register_study(store, plan, task=TASK, robots=ROBOTS)
    assert found.keys() == {"study", "analysis", "task", "robots/a", "pairs/danger.json"}
    assert {len(value) for value in found.values()} == {64}
    facts = task_facts(store)
    assert facts is not None
    assert facts.description == TASK.describe()
    assert (facts.feature_names, facts.horizon) == (TASK.feature_names, 10)


def test_files_of_one_name_are_told_apart(tmp_path, plan, pairs):
    other = tmp_path / "other" / "danger.json"
    other.parent.mkdir()
    other.write_text("other pairs")
    stages = tuple(
        JudgeStage(question="danger", pairs=path, count=1) for path in (pairs, other, pairs)
    )
    both = plan.model_copy(update={"roles": {"novice": Role(participants=2, stages=stages)}})
    found = study_hashes(both)
    assert found.keys() == {"study", "analysis", "pairs/danger.json", "pairs/danger.json-2"}
    assert found["pairs/danger.json"] != found["pairs/danger.json-2"]


@pytest.mark.parametrize(
    ("change", "what"),
    [
        pytest.param({"plan": True}, "the study file has changed", id="study"),
        pytest.param({"pairs": True}, "the pair file 'danger.json' has changed", id="pairs"),
        pytest.param({"analysis": AnalysisSettings(margin=0.2)},
                     "the analysis (its settings) has changed", id="analysis"),
        pytest.param({"task": ToyReach(horizon=11)}, "the task has changed", id="task"),
        pytest.param({"robots": {"a": untrained(TASK.robot, seed=1)}}, "robot 'a' has changed",
                     id="robot"),
        pytest.param({"robots": {"b": untrained(TASK.robot)}}, "robot 'b' was not registered",
                     id="another-robot"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("begun", [False, True])
def test_changes_are_refused_once_somebody_consented(store, plan, pairs, change, what, begun):
    given = {"task": TASK, "robots": ROBOTS}
    register_study(store, plan, **given)
    store.invite("novice")  # Who has not come yet fixes nothing.
    if begun:
        store.withdraw(consented(store))  # Also those who withdrew since fixed it.
    change = dict(change)
    if change.pop("plan", False):
        plan = plan.model_copy(update={"title": "Another"})
    if change.pop("pairs", False):
        pairs.write_text("other pairs")
    if not begun:
        register_study(store, plan, **given | change)
        return
    with pytest.raises(UserError) as refusal:
        register_study(store, plan, **given | change)
    assert what in str(refusal.value)
    assert "put it back as it was" in str(refusal.value)
    assert "or begin a new study in another directory with --data" in str(refusal.value)
    of_version = "the version of RIGID that it began with" in str(refusal.value)
    assert of_version == what.startswith(("the task", "the analysis"))


def test_the_same_study_goes_on(store, plan):
    register_study(store, plan, task=TASK, robots=ROBOTS)
    consented(store)
    before = store.registered()
    assert register_study(store, plan, task=TASK, robots=ROBOTS) == before


def test_a_store_keeps_the_plan_for_analysis(tmp_path, plan):
    with Store.open(tmp_path / "data", plan):
        pass
    with Store.read(tmp_path / "data") as store:
        assert store.plan() == plan
    with Store.open(tmp_path / "none") as store:
        assert store.plan() is None


def test_a_store_refuses_another_plan_once_somebody_consented(tmp_path, plan):
    data, other = tmp_path / "data", default_plan("toy-reach", {"a": "builtin:vanilla"})
    with Store.open(data, plan):
        pass
    with Store.open(data, other) as store:
        consented(store)
    with pytest.raises(UserError, match="the study file has changed since it was registered"):
        Store.open(data, plan)
    Store.open(data, other).close()


def test_a_plan_that_lacks_the_role_of_somebody_invited_is_refused(tmp_path, plan):
    with Store.open(tmp_path / "data", plan) as store:
        store.invite("novice")
    other = plan.model_copy(update={"roles": {"expert": plan.roles["novice"]}})
    with pytest.raises(UserError, match="P01 was invited as 'novice', but the study has only exp"):
        Store.open(tmp_path / "data", other)
