"""Systems that are supported, that may be tried, and that are refused."""

import sys

import pytest
from holdfast.base.machine.platform_check import require_supported_platform
from holdfast.errors import HoldfastError
from holdfast.pipeline.cli.command_line import run_command


@pytest.mark.parametrize(("system", "tried", "refused"), [
    ("linux", "", ""), ("darwin", "", "HOLDFAST_UNTESTED"), ("darwin", "1", ""), ("win32", "1", "Windows"),
])  # fmt: skip
def test_systems(system: str, tried: str, refused: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", system)
    monkeypatch.setenv("HOLDFAST_UNTESTED", tried)
    if refused:
        with pytest.raises(HoldfastError, match=refused):
            require_supported_platform()
    else:
        require_supported_platform()


def test_the_command_line_says_so_in_a_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    assert run_command(["tasks"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
