"""Why a grasp, or a run, did not come to what was wanted, and what to try: in words."""

from math import degrees

from ...mjcf import TestKind, gravity_names
from ...mjcf.hold import passed_word
from ..records import Direction, GraspRecord, RunRecord
from .text import near_miss

__all__ = ["fault", "is_untried", "run_advice", "stage_word", "tally"]

# Share of the trials with noise below which a grasp is not to be relied on.
_OFTEN = 0.5


def stage_word(grasp: GraspRecord, kind: TestKind) -> str:
    """How far a grasp has come, in a word or two: what its badge says and the table filters by."""
    hold = grasp.hold
    if grasp.is_good:
        return passed_word(kind) + (", narrowly" if grasp.is_narrow else "")
    if grasp.is_held:
        return f"{passed_word(kind)}, not certified"
    if hold is not None and hold.directions:
        return ("gave way" if kind == "lift" else "failed") + (", narrowly" if grasp.is_near_miss else "")
    if grasp.is_untested:
        return "not tested"
    return "penetrates" if grasp.clearance is not None and not grasp.is_clear else "not tried"


def tally(record: RunRecord, passed: str) -> str:
    """How many grasps are what the run looked for, and what is to be said against them; may be empty."""
    good = record.good
    if not good:
        return ""
    line = f"{len(good)} of {len(record.grasps)} grasps are all three"
    narrow, different = sum(grasp.is_narrow for grasp in good), len(record.different)
    unreachable = sum(grasp.is_unreachable for grasp in good)
    doubtful = sum(
        grasp.hold is not None and grasp.hold.probability is not None and grasp.hold.probability < _OFTEN
        for grasp in good
    )
    but = [
        *([f"{narrow} of them {passed} narrowly"] if narrow else []),
        *([f"{different} of them different"] if different < len(good) else []),
        *([f"{unreachable} without a way for the fingers to get there"] if unreachable else []),
        *([f"{doubtful} {passed} in less than half of the trials with noise"] if doubtful else []),
    ]
    return f"{line}{'; ' if but else ''}{', '.join(but)}."


def fault(grasp: GraspRecord, *, enough: bool = False) -> tuple[str, str]:
    """What went wrong with a grasp, and what to try; both empty where nothing did.

    Args:
        grasp: the grasp.
        enough: whether its run has ended as enough others hold.
    """
    clearance, hold = grasp.clearance, grasp.hold
    if is_untried(grasp) and enough:
        return "Not tried: enough others hold.", "Go on with --resume, and --wanted in place of --enough."
    if is_untried(grasp):
        return (
            "Not tried: retraction and test have not come to it.",
            "Go on with --resume and a larger --budget.",
        )
    if clearance is not None and not grasp.is_clear:
        return _blocked(grasp)
    if hold is not None and grasp.is_untested:
        limit = "" if hold.limit is None else f" By plan: {hold.limit.words}."
        said = f"Not tested: {hold.reason}. That is no proof that the hand could not do it.{limit}"
        return said, _for_strength(grasp)
    if hold is not None and not hold.held:
        return " ".join([_gave_way(grasp), *near_miss(hold)]), _for_strength(grasp)
    if grasp.is_unreachable and grasp.approach is not None:
        blocking = grasp.approach.blocking
        by = f", stopped by {' and '.join(blocking)}" if blocking else ""
        return (
            f"Unreachable: the fingers open by {1e3 * grasp.approach.opening:.2f} mm only{by}.",
            "The hand would have to come with the object between its fingers already; or look at "
            "other grasps of this run that are reachable.",
        )
    return "", ""


def _blocked(grasp: GraspRecord) -> tuple[str, str]:
    clearance = grasp.clearance
    assert clearance is not None
    depth_mm = max(0.0, -1e3 * clearance.after)
    pair = " and ".join(clearance.worst_pair) if clearance.worst_pair else "bodies"
    reason = f": {clearance.reason}" if clearance.reason else ""
    said = f"Retraction stopped with {pair} {depth_mm:.2f} mm inside each other{reason}."
    moved = "regions that are farther apart or leave more room around these bodies"
    return said, f"Try more candidates, {moved}, or joint limits that keep them apart."


