"""The verbs for other programs: what is done, and what is not, over HTTP and over MCP."""

import asyncio
import http.client
import json
import os
import re
import sys
import threading
from base64 import b64decode
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from holdfast.errors import HoldfastError, InputError
from holdfast.pipeline.cli.parsers import command_parser
from holdfast.pipeline.cli.registry import COMMANDS
from holdfast.pipeline.serve import HttpServer, Jobs
from holdfast.pipeline.serve.jobs import Answer, Busy, Overdue
from holdfast.pipeline.serve.mcp_server import mcp_server
from holdfast.pipeline.serve.verbs import VERBS, read_request
from mcp import Client, StdioServerParameters, stdio_client

SOLVE = {"task": "upholding", "candidates": 1}
OUTSIDE = [
    "/etc/passwd",
    "../t.yaml",
    "a/../../t.yaml",
    "link/t.yaml",
    "upholding@../h.yaml",
    "~/t.yaml",
    "..\\t",
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "t.yaml").write_text("name: t\n", "utf-8")
    served = tmp_path / "served"
    served.mkdir()
    (served / "link").symlink_to(tmp_path / "elsewhere")
    (served / "note.json").write_text("{}", "utf-8")
    (served / "run.sh").write_text("true", "utf-8")
    return served


@pytest.fixture
def server(folder: Path) -> Iterator[HttpServer]:
    with HttpServer(Jobs(folder), 0) as found:
        thread = threading.Thread(target=found.serve_forever, args=(0.01,))
        thread.start()
        yield found
        found.shutdown()
        thread.join()


def ask(server: HttpServer, method: str, path: str, body: bytes | None = None, **headers: str | None) -> Any:
    """Status and JSON of an answer; a header of None is not sent."""
    usual = {
        "Host": f"127.0.0.1:{server.server_port}",
        "Authorization": f"Bearer {server.token}",
        "Content-Type": "application/json",
        "Content-Length": str(len(body or b"")),
    }
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=60)
    connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
    for name, value in {**usual, **{name.replace("_", "-"): v for name, v in headers.items()}}.items():
        if value is not None:
            connection.putheader(name, value)
    connection.endheaders(body)
    answer = connection.getresponse()
    text = answer.read()
    connection.close()
    return answer.status, json.loads(text) if answer.getheader("Content-Type") == "application/json" else text


def post(server: HttpServer, verb: str, data: object, **headers: str | None) -> Any:
    return ask(server, "POST", f"/{verb}", json.dumps(data).encode(), **headers)


def test_a_name_that_nothing_has_is_refused_by_the_command_itself(server: HttpServer) -> None:
    status, answer = post(server, "solve", {"task": "upholdin"})
    assert (status, answer) == (
        400,
        {"error": "solve: task: unknown task 'upholdin'; did you mean 'upholding'?"},
    )


@pytest.fixture
def documented_ask() -> Callable[..., Any]:
    """The client of docs/serve.md."""
    text = (Path(__file__).resolve().parents[3] / "docs" / "serve.md").read_text("utf-8")
    names: dict[str, Any] = {}
    exec(re.search(r"```python\n(.*?)```", text, re.DOTALL)[1], names)
    return names["ask"]


def test_the_documented_client_is_answered(
    server: HttpServer, documented_ask: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server.jobs, "_run", lambda _: (0, b'{"verdict": "solved"}', ""))
    answer = documented_ask(server.url, server.token, "solve", task="upholding", candidates=2)
    assert answer == {"exit": 0, "result": {"verdict": "solved"}}


@pytest.mark.slow
def test_a_task_is_solved_over_http_as_on_the_command_line(server: HttpServer) -> None:
    status, answer = post(server, "solve", SOLVE)
    assert status == 200 and answer["exit"] == 0
    assert answer["result"]["verdict"] == "solved" and answer["result"]["solutions"][0]["certified"]


