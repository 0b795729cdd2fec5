"""Tables, progress lines and the interrupt that waits."""

import io
import os
import signal
import threading

import pytest
from holdfast.base.text.console import Console, format_table
from holdfast.base.text.plain_text import printable
from holdfast.pipeline.cli.interrupt import stop_on_interrupt


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


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


def test_a_log_hears_of_progress_now_and_then() -> None:
    file, clock = io.StringIO(), Clock()
    console = Console(stream=file, clock=clock)
    for _ in range(100):
        clock.now += 1.0
        console.pass_by("under way")
    assert 3 <= file.getvalue().count("under way\n") <= 10
    console.say("a step")
    said = file.getvalue()
    clock.now += 5.0
    console.pass_by("just said something")
    assert file.getvalue() == said


def test_a_terminal_line_is_no_wider_than_the_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "30")
    terminal = Terminal()
    Console(stream=terminal).pass_by("x" * 200)
    assert terminal.getvalue() == "x" * 29


def test_a_count_tells_rate_and_time_left() -> None:
    terminal, clock = Terminal(), Clock()
    count = Console(stream=terminal, clock=clock).count("drawing", 16)
    assert str(count) == "drawing: 0 of 16, 0 s"
    clock.now += 8.0
    assert str(count) == "drawing: 0 of 16, 8 s"
    for _ in range(4):
        count.step()
    assert str(count) == "drawing: 4 of 16, 2 s each, about 24 s left"
    for _ in range(12):
        count.step()
    assert str(count) == "drawing: 16 of 16, 2 a second, about 0 s left"
    assert "drawing: 1 of 16" in terminal.getvalue()


def test_a_long_count_tells_minutes_and_hours() -> None:
    clock = Clock()
    count = Console(stream=Terminal(), clock=clock).count("holding", 1000)
    clock.now += 60.0
    count.step()
    assert str(count) == "holding: 1 of 1000, 60 s each, about 16.6 h left"
    count.done = 900
    assert str(count).endswith("15 a second, about 7 s left")
    count.done = 200
    assert str(count).endswith("3.3 a second, about 4 min left")


def test_a_question_that_is_asked_again_and_again_shows_the_count() -> None:
    terminal, clock = Terminal(), Clock()
    count = Console(stream=terminal, clock=clock).count("holding", 2)
    ask = count.watching(lambda: clock.now > 103.0)
    answers = []
    for _ in range(5):
        clock.now += 1.0
        answers.append(ask())
    assert answers == [False, False, False, True, True]
    assert "holding: 0 of 2, 3 s" in terminal.getvalue()


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
