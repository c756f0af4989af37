"""What the study tries: steps, pairs, swings, and the limits that a step has to keep."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.task import RETURN_RANGE
from rigid.tasks.physics.again import FINE_STEP
from rigid.tasks.physics.stepping import MAX_PENETRATION

_CONTROL = 0.1
"""A control step [s] (the original); every setting fills one."""


@dataclass(frozen=True)
class Setting:
    """A physics step [s]; as many as fit make a control step."""

    step: float

    @property
    def substeps(self) -> int:
        """Physics steps in a control step."""
        return round(_CONTROL / self.step)

    @property
    def name(self) -> str:
        """As the account prints it.

        Example:
            >>> Setting(0.02).name, Setting(0.002).name
            ('0.02 s × 5', '0.002 s × 50')
        """
        return f"{self.step:g} s × {self.substeps}"


DEFAULT = Setting(ItchScratchingParameters().physics_step)
"""What the task uses, and what the verdicts are about."""
SETTINGS = (DEFAULT, Setting(0.01), Setting(0.005), Setting(0.002))
FINEST = SETTINGS[-1]
"""The one that closed loops are compared with."""
WINDOW_REFERENCE = Setting(FINE_STEP)
"""The one that windows are compared with: the step at which the report simulates forces again.
Short windows can afford it, so that they tell how good 0.002 s itself is."""

PAIRS = ("canonical", "loud", "flailing")
"""Humans beside the bundled robot, see `people.human_named`."""

AGED = ("canonical", "loud")
"""Those who play the finest step once more, with poses as old as at the task's step: the humans
whom the robot can help, and whose help may suffer from old poses."""

Swing = Literal["free", "contact", "braked"]
SWINGS: dict[Swing, str] = {
    "free": "no servo, no contact, no joint limit",
    "contact": "no servo, with contacts and joint limits",
    "braked": "as in the task: servos at action 0, contacts, joint limits",
}
SPEEDS = (0.566, 2.0)
"""Fastest joint at the start of a swing [rad/s]: what a servo reaches at full action, and beyond
what any joint does in these plays (the account prints the fastest)."""


@dataclass(frozen=True, kw_only=True)
class Limit:
    """What may lie between a step and the reference, set before the full run. All ours."""

    part: str
    number: str
    bound: float
    text: str
    """The rule, as the account prints it."""
    case: str = ""
    """How the names of its cases begin; every case by default."""
    upper_only: bool = False
    """Whether only more is worse, as of energy and faults."""


LIMITS = (
    Limit(
        part="closed", number="return", bound=0.02 * (RETURN_RANGE[1] - RETURN_RANGE[0]),
        text="return: 2 % of the range of adversarialness",
    ),
    # A yes or no for each episode: some hundred of them do not tell 0.02.
    Limit(part="closed", number="success", bound=0.05, text="success: 0.05"),
    Limit(part="closed", number="impulse", bound=0.10, text="impulse of an episode: 10 %"),
    Limit(part="closed", number="peak_force", bound=0.20, text="peak force of an episode: 20 %"),
    # The share beyond which a point is not on the frontier.
    Limit(
        part="closed", number="faulted", bound=0.01, upper_only=True, text="faulted episodes: 1 %"
    ),
    # A tenth of the distance that a counted contact has to move.
    Limit(
        part="closed", number="penetration", bound=1e-3, upper_only=True,
        text="deepest overlap of an episode: 1 mm deeper",
    ),
    Limit(part="windows", number="impulse", bound=0.10, text="impulse of a half second: 10 %"),
    Limit(
        part="windows", number="peak_force", bound=0.20, text="peak force of a half second: 20 %"
    ),
    Limit(
        part="windows", number="angles", bound=0.1, upper_only=True,
        text="arm's joint angles after a half second: 0.1 canonical deviations apart",
    ),
    *(
        Limit(
            part="energy", number="growth", case=swing, bound=0.01, upper_only=True,
            text=f"energy of a swing, *{swing}*, at its highest: 1 % above the start",
        )
        for swing in SWINGS
    ),
)  # fmt: skip
DEEPEST = MAX_PENETRATION
"""Deeper overlaps [m] are faults of the task."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """One run of the study."""

    episodes: Mapping[str, int]
    """Of each pair at each step, with policies that act: enough for its intervals to be narrower
    than the limits, as far as some minutes allow."""
    block: int = 100
    """Episodes played side by side."""
    recorded: int = 60
    """Episodes of each pair whose targets are replayed."""
    window: int = 5
    """Control steps of a replay: 0.5 s, too short for chaos to grow."""
    swings: int = 60
    """Bodies let go, for each kind, speed and step."""
    swing_steps: int = 100
    """Control steps of a swing: an episode."""
    turns: int = 9
    """Times that the cost of every step is measured."""
    turn_steps: int = 40
    """Control steps of a turn."""
    seed: int = 0
    """Everything random here comes from it."""
    command: str = "python -m benchmarks.physics"
    stamp: str = ""
    """Printed on the account."""

    def describe(self) -> dict[str, Any]:
        """What the kept parts depend on, as JSON."""
        facts = asdict(self)
        return {key: facts[key] for key in facts if key not in {"command", "stamp"}}


PLAN = Plan(episodes={"canonical": 400, "loud": 600, "flailing": 1200})
QUICK = Plan(
    episodes=dict.fromkeys(PAIRS, 4),
    block=4,
    recorded=6,
    swings=3,
    swing_steps=20,
    turns=2,
    turn_steps=3,
    command="python -m benchmarks.physics --quick",
    stamp="\n*Quick run: so few episodes say nothing about any step.*\n",
)
