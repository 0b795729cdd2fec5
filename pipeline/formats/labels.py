"""What authors say of their grasps, as far as it is a yes or a no."""

from .grasp_file import Grasp, GraspFile

__all__ = ["said_to_hold"]

_YES_OR_NO = (
    *("held", "result", "succ_flag", "object_in_gripper", "quality_flex_object_in_gripper", "success"),
    "confidence",
)


def said_to_hold(file: GraspFile) -> list[bool | None]:
    """Whether the authors of a file say of each grasp that it holds.

    Scores are no answer, nor is a label that is missing: both are None. A time until the object fell is yes
    where it is the longest of the file, the length of the test; 0 is a grasp that was not tested.
    """
    name = next((name for name in _YES_OR_NO if any(name in grasp.labels for grasp in file.grasps)), "")
    if name:
        values = {float(grasp.labels[name]) for grasp in file.grasps if name in grasp.labels}
        if not values <= {0.0, 1.0}:
            return [None] * len(file.grasps)
        return [bool(grasp.labels[name]) if name in grasp.labels else None for grasp in file.grasps]
    times = [float(grasp.labels["fall_time"]) for grasp in file.grasps if "fall_time" in grasp.labels]
    longest = max(times, default=0.0)
    return [_survived(grasp, longest) for grasp in file.grasps]


def _survived(grasp: Grasp, longest: float) -> bool | None:
    time = float(grasp.labels.get("fall_time", 0.0))
    # Simulated time is a sum of steps, so the end of the test is not a round number.
    return None if time <= 0.0 else time >= longest * (1.0 - 1e-4)
