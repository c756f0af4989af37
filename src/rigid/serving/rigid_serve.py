"""Lets a program of yours play in RIGID: it serves a policy or a task over its standard streams.

Copy this file beside your code. It needs Python 3.7 or newer and NumPy, and nothing of RIGID, so
that your code keeps the interpreter and the packages that it was made for. A robot:

    import rigid_serve

    def act(observation):                     # [batch, 30]
        return my_network(observation)        # [batch, 7], in [-1, 1]

    rigid_serve.serve_policy(act, observation_size=30, action_size=7)

and then, wherever RIGID is installed: rigid evaluate --robot "exec:python3 my_policy.py"

What your code prints goes to standard error: standard output belongs to RIGID from the moment that
one of the two functions is called.

Frames, policies, tasks and fingerprints stand in one file, longer than others of RIGID, because it
is copied by hand: two files would come apart.
"""

from __future__ import annotations

import hashlib
import json
import os
import struct
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np

PROTOCOL = 1
"""Version of all that follows; both sides have to speak the same one."""

MAGIC = b"\x93RIGID\r\n"
PREFIX = struct.Struct("<8sII")
"""A frame: MAGIC, length of its header, length of its body; then the header (JSON) and the body
(the arrays that the header lists, one after the other, little-endian, rows first)."""
MAX_HEADER = 1 << 20
MAX_BODY = 1 << 28
"""Bytes; longer ones are refused before a byte of them is read."""
DTYPES = ("<f4", "<f8", "<i8", "|b1")

BUSY_AFTER = 1.0
"""Seconds after which a task that still computes says so."""


class FrameError(ValueError):
    """What arrived is no frame of this protocol."""


class Frame(NamedTuple):
    """One message."""

    kind: str
    fields: dict[str, Any]
    arrays: dict[str, np.ndarray]


def pack(
    kind: str,
    fields: Mapping[str, Any] | None = None,
    arrays: Mapping[str, np.ndarray] | None = None,
) -> bytes:
    """A frame as bytes."""
    listed, parts = [], []
    for name, values in (arrays or {}).items():
        array = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
        listed.append([name, array.dtype.str, list(values.shape)])
        parts.append(array.tobytes())
    header = json.dumps(dict(fields or {}, kind=kind, arrays=listed)).encode()
    body = b"".join(parts)
    return PREFIX.pack(MAGIC, len(header), len(body)) + header + body


def read_frame(read: Callable[[int], bytes]) -> Frame:
    """The next frame.

    Args:
        read: Gives exactly so many bytes, or raises.

    Raises:
        FrameError: It is none, or longer than any that this protocol has.
    """
    prefix = read(PREFIX.size)
    magic, header, body = PREFIX.unpack(prefix)
    if magic != MAGIC:
        raise FrameError(f"{prefix!r} begins no frame")
    if header > MAX_HEADER or body > MAX_BODY:
        raise FrameError(f"a frame of {header + body} bytes is too long")
    return _unpack(read(header), read(body))


def _unpack(header: bytes, body: bytes) -> Frame:
    try:
        fields = json.loads(header.decode())
        kind, listed = str(fields.pop("kind")), fields.pop("arrays")
        arrays, start = {}, 0
        for name, code, shape in listed:
            if code not in DTYPES or not all(isinstance(n, int) and n >= 0 for n in shape):
                raise FrameError(f"array {name!r} is {code} {shape}")
            count = 1
            for size in shape:
                count *= size
            end = start + count * np.dtype(code).itemsize
            arrays[str(name)] = np.frombuffer(body[start:end], code).reshape(shape)
            start = end
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise FrameError(f"a frame cannot be read: {error}") from None
    if start != len(body):
        raise FrameError(f"a frame has {len(body)} bytes for arrays of {start}")
    return Frame(kind, fields, arrays)


