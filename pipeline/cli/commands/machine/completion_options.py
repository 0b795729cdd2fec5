"""Options of `holdfast completion`."""

import argparse

__all__ = ["EXAMPLES", "SHELLS", "add_options"]

EXAMPLES = (
    (
        "holdfast completion bash > ~/.local/share/bash-completion/completions/holdfast",
        "bash, from the next on",
    ),
    ("holdfast completion zsh > ~/.zfunc/_holdfast", "zsh, where ~/.zfunc is in fpath"),
    ("holdfast completion fish > ~/.config/fish/completions/holdfast.fish", "fish"),
)

SHELLS = ("bash", "zsh", "fish")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "shell",
        metavar="SHELL",
        choices=(*SHELLS, "words"),
        help="bash, zsh or fish; its script goes to stdout",
    )
    # What the scripts ask: `words`, and the words of a command line up to the one to complete.
    words = parser.add_argument("words", nargs=argparse.REMAINDER, help=argparse.SUPPRESS)
    words.required = False  # so no message asks for them
