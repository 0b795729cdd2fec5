"""One two-contact task with many hands: how many of its grasps are certified, clear and held.

    ./run bench hands [--candidates N] [HAND ...]

A hand is a built-in name or the path of a hand file; without any, all built-in hands are taken. The task is
examples/hands/pinch.yaml: a can of 100 g between index finger and thumb.
"""

import argparse
import tempfile
import time
from pathlib import Path

from holdfast.hands import builtin_hands, load_hand
from holdfast.pipeline.records import RunRecord
from holdfast.pipeline.run import RunSettings, run_task
from parts.places import ROOT

TASK = ROOT / "examples" / "hands" / "pinch.yaml"


def run(hand: str, candidates: int) -> RunRecord:
    """One round of the solver, every grasp of it tried."""
    settings = RunSettings(candidates=candidates, wanted=0, budget_s=500.0)
    with tempfile.TemporaryDirectory() as folder:
        return run_task(f"{TASK}@{hand}", Path(folder) / "run", settings)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("hands", nargs="*", metavar="HAND")
    parser.add_argument("--candidates", type=int, default=16)
    arguments = parser.parse_args()
    print("| hand | degrees of freedom | found | certified | clear | held | CPU s |")
    print("|---|---|---|---|---|---|---|")
    for name in arguments.hands or builtin_hands():
        started = time.process_time()
        record = run(name, arguments.candidates)
        hand = load_hand(name)
        counts = (
            len(hand.independent),
            len(record.grasps),
            sum(grasp.certified for grasp in record.grasps),
            sum(
                grasp.clearance is not None and grasp.clearance.status != "failed" for grasp in record.grasps
            ),
            len(record.good),
        )
        seconds = time.process_time() - started
        print(f"| {hand.name} | {' | '.join(map(str, counts))} | {seconds:.0f} |", flush=True)


if __name__ == "__main__":
    main()
