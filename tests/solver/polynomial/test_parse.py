"""Text becomes the polynomial that Python's grammar and rational arithmetic say; all else is one error."""

import re
from fractions import Fraction

import pytest
from holdfast.errors import InputError
from holdfast.solver.polynomial.exact import evaluate
from holdfast.solver.polynomial.parse import parse_factors, parse_polynomial
from hypothesis import given, settings
from hypothesis import strategies as st

NAMES = ("x", "y", "z_1", "lambda")
NUMBER = re.compile(r"(?<![\w.])(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


def by_python(text: str, point: dict[str, Fraction]) -> Fraction:
    """The value by Python's own parser, with every number taken as an exact one."""
    exact = NUMBER.sub(lambda found: f"Fraction('{found[0]}')", text.replace("^", "**"))
    return Fraction(eval(exact.replace("lambda", "lambda_"), {**point, "Fraction": Fraction}))


numbers = st.sampled_from(
    ["0", "1", "2", "3", "0.1", ".5", "7.", "1e-3", "2.5E+2", "12345.6789", "10000000000000001"]
)
atoms = st.one_of(numbers, st.sampled_from(NAMES))
divisors = st.sampled_from(["3", "0.7", "(1/3)", "-2", "(2-5)"])


def larger(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", " * ", "*", " - ", "\n+ "]), inner).map("".join),
        inner.map(lambda text: f"({text})"),
        st.tuples(st.sampled_from(["-", "+", "- -"]), inner).map("".join),
        st.tuples(inner, divisors).map("/".join),
        st.tuples(atoms, st.sampled_from(["**", "^", " ** "]), st.sampled_from("0123")).map("".join),
        inner.map(lambda text: f"({text})**2"),
    )


expressions = st.recursive(atoms, larger, max_leaves=8)
values = st.fractions(-3, 3, max_denominator=50)


@settings(max_examples=400, deadline=None, derandomize=True)
@given(expressions, st.tuples(values, values, values, values))
def test_values_are_those_of_python(text, x):
    point = dict(zip(("x", "y", "z_1", "lambda_"), x, strict=True))
    try:
        polynomial = parse_polynomial(text, NAMES, "file", "equations.0")
    except InputError as error:
        assert re.search("degree|terms|digits", str(error)), error  # a limit, never a misunderstanding
        return
    # A line break ends an expression for Python only outside of parentheses.
    assert evaluate(polynomial, x) == by_python(f"({text})", point)
    for monomial, coefficient in polynomial.items():
        assert coefficient != 0
        assert [v for v, _ in monomial] == sorted({v for v, _ in monomial})
        assert all(e >= 1 for _, e in monomial)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("-x**2", -4),
        ("2**3**2/512", 1),
        ("x - y - 1", -2),
        ("12/2/3*x", 4),
        ("2*-x", -4),
        ("--x", 2),
        ("-2**2", -4),
        ("x**0 + 0**0", 2),
        ("0.1 + 0.2 - 0.3", 0),
        ("(x + y)^3", 125),
        ("x * y - y * x", 0),
        ("  x\t*\ny  ", 6),
        ("x**2 = y + 1", 0),
        ("x == y - 2", 1),
        ("x*y = -x", 8),
        ("0 = x*y", 6),
    ],
)
def test_signs_bind_as_in_python(text, value):
    assert evaluate(parse_polynomial(text, ["x", "y"], "file", "f"), [Fraction(2), Fraction(3)]) == value


def test_factors_stay_apart_where_the_other_side_is_zero():
    names = ["x", "y"]
    alone = parse_factors("(x - 1)*(y - 2)", names, "file", "f")
    assert alone == parse_factors("(x - 1)*(y - 2) = 0", names, "file", "f")
    assert alone == parse_factors("0 = (x - 1)*(y - 2)", names, "file", "f")


