"""System files: exact contents, and one line for what is wrong."""

from fractions import Fraction

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.solver.systems.file import system_from_data

GOOD = {"variables": {"x": [-2, 2], "y": [0, 0.3]}, "equations": ["x**2 + y**2 - 1", "0.1*x - y**3"]}


def test_a_system_is_read_exactly():
    problem = system_from_data({**GOOD, "name": "n", "description": "d"}, "file")
    assert problem.names == ("x", "y")
    assert problem.lower == (-2, 0) and problem.upper == (2, Fraction(3, 10))
    assert problem.equations[1] == ({((0, 1),): Fraction(1, 10), ((1, 3),): Fraction(-1)},)


@pytest.mark.parametrize("text", ["0.1", "1e-5", "-123456.789", "3", "1e9", "5e-324", "-0.0"])
def test_ends_are_the_decimals_of_the_file(text):
    problem = system_from_data({"variables": {"x": [float(text), 1e9]}, "equations": ["x"]}, "file")
    assert problem.lower == (Fraction(text),)


@pytest.mark.parametrize(
    ("changes", "field", "says"),
    [
        ({"variables": {}}, "variables", "at least 1"),
        ({"equations": []}, "equations", "at least 1"),
        ({"variables": {f"x{k}": [0, 1] for k in range(600)}}, "variables", "at most 500"),
        ({"equations": ["x"] * 2001}, "equations", "at most 2000"),
        ({"variables": {"x": [1, 0], "y": [0, 1]}}, "variables.x", "lower end 1.0 is above the upper 0.0"),
        ({"variables": {"x": [1.0000001, 1], "y": [0, 1]}}, "variables.x", "1.0000001 is above"),
        ({"variables": {"x": [0, float("nan")]}}, "variables.x.1", "finite"),
        ({"variables": {"x": [float("-inf"), 0]}}, "variables.x.0", "finite"),
        ({"variables": {"x": [0, 1e10]}}, "variables.x.1", "less than or equal to 1000000000"),
        ({"variables": {"x": [0]}}, "variables.x.1", "required"),
        ({"variables": {"x": [0, 1, 2]}}, "variables.x", "at most 2"),
        ({"variables": {"x": "wide"}}, "variables.x", "tuple"),
        ({"variables": {"x": None}}, "variables.x", "tuple"),
        ({"variables": [["x", 0, 1]]}, "variables", "dictionary"),
        ({"variables": {"2x": [0, 1]}}, "variables.2x", "a variable is a letter"),
        ({"variables": {"x y": [0, 1]}}, "variables.x y", "a variable is a letter"),
        ({"variables": {"": [0, 1]}}, "variables.", "a variable is a letter"),
        ({"variables": {"\u00fc": [0, 1]}}, "variables.", "a variable is a letter"),
        ({"variables": {"x\n": [0, 1]}}, "variables.", "a variable is a letter"),
        ({"variables": {"x" * 5000: [0, 1]}}, "variables.xxx", "a variable is a letter"),
        ({"equations": ["x", "z - 1"]}, "equations.1", "unknown variable 'z'"),
        ({"equations": ["x - x"]}, "equations.0", "zero for all values"),
        ({"equations": ["0"]}, "equations.0", "zero for all values"),
        ({"equations": [1]}, "equations.0", "string"),
        ({"equations": "x"}, "equations", "list"),
        ({"equations": ["x ** 1e3"]}, "equations.0", "exponents"),
        ({"equation": ["x"]}, "equation", "did you mean 'equations'?"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_in_one_line(changes, field, says):
    with pytest.raises(InputError) as caught:
        system_from_data({**GOOD, **changes}, "file.json")
    message = str(caught.value)
    assert message.startswith(f"file.json: {field}") and says in message, message
    assert message.isprintable() and len(message) < 400


def test_constants_are_equations():
    assert system_from_data({**GOOD, "equations": ["1"]}, "file").equations == ((),)


def test_numpy_takes_the_ends():
    problem = system_from_data(GOOD, "file")
    assert np.array(problem.upper, dtype=float).tolist() == [2.0, 0.3]
