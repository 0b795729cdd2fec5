"""Runs a task of one's own from Python and looks at the best grasp.

python examples/own_task.py [RUN_FOLDER]
"""

import sys
from pathlib import Path

from holdfast.pipeline.output import Console
from holdfast.pipeline.run import RunSettings, run_task

task_file = Path(__file__).parent / "bar" / "pinch.yaml"
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "runs/pinch")

run = run_task(str(task_file), folder, RunSettings(candidates=8, seed=0), console=Console())
say = sys.stdout.write
say(f"{run.verdict}: {len(run.good)} of {len(run.grasps)} grasps are certified, clear and held\n")
for grasp in run.good[:1]:
    say(f"best: {grasp.id}, see {folder / 'report.html'}\n")
    for contact in grasp.contacts:
        say(f"  {contact.hand} touches {contact.object} at {[round(x, 4) for x in contact.point]} m\n")
