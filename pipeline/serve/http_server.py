"""The verbs as JSON over HTTP, for programs on this machine alone.

Pages of other sites can reach a server on this machine through the user's browser, directly or under a name
of theirs that they let point here. So a request needs the token, a Host that is this server's, no Origin of
others, and JSON, which a page can't send without asking first.
"""

import hmac
import json
import secrets
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import unquote, urlsplit

from ... import __version__
from ...base.files.input_file import read_input
from ...errors import HoldfastError, InputError
from .inside import check_inside
from .jobs import Busy, Jobs, Overdue
from .verbs import VERBS

__all__ = ["HttpServer"]

_HOST = "127.0.0.1"
_LARGEST_REQUEST = 64 * 1024
_LARGEST_FILE = 64 * 1024 * 1024
# A client that sends nothing for so long is let go.
_PATIENCE_S = 15.0
_TYPES = {
    ".json": "application/json",
    ".png": "image/png",
    ".gif": "image/gif",
    ".webp": "image/webp",
    ".xml": "application/xml",
    ".yaml": "application/yaml",
    ".html": "text/html; charset=utf-8",
}


class HttpServer(ThreadingHTTPServer):
    """Listens on the loopback interface, at a port that is free.

    Args:
        jobs: does the requests.
        port: to listen at; 0 takes any.
        token: that clients have to send; a random one unless given.
        say: is told of every request, in a line.
    """

    daemon_threads = True

    def __init__(
        self, jobs: Jobs, port: int, *, token: str | None = None, say: Callable[[str], None] = lambda _: None
    ):
        self.jobs = jobs
        self.token = token or secrets.token_urlsafe(24)
        self.say = say
        super().__init__((_HOST, port), _Handler)

    @property
    def url(self) -> str:
        """Where it listens."""
        return f"http://{_HOST}:{self.server_port}"

    def knows_host(self, host: str | None) -> bool:
        """Whether a request was meant for this server, by its Host."""
        return host in (f"{_HOST}:{self.server_port}", f"localhost:{self.server_port}")


class _Refused(Exception):
    """A request that is not done: its status, and why."""

    def __init__(self, status: HTTPStatus, why: str):
        super().__init__(why)
        self.status = status


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server_version = f"holdfast/{__version__}"
    sys_version = ""
    timeout = _PATIENCE_S
    server: HttpServer

    def do_GET(self) -> None:
        """What can be asked for, or a file."""
        self._answer(self._get)

    def do_POST(self) -> None:
        """A request for a verb."""
        self._answer(self._post)

    def log_message(self, format: str, *words: Any) -> None:
        """Tells whoever started the server; the path is the client's, so it is shown as it was quoted."""
        self.server.say(
            f"{self.command} {urlsplit(self.path).path[:80]} {words[1] if len(words) > 1 else ''}"
        )

    def _answer(self, do: Callable[[], None]) -> None:
        try:
            self._check()
            do()
        except _Refused as error:
            self._send(error.status, {"error": str(error)})
        except InputError as error:
            self._send(HTTPStatus.BAD_REQUEST, {"error": str(error)})
        except Busy as error:
            self._send(HTTPStatus.SERVICE_UNAVAILABLE, {"error": str(error)}, {"Retry-After": "5"})
        except Overdue as error:
            self._send(HTTPStatus.GATEWAY_TIMEOUT, {"error": str(error)})
        except HoldfastError as error:
            self._send(HTTPStatus.INTERNAL_SERVER_ERROR, {"error": str(error)})

    def _check(self) -> None:
        if not self.server.knows_host(self.headers.get("Host")):
            raise _Refused(HTTPStatus.MISDIRECTED_REQUEST, "the Host is not this server")
        origin = self.headers.get("Origin")
        if origin is not None and not self.server.knows_host(origin.removeprefix("http://")):
            raise _Refused(HTTPStatus.FORBIDDEN, "requests of other pages are not answered")
        given = self.headers.get("Authorization", "").removeprefix("Bearer ")
        if not hmac.compare_digest(given.encode("utf-8"), self.server.token.encode("utf-8")):
            raise _Refused(HTTPStatus.UNAUTHORIZED, "send the token: Authorization: Bearer TOKEN")

    def _get(self) -> None:
        path = unquote(urlsplit(self.path).path)
        if path == "/":
            verbs = {
                name: {"summary": verb.summary, "request": verb.model_json_schema()}
                for name, verb in VERBS.items()
            }
            self._send(HTTPStatus.OK, {"holdfast": __version__, "verbs": verbs})
        elif path.startswith("/files/"):
            self._send_file(path.removeprefix("/files/"))
        else:
            raise _Refused(HTTPStatus.NOT_FOUND, "there are / and /files/PATH, and verbs to POST to")

    def _send_file(self, name: str) -> None:
        path = check_inside(self.server.jobs.folder, name, "files", "path")
        kind = _TYPES.get(path.suffix.lower())
        if kind is None or not path.is_file():
            raise _Refused(HTTPStatus.NOT_FOUND, "there is no such file, or none of a kind that is sent")
        # A report is a page of ours with names of others in it: it may do nothing at this address.
        headers = {"Content-Security-Policy": "sandbox", "Content-Disposition": "attachment"}
        self._send_bytes(
            HTTPStatus.OK, read_input(path, _LARGEST_FILE, source="files", links=False), kind, headers
        )

    def _post(self) -> None:
        verb = urlsplit(self.path).path.strip("/")
        if verb not in VERBS:
            raise _Refused(HTTPStatus.NOT_FOUND, f"there is no such verb; known: {', '.join(VERBS)}")
        answer = self.server.jobs.do(verb, self._body())
        self._send(HTTPStatus.OK, {"exit": answer.code, "result": answer.result})

    def _body(self) -> dict[str, Any]:
        if self.headers.get_content_type() != "application/json":
            raise _Refused(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "the body must be application/json")
        length = self.headers.get("Content-Length", "")
        if not (length.isascii() and length.isdigit()):
            raise _Refused(HTTPStatus.LENGTH_REQUIRED, "Content-Length is required")
        if len(length) > 12 or int(length) > _LARGEST_REQUEST:
            raise _Refused(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {_LARGEST_REQUEST} bytes")
        try:
            data = json.loads(self.rfile.read(int(length)))
        except (ValueError, RecursionError):
            raise _Refused(HTTPStatus.BAD_REQUEST, "the body is not JSON") from None
        except TimeoutError:
            raise _Refused(HTTPStatus.REQUEST_TIMEOUT, "the body did not come") from None
        if not isinstance(data, dict):
            raise _Refused(HTTPStatus.BAD_REQUEST, "the body must be a JSON object")
        return data

    def _send(self, status: HTTPStatus, data: dict[str, Any], headers: dict[str, str] | None = None) -> None:
        self._send_bytes(status, json.dumps(data).encode("utf-8"), "application/json", headers or {})

    def _send_bytes(self, status: HTTPStatus, body: bytes, kind: str, headers: dict[str, str]) -> None:
        # What is left of a request that was not read would be taken for the next one.
        self.close_connection = self.close_connection or status != HTTPStatus.OK
        self.send_response(status)
        for name, value in {
            "Content-Type": kind,
            "Content-Length": str(len(body)),
            "Cache-Control": "no-store",
            "X-Content-Type-Options": "nosniff",
            **({"Connection": "close"} if self.close_connection else {}),
            **headers,
        }.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)
