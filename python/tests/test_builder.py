"""Models made by a program: the same as the dataset that they are written as; mistakes by name."""

import math

import pycognate as cg
import numpy as np
import pytest


def pendulum():
    model = cg.ModelBuilder("pendulum").units("MKS").gravity(0, -9.81, 0)
    rod = model.part("rod").mass(2).inertia(0, 0.2, 0.2).center([0.5, 0, 0])
    return model, rod


def test_a_pendulum_keeps_its_energy_and_its_names():
    model, rod = pendulum()
    model.revolute("hinge", rod.at([0, 0, 0]), model.ground)
    tip = rod.at([1, 0, 0])
    built = model.build()
    assert built.names["JOINT/1"] == "hinge" and built.names["PART/2"] == "rod"
    height, speed = f"DY({tip})", f"WZ({tip})"
    run = built.run(end=2.0, steps=100, columns=[height, speed], error=1e-9)
    energy = 0.5 * (0.2 + 2 * 0.25) * run[speed] ** 2 + 2 * 9.81 * 0.5 * run[height]
    np.testing.assert_allclose(energy, 0, atol=1e-6)
    again = cg.Model.from_text(built.text).run(end=2.0, steps=100, columns=[height], error=1e-9)
    np.testing.assert_array_equal(again[height], run[height])


def test_a_four_bar_closes_with_markers_where_they_are_said():
    model = cg.ModelBuilder("four bar").units("MKS")
    a, b, c, d = [0, 0, 0], [0, 1, 0], [3, 2, 0], [4, 0, 0]
    bars = [model.part(name).mass(1).inertia(1, 1, 1) for name in ("crank", "coupler", "rocker")]
    for bar, (p, q) in zip(bars, [(a, b), (b, c), (d, c)]):
        bar.center([(x + y) / 2 for x, y in zip(p, q)]).origin(p)
    crank, coupler, rocker = bars
    drive = model.revolute("A", crank.at(a), model.ground)
    model.revolute("B", coupler.at(b), crank)
    model.revolute("C", rocker.at(c), coupler)
    model.revolute("D", rocker.at(d), model.ground)
    model.motion("turn", drive, "TIME")
    pin, fixed = rocker.at(c).named("pin"), model.ground.at(d)
    run = model.build().run(end=1.0, steps=10, columns=[f"DM({pin},{fixed})"])
    np.testing.assert_allclose(run[f"DM({pin},{fixed})"], math.hypot(1, 2), rtol=1e-9)


def test_a_law_is_a_callable_and_goes_with_the_model():
    model = cg.Model.builder("a mass on a spring").units("MKS")
    mass = model.part("mass").mass(4).inertia(1, 1, 1).center([0, 0, 1.5])
    i, j = mass.at([0, 0, 1.5]), model.ground.at([0, 0, 0])
    model.translational("guide", i, model.ground)
    force = model.force("spring", i, j)
    force.law([f"DM({i},{j})"], lambda time, constants, values: -100 * (values[0] - 1))
    column = f"DZ({i},{j})"
    run = model.build().run(end=1.0, steps=20, columns=[column], error=1e-8)
    np.testing.assert_allclose(run[column], 1 + 0.5 * np.cos(5 * run.time), atol=1e-5)


def test_every_statement_is_reachable_and_values_may_be_anything():
    model, rod = pendulum()
    i, j = rod.at([0, 0, 0]).z([1, 0, 0]), model.ground.at([0, 0, 0]).axes([1, 0, 0], [0, 1, 0])
    model.between("BUSHING", "rubber", i, j, K=np.full(3, 1e4), C=[10] * 3, KT=(9, 9, 9), CT=[1] * 3)
    model.spring("coil", i, j, K=10, C=1, LENGTH=0.1)
    model.element("ARRAY", "numbers", IC=True, SIZE=2, NUMBERS=[1, 2.5])
    model.settings("INTEGRATOR").set(ERROR=1e-7)
    text = model.build().text
    assert all(word in text for word in ["BUSHING/1", "10000", "SPRINGDAMPER/1", "ARRAY/1", "INTEGRATOR"])


def test_all_mistakes_are_told_at_once_by_name():
    model = cg.ModelBuilder("mistakes")
    wheel = model.part("wheel").mass(math.nan)
    model.revolute("axle", wheel, model.ground)
    model.spring("coil", wheel.at([0, 0, 0]), model.ground, STIFFNESS=3)
    with pytest.raises(cg.ModelError) as caught:
        model.build()
    said = str(caught.value)
    assert len(caught.value.errors) >= 3
    assert "MASS is NaN" in said and "'wheel'" in said and "STIFFNESS" in said
    other, _ = pendulum()
    with pytest.raises(ValueError, match="another model"):
        other.revolute("hinge", model.part("more").at([0, 0, 0]), other.ground)
    with pytest.raises(ValueError, match="another model"):
        other.part("more").set(CM=model.part("more").at([0, 0, 0]))
    with pytest.raises(ValueError, match="WHEELS"):
        model.element("WHEELS")
    with pytest.raises(TypeError, match="list of expressions"):
        model.variable("v", 0).law("TIME", lambda time, constants, values: 0.0)