def _gave_way(grasp: GraspRecord) -> str:
    hold = grasp.hold
    assert hold is not None
    names = gravity_names([entry.gravity for entry in hold.directions])
    failed = [(name, entry) for name, entry in zip(names, hold.directions, strict=True) if not entry.held]
    if not failed:
        squeeze = hold.squeeze
        moved = "" if squeeze is None or squeeze.slip is None else f" by {1e3 * squeeze.slip:.2f} mm"
        return f"The squeeze itself moved the object{moved}, so it is no longer the grasp that was tested."
    worst = "; ".join(_in_words(name, entry) for name, entry in failed[:3])
    more = f"; and {len(failed) - 3} more" if len(failed) > 3 else ""
    limit = "" if hold.limit is None else f" By plan: {hold.limit.words}."
    return f"{len(failed)} of {len(names)} failed: {worst}{more}.{limit}"


def _in_words(name: str, entry: Direction) -> str:
    where = f"gravity {name}: " if name else ""
    figures = []
    if entry.slip is not None:
        figures.append(f"slip {1e3 * entry.slip:.1f} mm")
    if entry.rotation is not None:
        figures.append(f"turn {degrees(entry.rotation):.0f}°")
    return f"{where}{entry.outcome or 'not held'}" + (f" ({', '.join(figures)})" if figures else "")


def _for_strength(grasp: GraspRecord) -> str:
    """What would make a weak grasp strong, as far as the plan says."""
    limit = None if grasp.hold is None else grasp.hold.limit
    ways = []
    if limit is not None and limit.friction is not None:
        ways.append(f"friction of {limit.friction:.2f}")
    if limit is not None and limit.efforts is not None:
        ways.append(f"servos {limit.efforts:.2g} times as strong")
    would = f"By plan it would take {' or '.join(ways)}. " if ways else ""
    return f"{would}Try more candidates, or a contact more, or regions farther from each other."


def is_untried(grasp: GraspRecord) -> bool:
    """Whether it is a configuration alone, to which neither retraction nor test has come."""
    return grasp.clearance is None and grasp.hold is None


def run_advice(record: RunRecord) -> list[str]:
    """What to try where a run has no grasp to show for itself, or was stopped."""
    if record.verdict == "undecided" and not record.grasps:
        return ["Give it more time: add --budget SECONDS, and --resume to go on from here."]
    if record.verdict == "infeasible":
        return []
    untried = sum(is_untried(grasp) for grasp in record.grasps)
    advice = []
    if record.has_enough and untried:
        advice.append(
            f"{untried} of {len(record.grasps)} configurations were not tested, as {record.enough} should be "
            f"enough: --resume --wanted {record.enough} tests them, too."
        )
    elif untried:
        advice.append(
            f"{untried} of {len(record.grasps)} configurations were not tried: --resume with a larger "
            "--budget goes on with them."
        )
    if record.good:
        return advice
    stages = {
        "blocked": sum(grasp.clearance is not None and not grasp.is_clear for grasp in record.grasps),
        "weak": sum(grasp.is_untested for grasp in record.grasps),
        "slipped": sum(g.hold is not None and not g.hold.held and not g.is_untested for g in record.grasps),
    }
    if stages["blocked"]:
        advice.append(
            f"{stages['blocked']} could not be freed of penetration: more --candidates, or regions with more "
            "room around them."
        )
    if stages["weak"]:
        advice.append(
            f"For {stages['weak']} no squeeze carries the load by plan: see what limits them in their cards."
        )
    if stages["slipped"]:
        advice.append(
            f"{stages['slipped']} gave way in the test: their cards say in which direction, and how."
        )
    return advice
