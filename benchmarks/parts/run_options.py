"""Options of benchmarks that make runs of tasks."""

import argparse

from parts.nine_tasks import TASKS

__all__ = ["runs_parser"]


def runs_parser(doc: str | None) -> argparse.ArgumentParser:
    """A parser for tasks, candidates and seed, to which a benchmark adds its own options.

    Args:
        doc: of the benchmark, as help shows it.
    """
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "tasks", nargs="*", metavar="TASK", default=list(TASKS), help="tasks or family members (the nine)"
    )
    parser.add_argument("--candidates", type=int, default=16, help="of each run (16)")
    parser.add_argument("--seed", type=int, default=0, help="of each run (0)")
    return parser
