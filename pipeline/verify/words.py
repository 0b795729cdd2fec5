"""How files were read, in words."""

from ...base.text.plain_text import counted
from ..formats import QuestionName
from .reading import BASE, HAND_ORDER, NO_SCALE, TCP, option
from .verify import ReadPool

__all__ = ["reading_lines"]

# Objects that move by less are where the file has them.
_SAID_M = 1e-4


def reading_lines(read: ReadPool) -> list[str]:
    """What is to be said of a reading: what was found, what goes against the file's word, what is missing."""
    reading, file = read.reading, read.pool.file
    files = dict.fromkeys(origin.path for origin, _ in read.pool.origin)
    which = str(file.path) if len(files) == 1 else f"{file.path} and {len(files) - 1} more"
    answers = ", ".join(_say(name, answer) for name, answer in reading.answers.items())
    lines = [
        f"{which}: {counted(len(file.grasps), 'grasp')}, {file.format} ({file.variant}); read with {answers}"
    ]
    for name, answer in reading.found.items():
        if name in reading.against:
            lines.append(f"  against its own word: only with {_say(name, answer)} are hands at the object")
        else:
            lines.append(f"  found by geometry: {_say(name, answer)}")
    for name, several in reading.left_open.items():
        words = " or ".join(_say(name, answer) for answer in several)
        lines.append(f"  left open (--{option(name)}): {words}; the same touches at the same places")
    if not reading.fits:
        share = f"{100 * reading.share:.0f} %"
        lines.append(
            f"  no reading puts hands at the object: two fingers are near it in {share} of the grasps"
        )
    if read.interpreter.unknown:
        lines.append(f"  joints that the hand lacks: {', '.join(read.interpreter.unknown[:8])}")
    if read.interpreter.left_out:
        lines.append(
            f"  the first {read.interpreter.left_out} joint values were taken for a wrist's, left out"
        )
    if read.interpreter.filled:
        lines.append(f"  joints that the file lacks: {', '.join(read.interpreter.filled[:8])}")
    if read.interpreter.is_open:
        lines.append("  the gripper stands alike in every grasp: its jaws were closed until they touch")
    elif not read.interpreter.has_joints:
        lines.append("  poses alone: the jaws were closed until they touch")
    if read.reading.moved_m > _SAID_M:
        lines.append(
            f"  objects were moved by up to {1e3 * read.reading.moved_m:.2g} mm to where both jaws touch"
        )
    if read.squeezes is not None:
        lines.append("  it has squeezes of its own: grasps as given are tried with these")
    return [*lines, *(f"  {remark}" for remark in file.remarks)]


def _say(name: QuestionName, answer: str) -> str:
    match name:
        case "quaternion":
            return f"quaternions {answer}"
        case "length":
            return f"positions in {answer}"
        case "angle":
            return f"angles in {answer}"
        case "joint_length":
            return f"slides in {answer}"
        case "scale":
            return {
                NO_SCALE: "the object as it is, whatever its scale",
                "times": "the object times its scale",
                "divided": "the object divided by its scale",
            }[answer]
        case "frame":
            words = {BASE: "the palm's frame", TCP: "a frame between the fingertips (tcp)"}
            return f"poses of {words.get(answer, f'the frame {answer}')}"
        case "direction":
            return "poses of the hand" if answer == "hand_in_object" else "poses of the object in the hand"
        case "joint_order":
            return "joints in the hand's order" if answer == HAND_ORDER else f"joints in the order {answer}"
        case _:
            return f"{name} {answer}"