def serve_policy(
    act: Callable[..., Any],
    *,
    observation_size: int,
    action_size: int = 0,
    choices: Sequence[int] = (),
    initial_state: Callable[[int], Any] | None = None,
    samples: bool = False,
    files: Sequence[str] = (),
    version: str | None = None,
    timeout: float = 60.0,
) -> None:
    """Serves a policy until RIGID is done.

    Args:
        act: `act(observation) -> action`, for many worlds at once: observation is [batch,
            observation_size], action [batch, action_size] in [-1, 1]; for discrete actions whole
            numbers [batch], or [batch, k] for k of them side by side. With `initial_state` it is
            `act(observation, state) -> (action, state)`.
        observation_size: Numbers that it sees.
        action_size: Reals that it answers; leave it out for discrete actions.
        choices: Of each discrete action, how many choices there are.
        initial_state: `initial_state(batch)` gives the state before an episode: any object, of
            which RIGID sees nothing. Leave it out for a policy without memory.
        samples: Whether `act` takes one more argument, `rng`: a numpy.random.Generator to draw
            noise from, or None, which asks for the mean action.
        files: All that decides how it acts beside your Python files, such as weights: RIGID tells
            by their contents whether this is still the same policy.
        version: Tells it in place of all these files, so that you may edit them: change it when the
            policy acts differently.
        timeout: Seconds that RIGID waits for an answer.

    Raises:
        ValueError: What `act` answered has another shape than was promised.
    """
    sizes = {"observation_size": int(observation_size), "choices": [int(n) for n in choices]}
    sizes["action_size"] = int(sum(choices) or action_size)
    stateful = initial_state is not None
    promise = dict(sizes, stateful=stateful, samples=bool(samples))
    states: dict[int, Any] = {}

    def answer(call: Frame) -> bytes:
        observation = call.arrays["observation"]
        episodes: Any = call.fields.get("episodes")
        for number in call.fields["done_with"]:
            states.pop(number, None)
        arguments: list[Any] = [observation]
        if initial_state is not None:
            if episodes not in states:
                states[episodes] = initial_state(len(observation))
            arguments.append(states[episodes])
        if samples:
            seed = call.fields["seed"]
            arguments.append(None if seed is None else np.random.default_rng(seed))
        action = act(*arguments)
        if initial_state is not None:
            action, states[episodes] = action
        return pack("action", arrays={"action": _action(action, len(observation), sizes)})

    fingerprint = _fingerprint(files, version, promise)
    _serve("policy", promise, {"act": lambda call, _: answer(call)}, fingerprint, timeout)


