"""Tables, progress lines and the interrupt that waits."""

import io
import os
import signal
import threading

import pytest
from holdfast.console import Console, format_table
from holdfast.pipeline.cli.interrupt import stop_on_interrupt
from holdfast.plain_text import printable


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_numbers_stand_flush_right() -> None:
    table = format_table(("name", "n"), [("a", "1"), ("bcd", "-12.5"), ("e", "-")])
    assert table.splitlines() == ["name      n", "----  -----", "a         1", "bcd   -12.5", "e         -"]


def test_an_empty_table_has_its_head() -> None:
    assert format_table(("a", "b"), []) == "a  b\n-  -"


def test_control_characters_become_question_marks() -> None:
    assert printable("a\x1b[31m\nb\u202e") == "a?[31m?b?"
    assert format_table(("x",), [("a\nb",)]).count("\n") == 2


def test_passing_lines_are_for_terminals() -> None:
    file, terminal = io.StringIO(), Terminal()
    for stream in (file, terminal):
        console = Console(stream=stream)
        console.pass_by("one of many")
        console.say("done")
    assert file.getvalue() == "done\n"
    assert terminal.getvalue() == "one of many\r\x1b[Kdone\n"


def test_quiet_says_nothing() -> None:
    stream = Terminal()
    console = Console(quiet=True, stream=stream)
    console.pass_by("a")
    console.say("b")
    assert stream.getvalue() == ""


def test_the_first_interrupt_waits_and_the_second_does_not() -> None:
    said: list[str] = []
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), stop_on_interrupt(said.append) as should_stop:
        assert not should_stop()
        os.kill(os.getpid(), signal.SIGINT)
        assert should_stop() and len(said) == 1
        os.kill(os.getpid(), signal.SIGINT)
        raise AssertionError("the second interrupt came through")
    assert signal.getsignal(signal.SIGINT) is before


def test_elsewhere_than_in_the_main_thread_signals_are_left_alone() -> None:
    answers: list[bool] = []

    def ask() -> None:
        with stop_on_interrupt(lambda _: None) as should_stop:
            answers.append(should_stop())

    thread = threading.Thread(target=ask)
    thread.start()
    thread.join()
    assert answers == [False]
