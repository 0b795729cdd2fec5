"""The README of a run folder: what lies there, and what can be done with it."""

from ...base.text.plain_text import counted, one_line
from ...mjcf.hold import verdict_word
from ...objects import Task
from ..records import RunRecord
from .reproduce import command_of

__all__ = ["readme"]

_TEXT = """# {task}: {verdict}

A run of Holdfast {version}: hand {hand}, object {object}, {count}.

| file | holds |
|---|---|
| `report.html` | all of it for people: open it in a browser, with or without a network |
| `run.json` | all of it for programs |
| `grasps/<id>.json` | a grasp, for `holdfast clear`, `hold`, `render` and `view` |
| `grasps/<id>.xml` | hand and object for MuJoCo (MJCF), beginning in the grasp; needs no other file |
| `media/` | pictures, and the test of the best grasp as a video |

Units are m, rad, kg, s and N; quaternions are w, x, y, z; poses are in the palm frame.
{look}{again}"""
_LOOK = """
## To look at a grasp

    holdfast view {best}.json

or in MuJoCo's own viewer, `python -m mujoco.viewer --mjcf={best}.xml`. The model begins in the grasp, and
the hand {does} while all controls are zero. From Python:

    import mujoco
    model = mujoco.MjModel.from_xml_path("{best}.xml")
    data = mujoco.MjData(model)
    model.opt.gravity[:] = 0, 0, -9.81
    mujoco.mj_step(model, data, 1000)

A control is how far a servo's target lies off that of this beginning.{keys}
"""
_KEYS = " Keyframe `grasp` has the servos at rest, and\n`pregrasp` the fingers open."
_AGAIN = """
## To make it again

    {command}
"""


def readme(task: Task, record: RunRecord) -> str:
    """The text of `README.md` in a run's folder."""
    command = command_of(record)
    look = ""
    if record.grasps:
        best = record.grasps[0]
        squeezed = best.hold is not None and best.hold.squeeze is not None
        look = _LOOK.format(
            best=f"grasps/{best.id}",
            does="squeezes" if squeezed else "keeps its posture",
            keys=_KEYS if squeezed else "",
        )
    return _TEXT.format(
        task=one_line(record.task),
        verdict=verdict_word(record.verdict, record.kind) + (", narrowly" if record.narrow else ""),
        version=one_line(record.holdfast),
        hand=one_line(record.hand),
        object=one_line(record.object),
        count=f"{counted(len(record.grasps), 'grasp')}, the best first" if record.grasps else "no grasps",
        look=look,
        again=_AGAIN.format(command=one_line(command)) if command else "",
    )
