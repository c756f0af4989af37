"""Files that can run code are not opened unless the user trusts them; no library is needed to know.

The payload of these files leaves a mark when it runs.
"""

from __future__ import annotations

import base64
import json
import pickle
import sys
import zipfile

import pytest

from rigid.errors import UserError
from rigid.policies.loading import load_policy
from rigid.policies.opening import Opening
from tests.toys import ToyReach

TASK = ToyReach()


class Payload:
    """Touches a file when it is unpickled."""

    def __init__(self, mark):
        self.mark = str(mark)

    def __reduce__(self):
        return open, (self.mark, "w")


@pytest.fixture
def mark(here):
    """What the payload of `evil.zip` leaves behind."""
    mark = here / "mark"
    pickled = pickle.dumps(Payload(mark))
    entry = {":type:": "class", ":serialized:": base64.b64encode(pickled).decode()}
    with zipfile.ZipFile(here / "evil.zip", "w") as archive:
        archive.writestr("data", json.dumps({"policy_class": entry, "observation_space": entry}))
        archive.writestr("policy.pth", pickled)
    (here / "evil.pt").write_bytes(pickled)
    (here / "evil.pkl").write_bytes(pickled)
    return mark


def load(spec, **options):
    return load_policy(spec, task=TASK, agent="robot", opening=Opening(**options))


@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")
def test_the_payload_would_leave_its_mark(here, mark):
    payload = (here / "evil.pkl").read_bytes()
    pickle.loads(payload).close()  # noqa: S301 - To show that it is one.
    assert mark.exists()


@pytest.mark.parametrize(
    ("spec", "what"),
    [
        ("sb3:evil.zip", "a file of Stable-Baselines3, which holds pickles"),
        ("torchscript:evil.pt", "a TorchScript file"),
    ],
)
def test_without_trust_nothing_runs(here, mark, spec, what):
    message = f"robot '{spec}' is {what}, which can run any code when it is opened: say --trust"
    with pytest.raises(UserError, match=message):
        load(spec, vecnormalize=here / "evil.pkl" if spec.startswith("sb3") else None)
    assert not mark.exists()


@pytest.mark.parametrize("module", ["stable_baselines3", "torch"])
def test_without_the_extra_the_message_says_what_to_install(mark, monkeypatch, module):
    for name in ("stable_baselines3", "torch"):  # The suite runs without them, and with.
        monkeypatch.setitem(sys.modules, name, None if name == module else sys)
    message = rf"robot 'sb3:evil.zip' needs {module}: pip install 'rigid-frontier\[sb3\]'"
    with pytest.raises(UserError, match=message):
        load("sb3:evil.zip", trust=True)
    assert not mark.exists()
