"""What one robot lacks holds up no other."""

from __future__ import annotations

from benchmarks.paper import running
from benchmarks.paper.places import Places
from benchmarks.paper.plan import SCOUTS, full_plan
from rigid.presets import PRESETS
from rigid.robots.robust_gt import NoTeachersError
from tests.benchmarks.paper.samples import PLAN, keep


def test_a_robot_with_nobody_to_learn_from_is_left_out_and_said(tmp_path, monkeypatch, capsys):
    done = []

    def refuse():
        raise NoTeachersError("scout has no adversary")

    def job(name, do):
        return running.Job(name, 1, 0, lambda: False, do)

    given = [job("robust-gt", refuse), job("gleave", lambda: done.append("gleave"))]
    monkeypatch.setattr(running, "jobs", lambda *_: given)
    places = Places(tmp_path / "raw", tmp_path / "results")
    keep(places, "vanilla", 0, {0: 0.5, 1: 0.6})
    running.run(PLAN, out=places.out, results=places.results)
    assert done == ["gleave"]
    assert "left out: scout has no adversary" in capsys.readouterr().out
    assert (places.results / "README.md").exists()


def test_robust_gt_learns_from_the_papers_own_search_where_the_plan_has_one():
    assert (PLAN.scouting.name, PLAN.scouting.seeds) == ("paper", SCOUTS)
    quick = full_plan(PRESETS["demo"], (0,))
    assert (quick.scouting.name, quick.scouting.seeds) == ("demo", SCOUTS)
    assert not set(SCOUTS) & set(PLAN.preset.seeds)
