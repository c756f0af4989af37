"""An interrupted command promises no more than it can keep."""

from __future__ import annotations

import pytest

from rigid.commands.terminal.stopping import goes_on


def interrupted(place, kept=None):
    with pytest.raises(KeyboardInterrupt) as caught, goes_on(place, kept):
        raise KeyboardInterrupt
    return str(caught.value)


def test_before_anything_is_kept_a_command_says_that_it_begins_anew(tmp_path):
    anew = "nothing was kept yet, so the same command begins anew"
    assert interrupted(tmp_path / "new") == anew
    (tmp_path / "settings.json").touch()
    assert interrupted(tmp_path) == anew


@pytest.mark.parametrize(
    "weights", ["checkpoint.safetensors", "groups/s0-r1.safetensors", "pair/human/w.safetensors"]
)
def test_what_holds_weights_goes_on(tmp_path, weights):
    (tmp_path / weights).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / weights).touch()
    assert interrupted(tmp_path) == f"the same command goes on in {tmp_path}"


def test_a_command_may_know_better_what_is_kept(tmp_path):
    assert interrupted(tmp_path, lambda: True) == f"the same command goes on in {tmp_path}"


def test_a_training_that_is_stopped_before_its_first_checkpoint_says_so(
    rigid, toys, tmp_path, monkeypatch
):
    from rigid.robots import pair

    def stop(*_, **__):
        raise KeyboardInterrupt

    del toys
    monkeypatch.setattr(pair, "co_optimise", stop)
    command = ("train", "co-optimize", "--task", "toy-reach", "--out", tmp_path / "pair")
    code, _, err = rigid(*command)
    assert code == 130
    assert err.endswith(
        "rigid: interrupted; nothing was kept yet, so the same command begins anew\n"
    )
