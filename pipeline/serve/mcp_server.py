"""The verbs as tools of the Model Context Protocol, over stdin and stdout."""

import base64
import json
from typing import TYPE_CHECKING, Any

from ... import __version__
from ...errors import HoldfastError, MissingBackend
from .jobs import Answer, Jobs
from .verbs import VERBS

if TYPE_CHECKING:
    import mcp_types
    from mcp.server import Server

__all__ = ["mcp_server", "run_mcp"]


def run_mcp(jobs: Jobs) -> None:
    """Answers a client on stdin and stdout until it leaves.

    Raises:
        MissingBackend: the extra with the official SDK is not installed.
    """
    server = mcp_server(jobs)
    import anyio
    from mcp.server.stdio import stdio_server

    async def serve() -> None:
        async with stdio_server() as (incoming, outgoing):
            await server.run(incoming, outgoing, server.create_initialization_options())

    anyio.run(serve)


def mcp_server(jobs: Jobs) -> "Server[Any]":
    """A server with a tool for each verb.

    Raises:
        MissingBackend: the extra with the official SDK is not installed.
    """
    try:
        import anyio.to_thread
        import mcp_types as types
        from mcp.server import Server
    except ImportError:
        raise MissingBackend("the MCP server needs the package mcp: pip install 'holdfast[serve]'") from None

    tools = [
        types.Tool(name=name, description=verb.summary, input_schema=verb.model_json_schema())
        for name, verb in VERBS.items()
    ]

    async def list_tools(context: Any, params: Any) -> "mcp_types.ListToolsResult":
        del context, params
        return types.ListToolsResult(tools=tools)

    async def call_tool(
        context: Any, params: "mcp_types.CallToolRequestParams"
    ) -> "mcp_types.CallToolResult":
        del context
        try:
            answer = await anyio.to_thread.run_sync(jobs.do, params.name, params.arguments or {})
        except HoldfastError as error:
            return types.CallToolResult(content=[types.TextContent(text=str(error))], is_error=True)
        return types.CallToolResult(content=_content(answer), structured_content=_structured(answer))

    def _content(answer: Answer) -> "list[mcp_types.ContentBlock]":
        if answer.picture is not None:
            data = base64.b64encode(answer.picture).decode("ascii")
            return [types.ImageContent(data=data, mime_type="image/png")]
        return [types.TextContent(text=json.dumps(_structured(answer)))]

    return Server(
        "holdfast",
        version=__version__,
        instructions="Grasps of objects by robot hands: certified, free of penetration, tried in simulation.",
        on_list_tools=list_tools,
        on_call_tool=call_tool,
    )


def _structured(answer: Answer) -> dict[str, Any]:
    return {"exit": answer.code, "result": answer.result}
