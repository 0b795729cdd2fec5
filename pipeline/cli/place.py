"""Where a command has its work done: on this machine, or on a cluster."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager

from ...errors import InputError
from ...workers import using_cluster

__all__ = ["in_place"]


@contextmanager
def in_place(arguments: argparse.Namespace) -> Iterator[None]:
    """Within it the cluster does the work that `--cluster` names, if it is given.

    Raises:
        InputError: there is no such cluster; or `--workers` is given, too, of which a cluster has its own.
        MissingBackend: the extra `cluster` is not installed.
    """
    address = getattr(arguments, "cluster", None)
    if address is not None and arguments.workers is not None:
        raise InputError(arguments.command, "--workers", "goes without --cluster, which has its own")
    with using_cluster(address) as cluster:
        if cluster is not None:
            # Two at least, for with one all is done in this process.
            arguments.workers = max(2, cluster.threads)
        yield
