"""Where the command line asks for results to be written, looked at before the work that leads to them."""

from argparse import ArgumentTypeError
from collections.abc import Callable
from pathlib import Path

from ...base.files.output_file import check_folder_target, check_target
from ...errors import InputError

__all__ = ["file_or_folder_target", "file_target", "file_target_or_stdout", "folder_target"]


def file_target(text: str) -> str:
    """The path of a file that can be written."""
    return _checked(text, check_target, "a file")


def file_target_or_stdout(text: str) -> str:
    """The same, or `-`."""
    return text if text == "-" else file_target(text)


def folder_target(text: str) -> str:
    """The path of a folder in which files can be written, or which can be made."""
    return _checked(text, check_folder_target, "a folder")


def file_or_folder_target(text: str) -> str:
    """Either: a folder where one is there or the path ends as one, else a file."""
    is_folder = text.endswith("/") or Path(text).is_dir()
    return folder_target(text) if is_folder else file_target(text)


def _checked(text: str, check: Callable[[Path], None], what: str) -> str:
    if not text:
        raise ArgumentTypeError(f"must be the path of {what}, not an empty one")
    try:
        check(Path(text))
    except InputError as error:
        raise ArgumentTypeError(str(error)) from None
    return text
