"""Runs a task of one's own from Python and looks at the best grasp.

python examples/own_task.py [RUN_FOLDER]
"""

import sys
from pathlib import Path

import holdfast as hf

task_file = Path(__file__).parent / "bar" / "pinch.yaml"
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "runs/pinch")

run = hf.run(task_file, folder, candidates=8, seed=0, quiet=False)
say = sys.stdout.write
say(f"{run}\n")
for grasp in run.good[:1]:
    say(f"best: {grasp.id}\n")
    for contact in grasp.contacts:
        say(f"  {contact.hand} touches {contact.object} at {[round(x, 4) for x in contact.point]} m\n")
