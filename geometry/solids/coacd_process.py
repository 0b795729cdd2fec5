"""CoACD in a process of its own: it crashes or hangs on some meshes, which then costs only that process.

Run as a file, `python coacd_process.py`, it reads one mesh from standard input and writes the pieces to
standard output, both as numpy archives without pickles. It imports nothing of
the package and so starts quickly.
"""

import io
import os
import subprocess
import sys
import threading
import time
import zipfile
from typing import Any, Literal

import numpy as np
import trimesh
from numpy.typing import NDArray

__all__ = ["PATIENCE", "run_coacd"]

_QUICK = {"mcts_iterations": 20, "mcts_nodes": 8, "mcts_max_depth": 2, "resolution": 1000}

# How often the process looks whether it is still wanted.
_GLANCE_S = 0.2
# On a busy machine time counts only as far as the process gets a processor.
_BUSY_SHARE = 0.8
PATIENCE = 4.0
"""How many times its limit a cut may take on a busy machine, unless told otherwise."""


def run_coacd(
    mesh: trimesh.Trimesh,
    *,
    preprocess: Literal["off", "on"],
    threshold: float,
    seed: int,
    limit_s: float,
    longest_s: float | None = None,
    is_quick: bool = False,
) -> list[NDArray[np.float64]] | None:
    """Corners (n, 3) of the convex pieces of a mesh, None where CoACD crashes, finds none or takes too long.

    Args:
        mesh: closed surface, outward normals.
        preprocess: "on" makes a surface without faults first, which lies up to 0.5 % of the size outside.
        threshold: concavity that is left, in CoACD's own unit: a share of the mesh's size.
        seed: of its sampling; the same seed gives the same pieces.
        limit_s: time after which the process is ended, in s; longer on a busy machine, where the process gets
            less than a processor of its own. So the same mesh is cut there too.
        longest_s: time by the clock after which it is ended there too; four times the limit unless given.
        is_quick: whether to look for cuts with a tenth of the effort.
    """
    question = io.BytesIO()
    np.savez(
        question,
        vertices=np.asarray(mesh.vertices, dtype=np.float64),
        faces=np.asarray(mesh.faces, dtype=np.int64),
        preprocess=np.array(preprocess),
        threshold=np.array(threshold),
        seed=np.array(seed),
        is_quick=np.array(is_quick),
        limit_s=np.array(limit_s),
    )
    try:
        done = subprocess.run(
            [sys.executable, "-P", __file__],
            input=question.getvalue(),
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=PATIENCE * limit_s if longest_s is None else longest_s,
            check=True,
        )
        with np.load(io.BytesIO(done.stdout), allow_pickle=False) as data:
            clouds = [np.asarray(data[f"v{i}"], dtype=float) for i in range(int(data["count"]))]
    except (subprocess.SubprocessError, zipfile.BadZipFile, ValueError, KeyError, EOFError):
        return None
    sound = all(c.ndim == 2 and c.shape[1] == 3 and np.isfinite(c).all() for c in clouds)
    return clouds if clouds and sound else None


def _answer() -> None:
    """Reads a mesh from standard input and writes its pieces to standard output."""
    threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()
    import coacd  # takes 0.2 s, which only this process needs

    # CoACD prints to standard output, which is for the answer alone.
    stdout = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    with np.load(io.BytesIO(sys.stdin.buffer.read()), allow_pickle=False) as data:
        threading.Thread(target=_end_after, args=(float(data["limit_s"]),), daemon=True).start()
        coacd.set_log_level("error")
        effort = _QUICK if bool(data["is_quick"]) else {}
        parts = coacd.run_coacd(
            coacd.Mesh(data["vertices"], data["faces"]),
            threshold=float(data["threshold"]),
            preprocess_mode=str(data["preprocess"]),
            seed=int(data["seed"]),
            **effort,
        )
    arrays: dict[str, Any] = {
        f"v{i}": np.asarray(vertices, dtype=np.float64) for i, (vertices, _) in enumerate(parts)
    }
    arrays["count"] = np.array(len(parts))
    np.savez(stdout, **arrays)
    stdout.close()


def _end_with(parent: int) -> None:
    """Ends this process once the one that started it is gone: nobody waits for the answer."""
    while os.getppid() == parent:
        time.sleep(_GLANCE_S)
    os._exit(1)


def _end_after(limit_s: float) -> None:
    """Ends this process once the time is over and it has had a processor for most of it."""
    started = time.monotonic()
    while time.monotonic() - started < limit_s or time.process_time() < _BUSY_SHARE * limit_s:
        time.sleep(_GLANCE_S)
    os._exit(1)


if __name__ == "__main__":
    _answer()