def test_the_verbs_are_told_with_their_schemas(server: HttpServer) -> None:
    status, answer = ask(server, "GET", "/")
    assert status == 200 and list(answer["verbs"]) == list(VERBS)
    assert answer["verbs"]["solve"]["request"]["required"] == ["task"]


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Authorization": None}, 401),
        ({"Authorization": "Bearer guessed"}, 401),
        ({"Host": "attacker.example"}, 421),
        ({"Host": None}, 421),
        ({"Origin": "http://attacker.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Content_Type": "text/plain"}, 415),
        ({"Content_Length": None}, 411),
        ({"Content_Length": "-1"}, 411),
        ({"Content_Length": "99999999999999999999"}, 413),
        ({"Content_Length": "70000"}, 413),
    ],
)
def test_requests_of_others_and_of_no_measure_are_refused(
    headers: dict[str, str | None], status: int, server: HttpServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Jobs, "do", lambda *_: pytest.fail("it was done"))
    found, answer = post(server, "solve", SOLVE, **headers)
    assert found == status and answer["error"]


@pytest.mark.parametrize("body", [b"", b"[1]", b"{", b"\xff", b"[" * 30_000, b"NaN"])
def test_what_is_no_json_object_is_refused(body: bytes, server: HttpServer) -> None:
    status, answer = ask(server, "POST", "/solve", body)
    assert status == 400 and answer["error"]


@pytest.mark.parametrize("path", ["/nothing", "/files/none.json", "/files/run.sh", "/files/"])
def test_what_is_not_there_is_not_found(path: str, server: HttpServer) -> None:
    assert ask(server, "GET", path)[0] == 404


@pytest.mark.parametrize(
    "name", ["../elsewhere/t.yaml", "link/t.yaml", "%2e%2e/elsewhere/t.yaml", "/etc/passwd"]
)
def test_no_file_outside_the_folder_is_sent(name: str, server: HttpServer) -> None:
    status, answer = ask(server, "GET", f"/files/{name}")
    assert status in (400, 404) and "error" in answer


def test_files_of_the_folder_are_sent(server: HttpServer) -> None:
    assert ask(server, "GET", "/files/note.json") == (200, {})


@pytest.mark.parametrize(
    ("error", "status"),
    [(Busy("b"), 503), (Overdue("o"), 504), (InputError("s", "f", "x"), 400), (HoldfastError("h"), 500)],
)
def test_errors_have_statuses(
    error: HoldfastError, status: int, server: HttpServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> Answer:
        raise error

    monkeypatch.setattr(Jobs, "do", fail)
    assert post(server, "solve", SOLVE) == (status, {"error": str(error)})


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("name", OUTSIDE)
def test_no_request_reads_outside_the_folder(verb: str, name: str, folder: Path) -> None:
    good = {"verify": {"files": ["g.npy"], "hand": "sa", "object": "scalpel"}, "show": {"name": "sa"}}
    request = good.get(verb, {"task": "upholding", "hand": "sa"})
    assert read_request(verb, request, folder).names()
    for field, value in request.items():
        bad = [name] if isinstance(value, list) else name
        with pytest.raises(InputError, match=f"{verb}: {field}"):
            read_request(verb, {**request, field: bad}, folder)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ({"task": "--help"}, "task"),
        ({"task": "-h"}, "task"),
        ({"task": "a\nb"}, "task"),
        ({"task": ""}, "task"),
        ({"task": "upholding", "candidates": 0}, "candidates"),
        ({"task": "upholding", "candidates": 10**9}, "candidates"),
        ({"task": "upholding", "budget_s": 1e9}, "budget_s"),
        ({"task": "upholding", "hand": "../h.yaml"}, "hand"),
        ({"tsak": "upholding"}, "did you mean 'task'?"),
        ({}, "is required"),
    ],
)
def test_bad_fields_are_told(data: dict[str, object], says: str, folder: Path) -> None:
    with pytest.raises(InputError, match=says.replace("?", r"\?")):
        read_request("solve", data, folder)
    with pytest.raises(InputError, match="unknown verb 'slove'; did you mean 'solve'"):
        read_request("slove", data, folder)


