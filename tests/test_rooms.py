"""CONTRIBUTING's tables of rooms, held against the imports that the code really has."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[1]
NOT_ROOMS = {"tests", "benchmarks", "docs", "examples", "build", "dist", "runs"}
LARGEST_ROOM = 20
# Rooms that all others use, module by module.
BASE = "base"


class Import(NamedTuple):
    """A module, and a room or module of the package that it imports, as paths below the root."""

    where: str
    line: int
    target: tuple[str, ...]


def modules() -> list[Path]:
    """Every module of the package, relative to the root."""
    found = (path.relative_to(ROOT) for path in ROOT.rglob("*.py"))
    return sorted(p for p in found if p.parts[0] not in NOT_ROOMS and not p.parts[0].startswith("."))


MODULES = modules()
ROOMS = {path.parent.parts for path in MODULES if path.name == "__init__.py" and path.parent.parts}


def imports_of(path: Path) -> Iterator[Import]:
    """The package's own things that a module imports, wherever in it."""
    here = path.parent.parts
    for node in ast.walk(ast.parse((ROOT / path).read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names if alias.name.split(".")[0] == "holdfast"]
            assert not names, f"{path}:{node.lineno}: the package imports its own modules relatively"
        if not isinstance(node, ast.ImportFrom):
            continue
        assert (node.module or "").split(".")[0] != "holdfast", f"{path}:{node.lineno}: relative, please"
        if node.level:
            base = here[: len(here) - node.level + 1]
            target = base + tuple((node.module or "").split(".") if node.module else ())
            for alias in node.names:
                inner = (*target, alias.name)
                is_module = inner in ROOMS or Path(*inner).with_suffix(".py") in MODULES
                # A face may give a function the name of its module; then the function is meant.
                yield Import(str(path), node.lineno, inner if is_module and target not in ROOMS else target)


def room_of(path: tuple[str, ...]) -> tuple[str, ...]:
    """The innermost room that a module or room lies in; () for modules at the root."""
    while path and path not in ROOMS:
        path = path[:-1]
    return path


def table() -> dict[tuple[str, ...], set[tuple[str, ...]]]:
    """What each room may import, by CONTRIBUTING; in its order."""
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    section = text.partition("## Rooms, and which way the arrows point")[2].partition("\n## ")[0]
    rows: dict[tuple[str, ...], set[tuple[str, ...]]] = {}
    for line in section.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) != 3 or not (name := re.fullmatch(r"`([\w/]+)/`", cells[0])):
            continue
        room = tuple(name[1].split("/"))
        assert room not in rows, f"{name[1]} stands twice"
        rows[room] = {tuple(other.split("/")) for other in re.findall(r"`([\w/]+)`", cells[2])}
    return rows


TABLE = table()


def test_the_table_names_every_room_and_no_other() -> None:
    assert set(TABLE) == ROOMS


def test_rooms_import_only_rooms_that_stand_above_them() -> None:
    order = list(TABLE)
    for place, room in enumerate(order):
        for other in TABLE[room]:
            assert other in order[:place], (
                f"{'/'.join(room)} may not import {'/'.join(other)}: it stands below"
            )


@pytest.mark.parametrize("room", [pytest.param(room, id="/".join(room)) for room in sorted(ROOMS)])
def test_a_room_imports_what_its_row_allows_and_through_faces(room: tuple[str, ...]) -> None:
    used = set()
    for path in MODULES:
        if path.parent.parts != room:
            continue
        for found in imports_of(path):
            target_room = room_of(found.target)
            where = f"{found.where}:{found.line}"
            if target_room in (room, ()):  # a neighbour, or a module at the root
                continue
            if target_room[0] == BASE:
                assert found.target not in ROOMS, f"{where}: {BASE} has no faces"
                if room[0] == BASE:
                    assert target_room in TABLE[room], f"{where}: not in this room's row"
                    used.add(target_room)
                continue
            if room[: len(target_room)] == target_room:  # a module of a room around this one
                assert found.target not in ROOMS, (
                    f"{where}: the face of a room around this one imports this one"
                )
                continue
            if target_room[: len(room)] == room:  # the face gathers what its inner rooms offer
                assert found.target in ROOMS, f"{where}: passes the face of {'/'.join(target_room)}"
                used.add(target_room)
                continue
            assert found.target in ROOMS, f"{where}: passes the face of {'/'.join(target_room)}"
            assert target_room in TABLE[room], f"{where}: {'/'.join(target_room)} is not in this room's row"
            used.add(target_room)
    idle = TABLE[room] - used
    assert not idle, f"the row of {'/'.join(room)} allows what it does not need: {sorted(idle)}"


def test_modules_at_the_root_import_each_other_and_base_alone() -> None:
    for path in MODULES:
        if path.parent.parts or path.name in {"__init__.py", "__main__.py"}:
            continue
        for found in imports_of(path):
            assert room_of(found.target)[:1] in ((), (BASE,)), f"{found.where}:{found.line}"


def test_every_face_says_what_its_room_is_and_lists_its_names() -> None:
    for room in sorted(ROOMS):
        tree = ast.parse((ROOT.joinpath(*room) / "__init__.py").read_text("utf-8"))
        assert ast.get_docstring(tree), "/".join(room)
        if any(isinstance(node, ast.ImportFrom) for node in tree.body):
            names = [
                t.id
                for n in tree.body
                if isinstance(n, ast.Assign)
                for t in n.targets
                if isinstance(t, ast.Name)
            ]
            assert "__all__" in names, "/".join(room)


def test_no_room_is_crowded() -> None:
    for room in sorted(ROOMS):
        count = sum(path.parent.parts == room and path.name != "__init__.py" for path in MODULES)
        assert count <= LARGEST_ROOM, f"{'/'.join(room)} has {count} modules"