def test_a_sum_of_thousands_of_terms():
    text = "+".join(f"{k}*x**{k % 60}*y" for k in range(5000))
    found = parse_polynomial(text, ["x", "y"], "file", "f")
    assert len(found) == 60
    assert evaluate(found, [Fraction(1), Fraction(1)]) == 4999 * 2500


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "ends where"),
        ("   ", "ends where"),
        ("x +", "ends where"),
        ("x y", "operator such as * is missing before 'y'"),
        ("2x", "operator such as * is missing before 'x'"),
        ("1_000", "missing"),
        ("0x10", "missing"),
        ("(x", "closing parenthesis"),
        ("x)", "missing before ')'"),
        ("()", "')' stands where"),
        ("*x", "'*' stands where"),
        ("x // 2", "'/' stands where"),
        ("x % 2", "'%'"),
        ("x = 1 = y", "more than one '='"),
        ("x =", "ends where"),
        ("= x", "'=' stands where"),
        ("(x = 1)", "closing parenthesis"),
        ("x ** = 2", "'=' stands where"),
        ("x <= 1", "equations only; bounds stand with the variables"),
        ("x != 1", "equations only"),
        ("x; y", "';'"),
        ("sin(x)", "'sin' can't be called"),
        ("__import__('os').system('id')", "is not part of a polynomial"),
        ("x.real", "'.'"),
        ("x[0]", "'['"),
        ("lambda: 0", "':'"),
        ("[x for x in y]", "'['"),
        ("'x'", "not part of"),
        ("x if y else 1", "missing before 'if'"),
        ("1if x else y", "missing before 'if'"),
        ("True", "unknown variable 'True'"),
        ("1j", "missing before 'j'"),
        ("nan", "unknown variable 'nan'"),
        ("xx", "did you mean 'x'"),
        ("x\x00", "not part of"),
        ("x\u00b2", "not part of"),
        ("\uff58", "not part of"),
        ("x \u2212 1", "not part of"),
        ("\u0661 + x", "not part of"),
        ("x\u202e", "not part of"),
        ("\U0001f600", "not part of"),
        ("x/y", "division is by a number"),
        ("x/0", "division is by a number"),
        ("x/(1-1)", "division is by a number"),
        ("x**-1", "exponents are whole"),
        ("x**0.5", "exponents are whole"),
        ("x**y", "exponents are whole"),
        ("x**61", "exponents are whole"),
        ("9**9**9", "exponents are whole"),
        ("9**9**9**9**9", "exponents are whole"),
        ("x**" + "9" * 50, "exponents are whole"),
        ("x**" + "9" * 5000, "out of range"),
        ("(x**30)**3", "degree is above 60"),
        ("x**60*y", "degree is above 60"),
        ("((((9**60)**60)**60)**60)**60", "thousands of digits"),
        ("1e301", "out of range"),
        ("1e-301", "out of range"),
        ("1e999999999999", "out of range"),
        ("1e-999999999999*x", "out of range"),
        ("(x+y+1)**60*(x-y)**0*(x+y+1)**0", ""),
        ("(" * 200 + "x" + ")" * 200, "nested more than"),
        ("(" * 50_000, "nested more than"),
        ("x" + "**1" * 30_000, "nested more than"),
        ("x" * 100_001, "longer than"),
        ("y" * 10_000, "unknown variable"),
    ],
)  # fmt: skip
def test_what_is_no_polynomial_is_refused_in_one_line(text, says):
    if not says:  # the one that is large, and a polynomial
        assert len(parse_polynomial(text, ["x", "y"], "file", "f")) == 61 * 62 / 2
        return
    with pytest.raises(InputError) as caught:
        parse_polynomial(text, ["x", "y"], "file.json", "equations.7")
    message = str(caught.value)
    assert message.startswith("file.json: equations.7: ") and says in message
    assert message.isprintable() and len(message) < 250


def test_long_signs_are_no_nesting():
    assert parse_polynomial("-" * 50_001 + "x", ["x"], "file", "f") == {((0, 1),): -1}


def test_work_is_bounded(monkeypatch):
    monkeypatch.setattr("holdfast.solver.polynomial.parse._MAX_WORK", 20_000)
    with pytest.raises(InputError, match="too long to expand"):
        parse_polynomial("+".join(["(1+x+y)**19"] * 1000), ["x", "y"], "file", "f")


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.text(alphabet="xy01.e+-*/^() \n_[]'\"\\%#é²", max_size=30))
def test_any_text_is_a_polynomial_or_an_input_error(text):
    try:
        parse_polynomial(text, ["x", "y"], "file", "f")
    except InputError as error:
        assert str(error).isprintable()


def test_what_expands_to_too_many_terms_is_refused():
    with pytest.raises(InputError, match="terms"):
        parse_polynomial("(1+a+b+c+d+e+f)**20", "abcdef", "file", "f")


@pytest.mark.parametrize(
    ("text", "factors"),
    [
        ("(x-1)**2*(x+y)*3", ["x-1", "x+y"]),
        ("-x*y/2", ["x", "y"]),
        ("(x-1)*(2-2*x)", ["x-1"]),
        ("x*(x+1) + x", ["x**2+2*x"]),
        ("(x*(y-1))**3", ["x", "y-1"]),
        ("(x+1)**0*7", []),
        ("((x**60)**60)**60*(1**60)**60", ["x"]),
    ],
)  # fmt: skip
def test_factors_of_a_product_are_kept_apart_once_each(text, factors):
    product = parse_factors(text, ["x", "y"], "file", "f")
    assert [dict(factor) for factor in product] == [
        dict(parse_polynomial(factor, ["x", "y"], "file", "f")) for factor in factors
    ]


def test_a_product_with_zero_is_zero():
    assert parse_factors("0*(x-1)", ["x"], "file", "f").is_zero
    assert not parse_factors("x-1", ["x"], "file", "f").is_zero