def serve_task(
    make_env: Callable[[], Any],
    *,
    horizon: int,
    robot: tuple[int, int],
    human: tuple[int, int],
    robot_choices: Sequence[int] = (),
    human_choices: Sequence[int] = (),
    robot_observation_names: Sequence[str] = (),
    human_observation_names: Sequence[str] = (),
    feature_names: Sequence[str] = (),
    return_range: tuple[float, float] | None = None,
    control_period: float = 0.1,
    feature_units: Mapping[str, str] | None = None,
    files: Sequence[str] = (),
    version: str | None = None,
    timeout: float = 60.0,
) -> None:
    """Serves a two-player task until RIGID is done.

    An environment has `reset(seed) -> (robot_observation, human_observation)`, where the same seed
    must begin the same episode, whatever was played before, and `step(robot_action, human_action)
    -> (robot_observation, human_observation, reward, done, info)`, where the reward is shared.
    `info` is a dictionary. RIGID looks at its entries `success` (1 or 0, the last one of an episode
    counts), `features` (what naturalness sees of the human, as long as `feature_names`) and `force`
    (of the robot on the person [N]); other numbers in it are kept as measurements.

    Args:
        make_env: Makes an environment; it is called for every world that RIGID plays at once.
        horizon: Steps of an episode. One that is done earlier is filled up: it is not stepped any
            more, reward is 0 from then on, and ending early gains nobody anything.
        robot: How many numbers the robot sees, and how many actions in [-1, 1] it takes; with
            `robot_choices` the second is not looked at.
        human: The same of the human.
        robot_choices: Of each discrete action of the robot, how many choices there are; `step` is
            then given an int, or an array of them for several.
        human_choices: The same of the human.
        robot_observation_names: A name for each number that the robot sees; optional.
        human_observation_names: A name for each number that the human sees; optional.
        feature_names: A name for each feature; without any, naturalness sees what the human
            observes and does.
        return_range: Returns (worst, best) that map to adversarialness 1 and 0, if they are known.
        control_period: Time that passes in a step [s].
        feature_units: What features are measured in, by their names; optional.
        files: All that decides how it works beside your Python files, such as meshes: RIGID tells
            by their contents whether this is still the same task.
        version: Tells it in place of all these files, so that you may edit them and keep recordings
            and runs: change it when the task's numbers change.
        timeout: Seconds that RIGID waits for one environment.

    Raises:
        ValueError: An environment answered something of another shape than was promised.
    """
    players = (_player(robot, robot_choices), _player(human, human_choices))
    promise = {
        "horizon": int(horizon),
        "robot": dict(players[0], observation_names=list(robot_observation_names)),
        "human": dict(players[1], observation_names=list(human_observation_names)),
        "feature_names": list(feature_names),
        "return_range": None if return_range is None else [float(x) for x in return_range],
        "control_period": float(control_period),
        "feature_units": dict(feature_units or {}),
    }
    worlds: dict[int, list[Any]] = {}
    spare: list[Any] = []
    sizes = (players[0]["observation_size"], players[1]["observation_size"], len(feature_names))

    def free(call: Frame) -> None:
        for number in call.fields["done_with"]:
            spare.extend(worlds.pop(number, []))

    def reset(call: Frame, busy: Callable[[], None]) -> bytes:
        free(call)
        seeds = call.arrays["seeds"]
        envs = worlds.setdefault(call.fields["worlds"], [])
        table = _Table(len(seeds), sizes)
        for row, seed in enumerate(seeds):
            if row == len(envs):
                envs.append(spare.pop() if spare else make_env())
            robot_observation, human_observation = envs[row].reset(int(seed))
            table.see(row, robot_observation, human_observation)
            busy()
        return table.pack()

    def step(call: Frame, busy: Callable[[], None]) -> bytes:
        free(call)
        running, envs = call.arrays["running"], worlds[call.fields["worlds"]]
        table = _Table(len(running), sizes)
        for row in np.flatnonzero(running).tolist():
            robot_action = _given(call.arrays["robot_action"][row], players[0])
            human_action = _given(call.arrays["human_action"][row], players[1])
            table.take(row, *envs[row].step(robot_action, human_action))
            busy()
        return table.pack()

    fingerprint = _fingerprint(files, version, promise)
    _serve("task", promise, {"reset": reset, "step": step}, fingerprint, timeout)


def _player(sizes: tuple[int, int], choices: Sequence[int]) -> dict[str, Any]:
    counts = [int(n) for n in choices]
    action_size = sum(counts) or int(sizes[1])
    return {"observation_size": int(sizes[0]), "action_size": action_size, "choices": counts}


def _given(action: np.ndarray, player: Mapping[str, Any]) -> Any:
    """What an environment is given: reals, a choice, or several of them."""
    return int(action[0]) if len(player["choices"]) == 1 else action.copy()


class _Table:
    """What the worlds of one call answered."""

    def __init__(self, worlds: int, sizes: Sequence[int]) -> None:
        self._columns = {
            "robot_observation": np.zeros((worlds, sizes[0]), "<f4"),
            "human_observation": np.zeros((worlds, sizes[1]), "<f4"),
            "features": np.zeros((worlds, sizes[2]), "<f4"),
            "reward": np.zeros(worlds, "<f8"),
            "ended": np.zeros(worlds, "|b1"),
        }
        self._info: dict[str, np.ndarray] = {}

    def see(self, row: int, robot: Any, human: Any) -> None:
        """Keeps what the players see."""
        self._put("robot_observation", row, robot)
        self._put("human_observation", row, human)

    def take(
        self, row: int, robot: Any, human: Any, reward: Any, done: Any, info: Mapping[str, Any]
    ) -> None:
        """Keeps what a step led to."""
        self.see(row, robot, human)
        self._columns["reward"][row] = float(reward)
        self._columns["ended"][row] = bool(done)
        if self._columns["features"].shape[1]:
            if "features" not in info:
                raise ValueError("info has no 'features', but serve_task was told feature_names")
            self._put("features", row, info["features"])
        for name, value in info.items():
            if name != "features" and isinstance(value, (bool, int, float, np.number, np.bool_)):
                if name not in self._info:
                    self._info[name] = np.full(len(self._columns["reward"]), np.nan)
                self._info[name][row] = float(value)

    def pack(self) -> bytes:
        """The answer."""
        named = {"info " + name: values for name, values in self._info.items()}
        return pack("moment", arrays=dict(self._columns, **named))

    def _put(self, name: str, row: int, value: Any) -> None:
        values, target = np.asarray(value, dtype="f4"), self._columns[name]
        if values.shape != target[row].shape:
            raise ValueError(
                f"the environment answered {name} of shape {values.shape}, but serve_task was told "
                f"{target[row].shape}"
            )
        target[row] = values


