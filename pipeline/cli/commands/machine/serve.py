"""`holdfast serve DIR`."""

import argparse
import os
from pathlib import Path

from .....base.text.console import Console, emit
from .....errors import InputError
from ....serve import HttpServer, Jobs, run_mcp

__all__ = ["main"]

_TOKEN_VARIABLE = "HOLDFAST_TOKEN"


def main(arguments: argparse.Namespace) -> int:
    """Answers requests until it is interrupted, or the client leaves."""
    folder = Path(arguments.folder)
    folder.mkdir(parents=True, exist_ok=True)
    jobs = Jobs(folder, longest_s=arguments.longest, together=arguments.together)
    try:
        if arguments.mcp:
            run_mcp(jobs)
        else:
            _serve_http(jobs, arguments)
    finally:
        jobs.close()
    return 0


def _serve_http(jobs: Jobs, arguments: argparse.Namespace) -> None:
    console = Console(quiet=arguments.quiet)
    given = os.environ.get(_TOKEN_VARIABLE)
    try:
        server = HttpServer(jobs, arguments.port, token=given, say=console.say)
    except (OSError, OverflowError) as error:
        raise InputError("serve", "--port", f"can't listen at {arguments.port}: {error}") from None
    with server:
        emit(server.url)
        emit(f"token in {_TOKEN_VARIABLE}" if given else f"token {server.token}")
        console.say("Ctrl-C ends it")
        server.serve_forever()
