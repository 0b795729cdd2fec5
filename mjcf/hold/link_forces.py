"""Which contacts are the object's, and how hard each link presses on it; asked for every few steps."""

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices

__all__ = ["link_forces", "other_bodies"]


@compiled
def other_bodies(geoms: Indices, body_of: Indices, body: int, out: Indices) -> None:
    """Writes the other body (n,) of each contact of a body, and -1 for contacts that are not its.

    Args:
        geoms: (n, 2) geoms of the contacts.
        body_of: (n_geoms,) the body of each geom.
        body: which one.
        out: (n,) takes the bodies.
    """
    for k in range(len(geoms)):
        a, b = body_of[geoms[k, 0]], body_of[geoms[k, 1]]
        if (a == body) == (b == body):
            out[k] = -1
        else:
            out[k] = b if a == body else a


@compiled
def link_forces(
    others: Indices, rows: Indices, forces: Array, links: Indices, normals: Array, strongest: Indices
) -> None:
    """Adds up normal forces of contacts by link.

    Args:
        others: (n,) see `other_bodies`.
        rows: (n,) the row in `forces` of each contact's normal force; -1 where it has none.
        forces: of all constraints, in N.
        links: (k,) bodies.
        normals: (k,) takes the sum for each link.
        strongest: (k,) takes the contact with the largest force of each link, the last of equals; -1 where
            the link touches nowhere.
    """
    for i in range(len(links)):
        normals[i], strongest[i] = 0.0, -1
        largest = 0.0
        for k in range(len(others)):
            if others[k] != links[i]:
                continue
            force = forces[rows[k]] if rows[k] >= 0 else 0.0
            normals[i] += force
            if strongest[i] < 0 or force >= largest:
                strongest[i], largest = k, force
