"""What is tested: the kind of a task's test, and directions of gravity by name."""

from typing import Literal, TypeAlias, get_args

from ..errors import UnknownName
from ..objects import SIX, LiftTest, PressTest, Task, TurnTest, sphere
from .settings import Direction

__all__ = ["DIRECTION_SETS", "DirectionSet", "TestKind", "directions", "kind_of_test"]

DirectionSet: TypeAlias = Literal["task", "six", "sphere"]
TestKind: TypeAlias = Literal["lift", "turn", "press"]
DIRECTION_SETS: tuple[str, ...] = get_args(DirectionSet)


def kind_of_test(task: Task) -> TestKind:
    """What the task's test asks of the hand."""
    match task.test:
        case TurnTest():
            return "turn"
        case PressTest():
            return "press"
        case LiftTest():
            return "lift"


def directions(name: str, task: Task) -> tuple[Direction, ...]:
    """Unit vectors in the palm frame.

    Args:
        name: `task` for those of the task's own test (six where that is no lift); `six` along the axes;
            `sphere` for 26 to the faces, edges and corners of a cube.
        task: the task.

    Raises:
        UnknownName: another name.
    """
    if name == "task":
        return task.test.directions if isinstance(task.test, LiftTest) else SIX
    if name == "six":
        return SIX
    if name == "sphere":
        return sphere()
    raise UnknownName("directions", "", "set of directions", name, DIRECTION_SETS)
