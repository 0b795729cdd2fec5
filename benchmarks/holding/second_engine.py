"""Whether another physics engine (Drake, with soft pads) says the same of the grasps in run folders.

Usage: ./run bench second_engine RUN ... [--targets straight | recorded] [--modulus PA] [--step S] [--most N]
                        [--draw N] [--seed N] [--whole] [--workers N] [--json FILE] [--python PYTHON]
       second_engine.py --coulomb [--modulus PA] [--step S] [--python PYTHON]

Each grasp that came to a test is rebuilt from its run folder alone, without MuJoCo or its models, and lifted,
turned or pressed with the same shapes, masses, friction, servos, timing and limits. The hand's pads yield as
hydroelastic bodies of their stated modulus, or of the one given; the object is rigid. Friction resists spin
by the patch that the bodies make, so arms of spin friction that a file states are not used. `recorded` (the
default) takes the servos' targets as they stand in the file, whose plan leads each tip straight along its
normal by as much as the hand's pad yields; `straight` finds them anew by how much the engine's pads yield.
A direction ends early there once three times its present pace would not lead to a limit in the time that is
left; with --whole it lasts for all of it.

Printed are how many of those called held, narrow (held narrowly), near miss (failed narrowly) and failed it
confirms, how well measures in the files predict its verdict (AUC within tasks), and the reasons. With --json
findings are kept, and the same call goes on where an earlier one stopped.

--coulomb checks the engine itself: at which share of the critical load pinched bodies begin to slip.
"""

import argparse
import json
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import zip_longest
from pathlib import Path
from queue import SimpleQueue
from random import Random
from threading import Lock
from typing import Any

import numpy as np
from holdfast.base.text.console import format_table
from holdfast.hands import Pad
from holdfast.mjcf import auc
from parts.neutral_scene import Scene, scenes_of
from parts.places import PEERS, PEERS_PYTHON

Finding = dict[str, Any]
CLASSES = ("held", "narrow", "near miss", "failed")
# What of a scene stands in its finding, too.
KEPT = ("task", "kind", "ours", "narrow", "near_miss", "rule", "measures")


class Engine:
    """A process with Drake in it that answers requests one by one; where it breaks, a new one follows."""

    def __init__(self, python: Path):
        self.python = python
        self.process = self._started()

    def _started(self) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [str(self.python), str(PEERS / "peer_drake.py")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )

    def ask(self, request: dict[str, Any]) -> Finding:
        """The answer, or an `error`."""
        assert self.process.stdin is not None and self.process.stdout is not None
        try:
            self.process.stdin.write(json.dumps(request) + "\n")
            self.process.stdin.flush()
            line = self.process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            code = self.process.wait()
            self.process = self._started()
            return {"error": f"Drake's process ended with {code}"}
        return json.loads(line)

    def close(self) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.wait()


def in_turns(runs: list[Path], most: int | None, draw: int | None, seed: int) -> Iterator[Scene]:
    """Scenes of all runs, one of each in turn, so that a part has something of everything.

    Args:
        runs: run folders.
        most: scenes of each, the best first; None for all.
        draw: so many of them, drawn at random; None for all, the best first.
        seed: of the draw, which depends on a run's name besides and on no other run.
    """
    for row in zip_longest(*(drawn(scenes_of(run)[:most], draw, f"{seed} {run.name}") for run in runs)):
        yield from (scene for scene in row if scene is not None)


def drawn(scenes: list[Scene], count: int | None, seed: str) -> list[Scene]:
    """So many of the scenes, drawn at random; more of them with the same seed begin with these."""
    if count is None:
        return scenes
    order = list(scenes)
    Random(seed).shuffle(order)
    return order[:count]


def judged(scenes: list[Scene], arguments: argparse.Namespace) -> dict[str, Finding]:
    """What the engine says of each scene, by name; kept in a file as they come."""
    assumed = {key: getattr(arguments, key) for key in ("targets", "modulus", "step", "whole")}
    kept: dict[str, Any] = {"assumed": assumed, "findings": {}}
    if arguments.json and arguments.json.exists():
        kept = json.loads(arguments.json.read_text("utf-8"))
        if kept["assumed"] != assumed:
            raise SystemExit(f"bench second_engine: {arguments.json} was made with {kept['assumed']}")
    found: dict[str, Finding] = kept["findings"]
    engines: SimpleQueue[Engine] = SimpleQueue()
    writing = Lock()
    for _ in range(arguments.workers):
        engines.put(Engine(arguments.python))

    def one(scene: Scene) -> None:
        engine = engines.get()
        answer = engine.ask({"what": "judge", "scene": scene, **assumed})
        engines.put(engine)
        about = {key: scene[key] for key in KEPT}
        with writing:
            found[scene["name"]] = {**about, "our_verdict": scene["held"], **answer}
            if arguments.json:
                arguments.json.write_text(json.dumps(kept, indent=1), "utf-8")
        print(f"{len(found)}: {scene['name']}: {answer.get('reason', answer.get('error'))}", file=sys.stderr)

    with ThreadPoolExecutor(arguments.workers) as pool:
        list(pool.map(one, [scene for scene in scenes if scene["name"] not in found]))
    for _ in range(arguments.workers):
        engines.get().close()
    return {scene["name"]: found[scene["name"]] for scene in scenes}


def class_of(finding: Finding) -> str:
    """What the grasp is called here."""
    if not finding["our_verdict"]:
        return "near miss" if finding["near_miss"] else "failed"
    return "narrow" if finding["narrow"] else "held"


