"""Who may touch whom, decided by roles."""

import itertools

import pytest

from rigid.tasks.bodies.collision import Role

MEET = {
    frozenset(pair)
    for pair in (
        *itertools.product(
            (Role.ROBOT, Role.WRIST, Role.TOOL),
            (Role.ARM, Role.SHOULDER, Role.TRUNK, Role.CHAIR),
        ),
        (Role.ARM, Role.TRUNK), (Role.ARM, Role.CHAIR), (Role.WRIST, Role.ROBOT),
        (Role.TOOL, Role.ROBOT),
    )
}  # fmt: skip
EXAMPLES = {
    Role.ARM: "right_forearm",
    Role.SHOULDER: "right_shoulder",
    Role.TRUNK: "chest",
    Role.CHAIR: "right_arm_rest",
    Role.ROBOT: "jaco_link_2",
    Role.WRIST: "jaco_link_7",
    Role.TOOL: "scratcher_tip",
    Role.NONE: "right_wheel_0",
}


@pytest.mark.parametrize(
    ("one", "other"),
    list(itertools.combinations_with_replacement(EXAMPLES, 2)),
    ids=lambda role: role.name,
)
def test_two_roles_collide_exactly_when_they_are_meant_to(task, one, other):
    a, b = (task.model.geom(EXAMPLES[role]) for role in (one, other))
    collide = bool((a.contype[0] & b.conaffinity[0]) | (b.contype[0] & a.conaffinity[0]))
    assert collide == (frozenset((one, other)) in MEET)


@pytest.mark.parametrize("part", ["chest", "head", "left_forearm", "right_thigh", "right_hand"])
def test_the_robot_can_touch_every_part_of_the_person(task, part):
    tool, geom = task.model.geom("scratcher_tip"), task.model.geom(part)
    assert tool.contype[0] & geom.conaffinity[0] or geom.contype[0] & tool.conaffinity[0]
