"""Where things lie: the repository, the folder around it, and what may stand beside it."""

import os
import sys
from pathlib import Path

__all__ = ["ABOVE", "BENCHMARKS", "PEERS", "PEERS_PYTHON", "ROOT", "RUN", "SHARED"]

BENCHMARKS = Path(__file__).resolve().parents[1]
RUN = BENCHMARKS / "run.py"
"""Runs a benchmark by its name, in a process of its own for instance."""
PEERS = BENCHMARKS / "peers"
"""What runs in an environment of other programs."""
PEERS_PYTHON = Path(sys.prefix) / "peers" / "bin" / "python"
"""The Python of that environment, which `./run bench` makes."""
ROOT = BENCHMARKS.parent
"""The repository, which is the package."""
ABOVE = ROOT.parent
"""The folder from which the package is imported."""
SHARED = Path(os.environ.get("HOLDFAST_SHARED") or ABOVE / "shared")
"""Published systems and hands, where somebody has put them."""
