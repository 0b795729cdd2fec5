"""Damaged and hostile inputs of every kind through the real commands: how many break the law of bad input.

    ./run bench fuzz [--count N] [--seed N] [KIND ...]

The law: an exit code that is documented, for bad input one line that says what is wrong, no traceback, no
hang, less than 2 GB, and nothing written that was not asked for. Each input is tried in a process of its own:
a fork of this one, which saves the imports, and every twentieth in one that is started as a user starts it.
Each kind's good input is tried first, and has to be accepted.
"""

import argparse
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from holdfast.tests.fuzz.kinds import KINDS
from holdfast.tests.fuzz.law import try_good, try_one, warm_up

# One in this many is tried in a process that is started for it.
ANEW = 20


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--count", type=int, default=120, help="inputs of each kind (120)")
    parser.add_argument("--seed", type=int, default=1000)
    arguments = parser.parse_args()
    warm_up()
    total, broken = 0, Counter[str]()
    print("| kind | inputs | violations | seconds |\n|---|---|---|---|")
    for name in arguments.kinds or KINDS:
        kind, started = KINDS[name](), time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            if wrong := try_good(kind, Path(folder)):
                broken[name] += 1
                print(f"{name}: {wrong}", file=sys.stderr, flush=True)
        for seed in range(arguments.seed, arguments.seed + arguments.count):
            # Started anew, the editor would serve what it accepts until it is killed.
            anew = seed % ANEW == 0 and kind.words[0] != "edit"
            with tempfile.TemporaryDirectory() as folder:
                wrong = try_one(kind, Path(folder), seed, anew=anew)
            if wrong:
                broken[name] += 1
                print(f"{name}, seed {seed}: {wrong}", file=sys.stderr, flush=True)
        total += arguments.count
        print(
            f"| {name} | {arguments.count} | {broken[name]} | {time.perf_counter() - started:.0f} |",
            flush=True,
        )
    print(f"{total} inputs of {len(arguments.kinds or KINDS)} kinds, {broken.total()} violations")
    return 1 if broken else 0


if __name__ == "__main__":
    raise SystemExit(main())
