"""Forces of the largest slack: known answers."""

import numpy as np
import pytest
from holdfast.evidence.slack_forces import SlackProblem, largest_slack


def pushes(weights: list[float], *, least_N: float, contacts: int = 1) -> SlackProblem:
    """Contacts side by side that press against weights along their normals, which alone are balanced."""
    A = np.zeros((1, 4 * contacts))
    A[0, 0::4] = 1.0
    if contacts == 1:
        A = np.eye(4)
    b = np.zeros((len(weights), len(A)))
    b[:, 0] = weights
    return SlackProblem(
        A=A,
        b=b,
        T=np.zeros((0, 4 * contacts)),
        effort=np.zeros(0),
        contact=np.arange(contacts),
        least=np.full(contacts, least_N),
        most=100.0,
        mu=0.5,
        mu_t=np.full(contacts, 0.002),
    )


@pytest.mark.parametrize("contacts", [1, 2, 3])
def test_equal_contacts_share_a_weight(contacts: int) -> None:
    weights = [6.0, 9.0, 98.0]
    slack, forces = largest_slack(pushes(weights, least_N=0.5, contacts=contacts))
    shares = np.array(weights) / contacts
    assert slack == pytest.approx(np.minimum(shares - 0.5, 100.0 - shares), abs=2e-3)
    assert forces[..., 0].sum(axis=1) == pytest.approx(np.array(weights))


def test_it_ends_at_the_first_load_without_slack() -> None:
    slack, _ = largest_slack(pushes([6.0, 2.0, 4.0], least_N=1.5, contacts=2))
    assert slack[0] == pytest.approx(1.5, abs=2e-3)
    assert slack[1] < 0.0 and slack[2] == np.inf


def test_a_load_that_nothing_balances_has_none() -> None:
    problem = pushes([6.0], least_N=0.0)
    problem.b[0, 1] = 1.0
    sideways = SlackProblem(**{**vars(problem), "A": problem.A * np.array([1.0, 0.0, 1.0, 1.0])})
    assert largest_slack(sideways)[0][0] == -np.inf