def _action(action: Any, batch: int, sizes: Mapping[str, Any]) -> np.ndarray:
    """What `act` answered, checked; whole numbers for discrete actions."""
    values = np.asarray(action)
    choices = sizes["choices"]
    wanted = (batch, len(choices) or sizes["action_size"])
    if values.shape != wanted and values.shape != (batch,) * (wanted[1] == 1):
        raise ValueError(
            f"act answered an array of shape {values.shape}, but serve_policy was told {wanted}"
        )
    if choices and values.dtype.kind not in "iu":
        raise ValueError(f"act answered {values.dtype}, but choices are whole numbers")
    return values.reshape(wanted).astype("<i8" if choices else "<f8")


def _serve(
    what: str,
    promise: Mapping[str, Any],
    handlers: Mapping[str, Callable[[Frame, Callable[[], None]], bytes]],
    fingerprint: str,
    timeout: float,
) -> None:
    """Answers calls until the other side closes."""
    if sys.stdin is not None and sys.stdin.isatty():
        role = "--robot" if what == "policy" else "--task"
        raise SystemExit(
            f"this program is started by RIGID: rigid evaluate {role} 'exec:python3 {sys.argv[0]}'"
        )
    fields = dict(
        promise, protocol=PROTOCOL, serves=what, fingerprint=fingerprint, timeout=float(timeout)
    )
    calls, answers = _take_streams()
    last = time.monotonic()

    def send(data: bytes) -> None:
        nonlocal last
        answers.write(data)
        answers.flush()
        last = time.monotonic()

    def busy() -> None:
        if time.monotonic() - last > BUSY_AFTER:
            send(pack("busy"))

    with suppress(EOFError, BrokenPipeError):  # RIGID is done.
        while True:
            call = read_frame(lambda count: _exactly(calls, count))
            last = time.monotonic()
            send(pack("hello", fields) if call.kind == "hello" else handlers[call.kind](call, busy))


def _take_streams() -> tuple[BinaryIO, BinaryIO]:
    """The pipes to RIGID; whatever else reads or prints meets nothing, and standard error."""
    sys.stdout.flush()
    calls, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)  # Also what C libraries print.
    return calls, answers


def _exactly(stream: BinaryIO, count: int) -> bytes:
    data = stream.read(count)
    if len(data) < count:
        raise EOFError
    return data


def _fingerprint(files: Sequence[str], version: str | None, promise: Mapping[str, Any]) -> str:
    """SHA-256 over what is promised and the version; without one, over all files of the program.

    Those are the program, its own modules beside it, and `files`.
    """
    promised = json.dumps(dict(promise, version=version), sort_keys=True).encode()
    if version is not None:
        return hashlib.sha256(promised).hexdigest()
    places = {Path(name).resolve(): str(name) for name in files}
    folder = _file_of(sys.modules["__main__"]).parent
    for path in map(_file_of, list(sys.modules.values())):
        if path.is_file() and folder in path.parents and not _is_foreign(path, folder):
            places.setdefault(path, path.relative_to(folder).as_posix())
    digest = hashlib.sha256(promised)
    for path, name in sorted(places.items(), key=lambda item: item[1]):
        content = hashlib.sha256(path.read_bytes()).hexdigest()
        digest.update(f"\0{name}\0{content}".encode())
    return digest.hexdigest()


def _file_of(module: Any) -> Path:
    """Where a module lies; a path of no file where it lies nowhere."""
    known = getattr(module, "__dict__", {})  # Asking the module itself might load a lazy one.
    return Path(known.get("__file__") or "none").resolve()


def _is_foreign(path: Path, folder: Path) -> bool:
    """Whether it is this file, an installed package or Python's own."""
    library = Path(os.__file__).resolve().parent
    installed = "site-packages" in path.relative_to(folder).parts
    return installed or library in path.parents or path == Path(__file__).resolve()
