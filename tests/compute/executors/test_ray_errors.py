"""Which executor a user names, and what they are told of one that cannot be had."""

from __future__ import annotations

import socket
import sys

import pytest

from rigid.compute.executors.executor import find_executor
from rigid.compute.executors.ray_executor import RayExecutor, refuse_other_rigid
from rigid.compute.run.provenance import source_hash
from rigid.errors import UserError


def test_local_leaves_the_choice_until_the_work_is_known():
    assert find_executor("local") is None


def test_ray_alone_is_the_ray_of_this_machine():
    assert find_executor("ray") == RayExecutor(None)


def test_an_address_is_called_before_any_work():
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert find_executor(f"ray:127.0.0.1:{port}") == RayExecutor(f"127.0.0.1:{port}")


KINDS = "executors: local, ray or ray:HOST:PORT"
UNKNOWN = {
    "typing error": ("rey", f"executor 'rey' is unknown, did you mean 'ray'? {KINDS}"),
    "something else": ("slurm", f"executor 'slurm' is unknown; {KINDS}"),
    "empty address": ("ray:", f"executor 'ray:' is unknown, did you mean 'ray'? {KINDS}"),
    "local address": ("local:2", f"executor 'local:2' is unknown, did you mean 'local'? {KINDS}"),
    "no port": ("ray:10.0.0.1", "executor 'ray:10.0.0.1': write the address as ray:10.0.0.1:6379"),
    "no host": ("ray::6379", "executor 'ray::6379': write the address as ray:10.0.0.1:6379"),
}


@pytest.mark.parametrize(("name", "message"), UNKNOWN.values(), ids=UNKNOWN)
def test_an_executor_that_nobody_knows_is_named_with_the_cure(name, message):
    with pytest.raises(UserError) as caught:
        find_executor(name)
    assert str(caught.value) == message


@pytest.fixture
def free_port():
    """A port of this machine on which nobody listens."""
    with socket.socket() as bound:
        bound.bind(("127.0.0.1", 0))
        yield bound.getsockname()[1]


def test_an_address_where_nobody_answers_is_refused_at_once(free_port):
    with pytest.raises(UserError) as caught:
        find_executor(f"ray:127.0.0.1:{free_port}")
    assert str(caught.value).startswith(f"no Ray cluster answers at 127.0.0.1:{free_port} (")
    assert str(caught.value).endswith(
        "): start one there with `ray start --head`, or name another address"
    )


def test_a_port_that_no_machine_has_is_refused():
    with pytest.raises(UserError, match=r"no Ray cluster answers at 127\.0\.0\.1:99999 \("):
        find_executor("ray:127.0.0.1:99999")


def test_a_group_takes_a_cpu_at_least():
    with pytest.raises(UserError, match=r"^cpus is 0, but a group takes at least 1$"):
        RayExecutor(cpus=0)


def test_without_ray_the_user_is_told_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)  # As where it is not installed.
    with pytest.raises(UserError) as caught:
        find_executor("ray")
    assert str(caught.value) == "the executor ray needs Ray: pip install 'rigid-frontier[ray]'"


def test_a_worker_with_another_rigid_is_refused_with_the_cure(tmp_path):
    (tmp_path / "one.py").write_text("x = 1")
    before = source_hash(tmp_path)
    refuse_other_rigid(source_hash(tmp_path), before)
    (tmp_path / "one.py").write_text("x = 2")
    after = source_hash(tmp_path)
    with pytest.raises(UserError) as caught:
        refuse_other_rigid(after, before)
    assert str(caught.value) == (
        f"a worker runs another RIGID (source {after[:8]}, here {before[:8]}), whose numbers are "
        "not these: install the same on every node; the same command goes on"
    )


def test_an_address_in_the_environment_is_joined_or_refused(free_port, monkeypatch):
    monkeypatch.setenv("RAY_ADDRESS", f"127.0.0.1:{free_port}")
    refused = rf"^no Ray cluster answers at 127\.0\.0\.1:{free_port} \("
    with pytest.raises(UserError, match=refused), RayExecutor().workers():
        pass
