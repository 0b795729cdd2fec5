"""The friction that contacts need to press against each other, against an oracle and known answers."""

from math import inf, radians, tan

import numpy as np
import pytest
from holdfast.geometry import cone_edges, perpendicular
from holdfast.pipeline.verify.reading import friction_to_oppose
from scipy.optimize import linprog


def cancel(normals: np.ndarray, mu: float) -> bool:
    """Whether forces within friction cones cancel, by a linear program over the cones' edges."""
    edges = cone_edges(mu, 0.0, 2)[:3]
    columns = np.hstack([np.vstack([n, perpendicular(n)]).T @ edges for n in normals])
    rows = np.vstack([columns, np.ones(columns.shape[1])])
    return bool(linprog(np.zeros(columns.shape[1]), A_eq=rows, b_eq=[0.0, 0.0, 0.0, 1.0]).status == 0)


@pytest.mark.parametrize("degrees", [0.0, 10.0, 60.0])
def test_two_faces_need_half_of_the_angle_between_them(degrees: float) -> None:
    half = radians(degrees) / 2.0
    normals = np.array([[np.cos(half), np.sin(half), 0.0], [-np.cos(half), np.sin(half), 0.0]])
    assert friction_to_oppose(normals) == pytest.approx(tan(half), abs=1e-9)


def test_forces_cancel_at_that_friction_and_at_no_less() -> None:
    rng = np.random.default_rng(0)
    for k in (2, 3, 3, 4):
        normals = rng.normal(loc=(0.4, 0.0, 0.0), size=(k, 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        mu = friction_to_oppose(normals)
        assert cancel(normals, 1.05 * mu + 1e-6)
        assert mu < 1e-9 or not cancel(normals, 0.98 * mu)


def test_one_contact_or_none_never_does() -> None:
    assert friction_to_oppose(np.zeros((0, 3))) == friction_to_oppose(np.eye(3)[:1]) == inf
