"""Judges scenes of `parts/neutral_scene.py` in Drake. For `second_engine.py`; runs where Drake is installed.

Reads one JSON request a line from standard input and writes one JSON answer a line: `{"what": "judge",
"scene", "targets": "straight" or "recorded", "modulus", "step", "whole"}`, the modulus null for that of the
hand's pads, or `{"what": "coulomb", "modulus", "step"}`.
"""

import json
import sys
import time

import numpy as np
from drake_coulomb import critical_shares
from drake_scene import build
from drake_trial import Trial, lift, stand_trial
from drake_yield import straight_targets


def judge(request: dict) -> dict:
    scene, step_s = request["scene"], request["step"]
    modulus_Pa = request["modulus"] or scene["modulus"]
    started = time.process_time()
    targets, path, found = np.asarray(scene["targets"]), np.asarray(scene["path"]), {}
    if scene["kind"] == "turn" and not scene["path"]:
        return {"error": "its file has no path of the turn"}
    if request["targets"] == "straight":
        targets, more, found["yields"] = straight_targets(scene, modulus_Pa)
        path = path + more if len(path) else path
    trial = Trial(build(scene, modulus_Pa=modulus_Pa, step_s=step_s), scene, step_s, whole=request["whole"])
    found |= lift(trial, targets) if scene["kind"] == "lift" else stand_trial(trial, targets, path)
    return {**found, "cpu": time.process_time() - started}


def answer(request: dict) -> dict:
    if request["what"] == "coulomb":
        return critical_shares(request["modulus"], request["step"])
    try:
        return judge(request)
    except RuntimeError as error:  # Drake's own: a body it can't mesh, a step that doesn't converge
        return {"error": str(error).splitlines()[0]}


def main() -> None:
    for line in sys.stdin:
        print(json.dumps(answer(json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
