"""Meshes as Wavefront OBJ."""

import trimesh

__all__ = ["obj_text"]


def obj_text(mesh: trimesh.Trimesh) -> str:
    """The mesh as the text of an OBJ file, every digit of its vertices, in their unit."""
    lines = ["v " + " ".join(repr(float(value)) for value in vertex) for vertex in mesh.vertices]
    lines += ["f " + " ".join(str(int(i) + 1) for i in face) for face in mesh.faces]
    return "\n".join(lines) + "\n"
