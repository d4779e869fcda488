"""Every statement of the table has a method of the builder, and what it says is the table's."""

import inspect

import numpy as np
import pycognate as cg
import pytest
import words
from pycognate import _core


#: Methods that are written by hand.
BY_HAND = ("PART", "POINT_MASS", "JOINT", "MOTION", "VARIABLE")


def test_methods_are_those_of_the_table():
    told = "python python/tests/words.py writes them"
    assert words.PLACE.exists() and words.PLACE.read_text(encoding="utf-8") == words.written(), told


def test_every_word_is_a_method_with_the_arguments_of_its_statement():
    for word, _, has_ends, _, arguments in _core.words():
        method = getattr(cg.ModelBuilder, word.lower())
        takes = inspect.signature(method).parameters
        assert method.__doc__, word
        if word in BY_HAND:
            continue
        assert ("i" in takes) == has_ends
        assert [name for name in takes if name.isupper()] == [name for name, *_ in arguments]


def two_parts():
    model = cg.ModelBuilder("two").units("MKS")
    bodies = [model.part(name).mass(1).inertia(1, 1, 1) for name in ("a", "b")]
    for body in bodies:
        body.center([0, 0, 0])
    a, b = bodies
    return model, a, b, a.at([0, 0, 0]), b.at([0, 0, 0])


@pytest.mark.parametrize("word", [w for w, keyword, *_ in _core.words() if keyword == "JOINT" and w != "JOINT"])
def test_a_joint_of_every_type_is_written_and_holds(word):
    model, a, _, i, j = two_parts()
    given = {"SCREW": {"PITCH": 0.1}, "RACKPIN": {"PD": 0.5}}.get(word, {})
    if word == "UNIVERSAL":
        j.axes([1, 0, 0], [0, 1, 0])
    if word == "RACKPIN":  # the pinion turns about x of the rack, on its +y side
        i = a.at([0, -0.25, 0])
        j.axes([1, 0, 0], [0, 0, 1])
    getattr(model, word.lower())("it", i, j, **given)
    text = model.build().text
    assert "JOINT/1" in text and word in text.upper() and "'it'" in text


@pytest.mark.parametrize("word", [w for w, keyword, *_ in _core.words() if keyword == "JPRIM" and w != "JPRIM"])
def test_a_primitive_of_every_type_is_written(word):
    model, _, _, i, j = two_parts()
    if word == "PERPENDICULAR":
        j.axes([1, 0, 0], [0, 1, 0])
    getattr(model, word.lower())("it", i, j)
    assert word in model.build().text


def test_couplers_gears_motions_and_forces_refer_to_handles():
    model, a, b, i, j = two_parts()
    first = model.revolute("first", a.at([0, 0, 0]), model.ground)
    second = model.revolute("second", b.at([0, 0, 0]), model.ground)
    model.coupler("belt", JOINTS=[first, second], SCALES=[1, -2])
    model.motion("turn", first, "2*TIME")
    model.sforce("push", i, j, ROTATIONAL=True, FUNCTION="3")
    model.vforce("wind", I=i, JFLOAT=model.ground.at([0, 0, 0]), RM=i, FX="0", FY="0", FZ="1")
    model.bushing("rubber", i, j, K=np.full(3, 1.0), KT=[1] * 3)
    model.array("numbers", IC=True, SIZE=2, NUMBERS=[1, 2.5])
    model.spline("map", X=[0, 1, 2, 3], Y=[0, 1, 4, 9])
    built = model.build()
    assert {"COUPLER/1", "MOTION/1", "SFORCE/1", "VFORCE/1", "BUSHING/1", "SPLINE/1"} <= set(built.elements)
    run = built.run(end=1.0, steps=4, columns=["WZ(4)", "WZ(2)"])
    assert run.ok


def test_shapes_are_drawn_and_written():
    model, a, _, i, j = two_parts()
    model.box("block", CORNER=i, X=1, Y=2, Z=3)
    model.cylinder("rod", CM=i, LENGTH=1, RADIUS=0.1)
    model.ellipsoid("ball", CM=j, XSCALE=1, YSCALE=1, ZSCALE=1)
    model.plane("floor", RM=model.ground.at([0, 0, -1]))
    model.contact("touch", IGEOM=[3], JGEOM=[4], IMPACT=True, STIFFNESS=1e4, EXPONENT=1.5, DAMPING=1, DMAX=0.01)
    text = model.build().text
    assert all(shape in text for shape in ("BOX", "CYLINDER", "ELLIPSOID", "PLANE", "CONTACT/1"))


def test_rows_of_an_argument_that_is_repeated_are_a_list_of_lists():
    model = cg.ModelBuilder("surface").units("MKS")
    spline = model.spline("map", X=[0, 1, 2, 3])
    spline.set(Y=[[0, 0, 1, 2, 3], [1, 0, 2, 4, 6]])
    assert model.build().text.count("Y =") == 2


def test_a_word_that_is_none_is_told_with_near_ones():
    model = cg.ModelBuilder("none")
    with pytest.raises(ValueError, match="REVOLUTE"):
        model._add("REVOLUT", "it")
