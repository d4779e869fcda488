"""Expressions: values, gradients, kinds of arrays, mistakes, pickles, threads."""

import pickle
import threading

import pycognate as cg
import numpy as np
import pytest

BLEND = "STEP5(TIME, 0, 0, 1, 10)*SIN(2*PI*TIME)"
SPRING = "-25*(DM(10,20) - 10) - 2*VR(10,20)"


def test_a_number_gives_a_number():
    value = cg.expr(BLEND)(0.25)
    assert value == 1.03515625
    assert type(value) is float


def test_every_form_of_the_same_times_gives_the_same_values():
    f = cg.expr(BLEND)
    times = np.linspace(0, 2, 2001)
    values = f(times)
    each = np.array([f(float(t)) for t in times])
    np.testing.assert_array_equal(values, each)
    np.testing.assert_array_equal(f(list(times)), values)
    np.testing.assert_array_equal(f(times[::2]), values[::2])
    np.testing.assert_array_equal(f(times[::-1]), values[::-1])
    np.testing.assert_array_equal(f(times.reshape(3, 667).T), values.reshape(3, 667).T)
    np.testing.assert_array_equal(f(times.astype(">f8")), values)


def test_integers_and_booleans_are_numbers():
    f = cg.expr("TIME**2")
    np.testing.assert_array_equal(f([0, 1, 2]), [0.0, 1.0, 4.0])
    np.testing.assert_array_equal(f(np.arange(3, dtype=np.int8)), [0.0, 1.0, 4.0])
    np.testing.assert_array_equal(f(np.array([True, False])), [1.0, 0.0])
    assert f(3) == 9.0
    assert f(np.float64(3)) == 9.0
    assert f(np.array(3.0)) == 9.0


def test_shapes_follow_the_rules_of_numpy():
    spring = cg.expr(SPRING)
    assert spring({"DM(10, 20)": 12.0, "vr(10,20)": 0.5}) == -51.0
    grid = spring({"DM(10,20)": np.array([[10.0], [12.0]]), "VR(10,20)": [0.0, 0.5, 1.0]})
    np.testing.assert_array_equal(grid, [[0, -1, -2], [-50, -51, -52]])
    assert cg.expr("3")() == 3.0
    np.testing.assert_array_equal(cg.expr("3")(np.zeros((2, 2))), [[3, 3], [3, 3]])
    assert cg.expr("TIME")(np.zeros((0, 4))).shape == (0, 4)
    with pytest.raises(ValueError):
        spring({"DM(10,20)": [1.0, 2.0], "VR(10,20)": [1.0, 2.0, 3.0]})


def test_results_go_where_they_are_wanted():
    f = cg.expr("2*TIME")
    times = np.linspace(0, 1, 1000)
    out = np.empty(1000)
    assert f(times, out=out) is out
    np.testing.assert_array_equal(out, 2 * times)
    with pytest.raises(ValueError, match="shape"):
        f(times, out=np.empty(7))
    with pytest.raises(ValueError, match="shares"):
        f(times, out=times)
    with pytest.raises(TypeError, match="C order"):
        f(times, out=np.empty(2000)[::2])


def test_gradients_are_exact():
    assert cg.expr("TIME**3").gradient(2.0) == {"TIME": 12.0}
    spring = cg.expr(SPRING)
    slopes = spring.gradient({"DM(10,20)": [1.0, 2.0], "VR(10,20)": 0.0})
    assert list(slopes) == list(spring.inputs) == ["DM(10, 20)", "VR(10, 20)"]
    np.testing.assert_array_equal(slopes["DM(10, 20)"], [-25, -25])
    np.testing.assert_array_equal(slopes["VR(10, 20)"], [-2, -2])
    f, h = cg.expr(BLEND), 1e-6
    times = np.linspace(0.05, 0.95, 50)
    differences = (f(times + h) - f(times - h)) / (2 * h)
    np.testing.assert_allclose(f.gradient(times)["TIME"], differences, atol=1e-7)


@pytest.mark.parametrize(
    ("text", "code", "column", "advice"),
    [
        ("2*STPE(TIME, 1, 0, 2, 1)", "unknown_name", 3, "did you mean STEP?"),
        ("2*SQRT(TIME", "unexpected_end", 12, None),
        ("2^3", "bad_char", 2, "the power operator is **, as in 2**3"),
        ("1/0", "domain", 2, None),
    ],
)
def test_mistakes_have_code_column_and_advice(text, code, column, advice):
    with pytest.raises(cg.ExprError) as caught:
        cg.expr(text)
    error = caught.value
    assert (error.code, error.column) == (code, column)
    assert advice is None or advice in error.advice
    assert isinstance(error, ValueError) and isinstance(error, cg.Error)
    assert str(error).splitlines()[-1] == "  " + " " * (column - 1) + "^"
    again = pickle.loads(pickle.dumps(error))
    assert (again.errors, again.source, str(again)) == (error.errors, text, str(error))