def confirmed(findings: list[Finding], called: str) -> str:
    """How many grasps of a class the engine confirms: narrow ones where they hold, near misses where not."""
    own = [f for f in findings if class_of(f) == called]
    agreed = sum(f["held"] == (called in ("held", "narrow")) for f in own)
    return f"{agreed} of {len(own)}" if own else "-"


def print_measures(findings: list[Finding]) -> None:
    """How well each measure predicts the engine's verdict on what holds here, within tasks."""
    rows = []
    for chosen, title in ((lambda f: f["our_verdict"], "held here"), (lambda f: True, "all")):
        for measure in findings[0]["measures"] if findings else ():
            found = auc_within([f for f in findings if chosen(f)], measure)
            if found is not None:
                rows.append((title, measure, f"{found[0]:.2f}", str(found[1])))
    if rows:
        print("\nAUC of measures for the verdict there, within tasks, weighted by pairs:")
        print(format_table(("grasps", "measure", "AUC", "pairs"), rows))


def auc_within(findings: list[Finding], measure: str) -> tuple[float, int] | None:
    """AUC of a measure within tasks, and the pairs of a grasp that holds there and one that does not."""
    total, pairs = 0.0, 0
    for task in dict.fromkeys(f["task"] for f in findings):
        own = [f for f in findings if f["task"] == task and f["measures"][measure] is not None]
        held = np.array([f["held"] for f in own], dtype=bool)
        value = auc(np.array([f["measures"][measure] for f in own]), held)
        if value is not None:
            weight = int(held.sum() * (~held).sum())
            total, pairs = total + weight * value, pairs + weight
    return (total / pairs, pairs) if pairs else None


def print_findings(findings: dict[str, Finding]) -> None:
    """Confusion table, agreement by task, and why verdicts differ."""
    whole = {name: f for name, f in findings.items() if "error" not in f}
    for name, finding in findings.items():
        if "error" in finding:
            print(f"not judged: {name}: {finding['error']}")
    rows = []
    for task in [*dict.fromkeys(f["task"] for f in whole.values()), "all"]:
        own = [f for f in whole.values() if task in (f["task"], "all")]
        cells = [confirmed(own, called) for called in CLASSES]
        rows.append((task, own[0]["kind"] if own and task != "all" else "", *cells))
    print("grasps confirmed, of so many that are called:")
    print(format_table(("task", "test", *CLASSES), rows))
    good = [f for f in whole.values() if f["held"]]
    if good:
        narrow = sum(class_of(f) == "narrow" for f in good)
        print(f"of the {len(good)} that hold there {narrow} are called narrow here")
    print_measures(list(whole.values()))
    print("\nwhere verdicts differ:")
    for name, f in whole.items():
        if f["our_verdict"] != f["held"]:
            moved = (
                f"squeeze moved it {1e3 * f['squeeze_slip']:.1f} mm, {np.degrees(f['squeeze_turn']):.1f} deg"
            )
            here = "held, narrowly" if f["narrow"] else f["ours"]
            print(f"  {name}: here {here}; there {f['reason']} ({moved})")
    reasons = Counter(f["reason"].split(" under")[0] for f in whole.values() if not f["held"])
    print("\nreasons there: " + ", ".join(f"{count} {reason}" for reason, count in reasons.most_common()))
    seconds = [f["cpu"] for f in whole.values()]
    if seconds:
        print(f"CPU s a grasp: median {np.median(seconds):.1f}, largest {max(seconds):.1f}")


def print_coulomb(arguments: argparse.Namespace) -> None:
    engine = Engine(arguments.python)
    shares = engine.ask(
        {"what": "coulomb", "modulus": arguments.modulus or Pad().modulus_Pa, "step": arguments.step}
    )
    engine.close()
    if "error" in shares:
        raise SystemExit(f"bench second_engine: {shares['error']}")
    rows = [(name, f"{low:.3f}", f"{high:.3f}") for name, (low, high) in shares.items()]
    print(format_table(("pinch", "holds at", "slips at"), rows))
    print("shares of the critical load by Coulomb's law")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("runs", nargs="*", type=Path, metavar="RUN", help="run folders")
    parser.add_argument("--targets", choices=("straight", "recorded"), default="recorded")
    parser.add_argument("--modulus", type=float, help="of the pads, in Pa, if not the hand's")
    parser.add_argument("--step", type=float, default=0.004, help="of the simulation, in s")
    parser.add_argument(
        "--whole", action="store_true", help="gravity acts for its whole time, however still the object is"
    )
    parser.add_argument("--most", type=int, help="grasps a run, the best first")
    parser.add_argument("--draw", type=int, help="grasps a run, drawn at random among these")
    parser.add_argument("--seed", type=int, default=0, help="of the draw")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    parser.add_argument("--json", type=Path, help="findings, to go on with")
    parser.add_argument("--python", type=Path, default=PEERS_PYTHON, help="an interpreter that has Drake")
    parser.add_argument("--coulomb", action="store_true", help="check the engine by Coulomb's law")
    arguments = parser.parse_args()
    if not arguments.python.exists():
        raise SystemExit(
            f"bench second_engine: no Drake: {arguments.python} is missing; name one by --python"
        )
    if arguments.coulomb:
        print_coulomb(arguments)
    elif not arguments.runs:
        parser.error("name run folders, or --coulomb")
    else:
        scenes = in_turns(arguments.runs, arguments.most, arguments.draw, arguments.seed)
        print_findings(judged(list(scenes), arguments))


if __name__ == "__main__":
    main()
