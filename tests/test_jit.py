import numpy as np
import pytest
from holdfast.jit import compiled

SOURCE = """
def reciprocal(x):
    return 1.0 / x
"""


def test_what_cannot_be_cached_is_compiled_all_the_same():
    scope = {}
    exec(SOURCE, scope)  # code without a file has no place to keep its machine code
    assert compiled(scope["reciprocal"])(4.0) == pytest.approx(0.25)


def test_division_by_zero_is_that_of_numpy():
    scope = {}
    exec(SOURCE, scope)
    assert compiled(scope["reciprocal"])(0.0) == np.inf


def test_what_is_copied_into_its_callers_is_compiled_as_well():
    scope = {}
    exec(SOURCE, scope)
    assert compiled(scope["reciprocal"], inline=True)(4.0) == pytest.approx(0.25)
