"""Grasps in words."""

from math import degrees

from ...base.text.significant import significant
from ...mjcf.hold import Outcome, load_word, passed_word, verdict_word
from ..records import EvidenceRecord, FingerFirst, GraspRecord, Hold, LessSpin

__all__ = ["describe", "describe_extras", "leaning", "near_miss", "proved"]


def describe(grasp: GraspRecord) -> str:
    """A line about a grasp, as far as it has come."""
    if grasp.clearance is None:
        return f"{grasp.id}: not tried" + (f": {grasp.hold.reason}" if grasp.hold else "")
    before, after = 1e3 * grasp.clearance.before, 1e3 * grasp.clearance.after
    status = "re-searched" if grasp.is_clear and grasp.restarts else grasp.clearance.status
    line = f"{grasp.id}: {status}, smallest distance {before:.2f} -> {after:.2f} mm"
    if grasp.clearance.reason:
        line += f" ({grasp.clearance.reason})"
    if grasp.clearance.took_balance:
        line += ", which took the balance of forces at 70 % of the friction"
    if grasp.approach is not None and not grasp.approach.reachable:
        line += f", unreachable: the fingers open by {1e3 * grasp.approach.opening:.1f} mm only"
        line += f" ({' and '.join(grasp.approach.blocking)})" if grasp.approach.blocking else ""
    if grasp.clearance.differing:
        line += f", MuJoCo differs on {len(grasp.clearance.differing)} distances"
    if grasp.hold is None:
        return line
    limit = "" if grasp.hold.limit is None else f"; by plan: {grasp.hold.limit.words}"
    if grasp.is_untested:
        return f"{line}; not tested: {grasp.hold.reason}{limit}"
    hold = grasp.hold
    line += f"; {verdict_word('held' if hold.held else 'not held', hold.kind)}"
    line += ", narrowly" if grasp.is_narrow or grasp.is_near_miss else ""
    if hold.kind == "lift":
        line += f", {hold.held_count} of {len(hold.directions)} directions"
    line += "" if hold.slip is None else f", slip {1e3 * hold.slip:.2f} mm"
    return "; ".join([line + limit, *leaning(hold)])


def leaning(hold: Hold) -> list[str]:
    """What a grasp held narrowly leans on: its squeeze, fingers that must not come first, spin friction."""
    if not hold.narrow:
        return []
    early = [
        f"leans on {one.finger}: where it comes first, the object {_moved(one, hold)}"
        for one in hold.leans_on
    ]
    return _squeezed(hold) + _loaded(hold) + early + _spinning(hold)


def _squeezed(hold: Hold) -> list[str]:
    """How far the squeeze moves the object, where that is much."""
    limit_m, share = hold.settings.get("firm_limit_m"), hold.settings.get("firm_share", 1.0)
    squeeze = hold.squeeze
    if squeeze is None or squeeze.slip is None or hold.kind != "lift":
        return []
    if not isinstance(limit_m, float) or not isinstance(share, float):
        return []
    if squeeze.slip < limit_m * (share if squeeze.rule else 1.0):
        return []
    return [f"leans on its squeeze, which moves the object {1e3 * squeeze.slip:.1f} mm"]


def near_miss(hold: Hold) -> list[str]:
    """What a grasp that failed narrowly came near to, as a sentence; nothing of any other."""
    times = hold.settings.get("near_limit")
    if hold.held or not hold.near_miss or not isinstance(times, (int, float)):
        return []
    outcomes = {direction.outcome for direction in hold.directions}
    if Outcome.LET_GO.value in outcomes:
        return [f"Narrowly: the object stays within {times:g} times the limits, whatever has let go of it."]
    if outcomes & {Outcome.SHORT.value, Outcome.WEAK.value}:
        return [f"Narrowly: it would pass if {100.0 / times:.0f} % of that were asked for."]
    return [f"Narrowly: it would pass with limits {times:g} times as wide."]


def _loaded(hold: Hold) -> list[str]:
    """How far the load moves the object, where that is much of a limit."""
    share, slip_limit = hold.settings.get("firm_share"), hold.settings.get("slip_limit_m")
    turn_limit = hold.settings.get("rotation_limit_rad")
    if hold.kind == "press":
        return ["leans on its servos: it presses little harder than asked"]
    if hold.kind != "lift" or not isinstance(share, float) or not isinstance(slip_limit, float):
        return []
    if hold.slip is not None and hold.slip >= share * slip_limit:
        return [f"leans on the limits: its load moves the object {1e3 * hold.slip:.1f} mm"]
    if hold.rotation is not None and isinstance(turn_limit, float) and hold.rotation >= share * turn_limit:
        return [f"leans on the limits: its load turns the object {degrees(hold.rotation):.1f} deg"]
    return []


def _spinning(hold: Hold) -> list[str]:
    spin = hold.less_spin
    if spin is None or spin.held:
        return []
    pressing = 0 if hold.squeeze is None else sum(force > 0.0 for force in hold.squeeze.normal_forces)
    whose = f" of {pressing} contacts" if pressing else ""
    share = f"{100.0 * spin.share:.0f} %"
    return [f"leans on the spin friction{whose}: with {share} of it the object {_moved(spin, hold)}"]


def _moved(entry: FingerFirst | LessSpin, hold: Hold) -> str:
    """How the object moves, by the measure that is beyond its limit."""
    if entry.slip is None or entry.rotation is None:
        return "is lost"
    limit = hold.settings.get("rotation_limit_rad")
    turns = isinstance(limit, float) and entry.rotation >= limit
    return f"turns {degrees(entry.rotation):.0f} deg" if turns else f"moves {1e3 * entry.slip:.1f} mm"


def proved(evidence: EvidenceRecord) -> str:
    """What was proved of a grasp beside its verdict, in words; empty where nothing was."""
    words = []
    if evidence.stable is not None:
        words.append(f"balanced with {significant(evidence.stable.slack, 2)} N to spare")
    if evidence.clear is not None:
        words.append("clear" + (" all the way" if evidence.clear.approach else ""))
    return f"proved {' and '.join(words)}" if words else ""


def describe_extras(grasp: GraspRecord) -> str:
    """A line about what is known of a grasp that passed beside the verdict."""
    hold = grasp.hold
    assert hold is not None
    if hold.margin is None:
        return f"{grasp.id}: its margin was not found"
    line = f"{grasp.id}: {passed_word(hold.kind)} up to {hold.margin:.2f} times {load_word(hold.kind)}"
    if hold.squeeze is not None and hold.squeeze.least is not None:
        line += f", and with {100 * hold.squeeze.least:.0f} % of the squeeze"
    other = [name for name, held in hold.agreement.items() if held != hold.held]
    line += f", not with {', '.join(other)}" if other else ", other settings agree"
    words = "" if grasp.evidence is None else proved(grasp.evidence)
    return f"{line}; {words}" if words else line