@pytest.mark.parametrize(
    ("verb", "data"),
    [
        ("solve", {"task": "upholding", "hand": "shadow", "statics": True, "explain_s": 2.5, "seed": 3}),
        ("run", {"task": "box.yaml", "wanted": 0, "quick": False, "replace": True}),
        (
            "verify",
            {"files": ["a.npy", "b.npy"], "hand": "sa", "object": "cup.obj", "mass_kg": 0.1, "count": 2},
        ),
        ("show", {"name": "box.yaml", "view": "-30,20"}),
        ("show", {"name": "teapot", "view": "front"}),
    ],
)
def test_requests_are_command_lines_that_are_understood(
    verb: str, data: dict[str, object], folder: Path
) -> None:
    name, *words = read_request(verb, data, folder).words()
    _, unknown = command_parser(COMMANDS[name]).parse_known_args(words)
    assert name == verb and not unknown


def test_one_request_at_a_time_unless_more_are_allowed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    jobs = Jobs(folder)

    def run(words: list[str]) -> tuple[int, bytes, str]:
        with pytest.raises(Busy):
            jobs.do("solve", SOLVE)
        return 0, b"{}", ""

    monkeypatch.setattr(jobs, "_run", run)
    assert jobs.do("solve", SOLVE) == Answer(0, {})


def test_what_takes_too_long_is_ended_and_leaves_no_process(folder: Path) -> None:
    jobs = Jobs(folder, longest_s=0.2)
    with pytest.raises((Overdue, HoldfastError)):
        jobs.do("solve", SOLVE)
    assert not jobs._running


def test_a_command_that_refuses_is_bad_input(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    jobs = Jobs(folder)
    monkeypatch.setattr(jobs, "_run", lambda _: (2, b"", "holdfast: unknown task 'x'"))
    with pytest.raises(InputError, match="solve: unknown task 'x'"):
        jobs.do("solve", SOLVE)
    monkeypatch.setattr(jobs, "_run", lambda _: (-9, b"", ""))
    with pytest.raises(HoldfastError, match="exit code -9"):
        jobs.do("solve", SOLVE)


def test_tools_over_mcp_have_the_schemas_of_the_verbs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    jobs = Jobs(folder)
    monkeypatch.setattr(jobs, "_run", lambda _: (3, b'{"verdict": "infeasible"}', ""))

    async def talk() -> None:
        async with Client(mcp_server(jobs)) as client:
            tools = (await client.list_tools()).tools
            assert [tool.name for tool in tools] == list(VERBS)
            assert all(tool.description and tool.input_schema["type"] == "object" for tool in tools)
            answer = await client.call_tool("solve", SOLVE)
            assert not answer.is_error
            assert answer.structured_content == {"exit": 3, "result": {"verdict": "infeasible"}}
            refused = await client.call_tool("solve", {"task": "../t.yaml"})
            assert refused.is_error and "below the served folder" in refused.content[0].text

    asyncio.run(talk())


def test_a_picture_is_an_image_over_mcp(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    jobs = Jobs(folder)

    def draw(words: list[str]) -> tuple[int, bytes, str]:
        target = next(word.removeprefix("--out=") for word in words if word.startswith("--out="))
        (folder / target).parent.mkdir(exist_ok=True)
        (folder / target).write_bytes(b"a picture")
        return 0, b"", ""

    monkeypatch.setattr(jobs, "_run", draw)

    async def talk() -> None:
        async with Client(mcp_server(jobs)) as client:
            answer = await client.call_tool("show", {"name": "a/b c.yaml"})
            (content,) = answer.content
            assert content.mime_type == "image/png" and b64decode(content.data) == b"a picture"
            assert answer.structured_content["result"] == {"picture": "shown/a_b_c_yaml.png"}

    asyncio.run(talk())


def test_a_client_of_the_official_sdk_talks_to_it_over_stdio(folder: Path) -> None:
    words = ["-P", "-m", "holdfast", "serve", str(folder), "--mcp", "--quiet"]
    program = StdioServerParameters(command=sys.executable, args=words, env=dict(os.environ))

    async def talk() -> None:
        async with Client(stdio_client(program)) as client:
            assert [tool.name for tool in (await client.list_tools()).tools] == list(VERBS)
            unknown = await client.call_tool("solve", {"task": "upholdin"})
            assert unknown.is_error and "did you mean 'upholding'?" in unknown.content[0].text

    asyncio.run(talk())
