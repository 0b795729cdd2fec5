"""The verbs of the command line for other programs: JSON over HTTP on this machine, and MCP over stdio."""

from .http_server import HttpServer
from .jobs import Jobs
from .mcp_server import run_mcp

__all__ = ["HttpServer", "Jobs", "run_mcp"]