def test_a_point_without_a_value_is_named_or_nan():
    f = cg.expr("LOG(TIME)")
    with pytest.raises(cg.ExprError, match="LOG of -1 has no value at TIME = -1") as caught:
        f(-1.0)
    assert caught.value.code == "domain"
    times = np.array([1.0, 2.0, 0.0, -1.0])
    with pytest.raises(cg.ExprError, match=r"point 2"):
        f(times)
    np.testing.assert_array_equal(np.isnan(f(times, invalid="nan")), [False, False, True, True])
    assert np.isnan(f(-1.0, invalid="nan"))
    for t in (np.nan, np.inf):
        with pytest.raises(cg.ExprError, match="finite"):
            cg.expr("IF(TIME: 1, 2, 3)")(t)
        assert np.isnan(cg.expr("MAX(TIME, 1)")(np.array([t]), invalid="nan")[0])
    with pytest.raises(ValueError, match="invalid"):
        f(1.0, invalid="ignore")
    with pytest.raises(cg.ExprError, match="derivative"):
        cg.expr("SQRT(TIME)").gradient(0.0)


def test_inputs_that_are_missing_wrong_or_given_twice_are_told():
    spring = cg.expr(SPRING)
    with pytest.raises(cg.ExprError, match=r"VR\(10, 20\) has not been given") as caught:
        spring({"DM(10,20)": 1.0})
    assert caught.value.code == "missing_value"
    with pytest.raises(cg.ExprError):
        spring({"DM(10,20": 1.0})
    with pytest.raises(cg.ExprError, match="there is no") as caught:
        spring({"DM(10,20)": 1.0, "VR(10,20)": 1.0}, y=2)
    assert "DM(10, 20); VR(10, 20)" in str(caught.value.advice)
    with pytest.raises(TypeError, match="twice"):
        cg.expr("TIME")(1.0, TIME=2.0)
    assert cg.expr("TIME")(TIME=2.0) == 2.0
    for nonsense in ("text", 1j, np.array([1j]), np.ma.masked_array([1.0], [True])):
        with pytest.raises((TypeError, ValueError)):
            cg.expr("TIME")(nonsense)
    with pytest.raises(cg.ExprError) as caught:
        cg.expr("DELAY(TIME, 0.1, 0)")
    assert caught.value.code == "needs_history"


def test_the_other_dialect_speaks_degrees():
    f = cg.expr("180*sin(360*t)", dialect="expression")
    assert f(0.25) == pytest.approx(180, abs=1e-12)
    assert f.dialect == "expression"
    assert eval(repr(f), {"Expr": cg.Expr}) == f
    with pytest.raises(ValueError, match="dialect"):
        cg.expr("1", dialect="german")


def test_doubts_are_told():
    assert cg.expr("SIN(90)").warnings[0].severity == "warning"
    assert cg.expr("SIN(TIME)").warnings == []


def test_expressions_pickle_compare_and_hash():
    f = cg.expr("180*sin(360*t)", dialect="expression")
    again = pickle.loads(pickle.dumps(f))
    assert again == f and hash(again) == hash(f) and again(0.1) == f(0.1)
    assert cg.expr("TIME") != cg.expr("2*TIME")
    assert type(f).__module__ == "pycognate"


def test_threads_share_an_expression():
    f = cg.expr(BLEND)
    times = np.linspace(0, 1, 100_000)
    wanted = f(times)
    found = []
    threads = [threading.Thread(target=lambda: found.append(f(times))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4
    for values in found:
        np.testing.assert_array_equal(values, wanted)


def test_functions_of_ones_own_are_formulas_or_callables():
    formula = {"hertz(x, k)": "k*MAX(x, 0)**1.5"}
    plain = {"hertz(x, k)": lambda x, k: k * max(x, 0) ** 1.5}
    slopes = lambda x, k: (1.5 * k * max(x, 0) ** 0.5, max(x, 0) ** 1.5)
    paired = {"hertz(x, k)": (plain["hertz(x, k)"], slopes)}
    x = np.linspace(0.5, 2.0, 700)
    for functions in (formula, plain, paired):
        f = cg.expr("hertz(2*x, c) - TIME", variables=["x"], constants={"c": 3}, functions=functions)
        assert f.inputs == ("x", "TIME")
        assert f(1.0, x=0.5) == 2.0
        np.testing.assert_allclose(f(1.0, X=x), 3 * (2 * x) ** 1.5 - 1, rtol=1e-15)
        if functions is plain:
            with pytest.raises(cg.ExprError, match="derivatives of hertz are not known"):
                f.gradient(1.0, x=0.5)
        else:
            np.testing.assert_allclose(f.gradient(1.0, x=x)["x"], 9 * (2 * x) ** 0.5, rtol=1e-14)
    f = cg.expr("hertz(x, 2)", variables=["x"], functions=formula)
    assert pickle.loads(pickle.dumps(f)) == f != cg.expr("TIME")
    assert pickle.loads(pickle.dumps(f))(x=4.0) == 16.0


def test_what_a_function_raises_is_raised():
    def law(x):
        if x > 1:
            raise RuntimeError("too far")
        return x

    f = cg.expr("1 + law(x)", variables=["x"], functions={"law(x)": law})
    assert f(x=0.5) == 1.5
    for x in (2.0, np.linspace(0, 2, 600), [0.5, 1.5]):
        with pytest.raises(RuntimeError, match="too far"):
            f(x=x)
    assert f(x=1.0) == 2.0
    with pytest.raises(cg.ExprError, match="TIME would hide"):
        cg.expr("x", variables=["x", "TIME"])
    with pytest.raises(cg.ExprError) as caught:
        cg.expr("speet", variables=["speed"])
    assert "did you mean speed?" in str(caught.value)
    with pytest.raises(ValueError, match="as in"):
        cg.expr("f(1)", functions={"f": law})
