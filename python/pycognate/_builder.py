"""Models that a program makes: parts, joints, forces and motions by their names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import _core
from ._model import Law, Model
from ._words import Words

__all__ = ["Body", "Element", "Marker", "ModelBuilder"]

#: A place or direction in ground.
Vector = Sequence[float]


def _plain(value: Any, model: ModelBuilder) -> Any:
    """Return a value as the compiled half takes it: numbers, texts, lists, numbers of handles."""
    if isinstance(value, Element):
        if value._model is not model:
            raise ValueError("this statement belongs to another model")
        return value.number
    if isinstance(value, str):
        return value
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Sequence):
        return [_plain(each, model) for each in value]
    return value


def _vector(place: Vector) -> tuple[float, float, float]:
    x, y, z = (float(x) for x in place)
    return x, y, z


class Element:
    """A statement of a model that is being built.

    Prints as its number, so that expressions can name it: ``f"DX({a},{b})"``.
    """

    def __init__(self, model: ModelBuilder, core: _core.Statement) -> None:
        self._model = model
        self._core = core

    @property
    def number(self) -> int:
        """Number that stands for it in expressions and datasets; 0 of settings."""
        return self._core.number

    def set(self, keyword: str | None = None, value: Any = None, **arguments: Any) -> Any:
        """Give arguments of the statement their values, by their keywords.

        Parameters
        ----------
        keyword : str, optional
            An argument, for keywords that are no identifiers.
        value : number, str, Element or sequence of them, optional
            Its value. True: the argument stands alone, as ROTATIONAL does. A sequence of sequences:
            the rows of an argument that is given several times, as Y of SPLINE.
        **arguments
            The same, several at once: ``spring.set(K=100, C=1, LENGTH=0.5)``.

        Returns
        -------
        Element
            The statement itself.

        Notes
        -----
        ``cognate statements NAME`` tells the arguments, units and defaults. What does not fit is
        told by `ModelBuilder.build`, with all other mistakes.
        """
        given = dict(arguments) if keyword is None else {keyword: value, **arguments}
        for name, setting in given.items():
            if setting is True:
                self._model._core.flag(self._core, name)
                continue
            plain = _plain(setting, self._model)
            is_table = isinstance(plain, list) and len(plain) > 0 and isinstance(plain[0], list)
            rows = plain if is_table else [plain]
            for row in rows:
                self._model._core.set(self._core, name, row)
        return self

    def function(self, expression: str | float) -> Any:
        """Give FUNCTION as an expression of the function language.

        Parameters
        ----------
        expression : str or float
            The expression; handles print as their numbers.

        Returns
        -------
        Element
            The statement itself.
        """
        return self.set("FUNCTION", expression)

    def law(self, inputs: Sequence[str], law: Law) -> Any:
        """Give FUNCTION as a callable.

        Parameters
        ----------
        inputs : sequence of str
            Expressions whose values it is given.
        law : callable
            Called as ``law(time, constants, values)``, see `Model.user`.

        Returns
        -------
        Element
            The statement itself.
        """
        if isinstance(inputs, str):
            raise TypeError("inputs is a list of expressions, not one text")
        self._model._core.user(self._core)
        self._model._laws[self._core.element] = (tuple(inputs), law)
        return self

    def __str__(self) -> str:
        return str(self.number)

    def __repr__(self) -> str:
        return f"<{self._core.element or 'settings'}>"


class Marker(Element):
    """A MARKER."""

    def z(self, direction: Vector) -> Marker:
        """Turn it so that its z axis has a direction in ground: the axis of a joint.

        Parameters
        ----------
        direction : sequence of float
            The direction.

        Returns
        -------
        Marker
            The marker itself.
        """
        self._model._core.turn(self._core, _vector(direction), None)
        return self

    def axes(self, z: Vector, x: Vector) -> Marker:
        """Turn it: the direction of its z axis in ground, and one in the half plane of x.

        Parameters
        ----------
        z, x : sequence of float
            The directions.

        Returns
        -------
        Marker
            The marker itself.
        """
        self._model._core.turn(self._core, _vector(z), _vector(x))
        return self

    def named(self, name: str) -> Marker:
        """Name it.

        Parameters
        ----------
        name : str
            The name.

        Returns
        -------
        Marker
            The marker itself.
        """
        self._model._core.rename(self._core, name)
        return self


class Body(Element):
    """A PART or POINT_MASS."""

    def mass(self, mass: float) -> Body:
        """Set the mass.

        Parameters
        ----------
        mass : float
            The mass.

        Returns
        -------
        Body
            The body itself.
        """
        self.set(MASS=mass)
        return self

    def inertia(self, *moments: float) -> Body:
        """Set moments of inertia about the centre of mass, along ground axes.

        Parameters
        ----------
        *moments : float
            Ixx, Iyy, Izz, or these and the positive products ∫xy, ∫xz, ∫yz dm.

        Returns
        -------
        Body
            The body itself.
        """
        self.set(IP=[float(x) for x in moments])
        return self

    def center(self, place: Vector) -> Body:
        """Put the centre of mass at a place in ground.

        Parameters
        ----------
        place : sequence of float
            The place.

        Returns
        -------
        Body
            The body itself.
        """
        self.set(CM=self.at(place))
        return self

    def origin(self, place: Vector) -> Body:
        """Put the body's own frame at a place in ground; places given in ground stay.

        Parameters
        ----------
        place : sequence of float
            The place.

        Returns
        -------
        Body
            The body itself.
        """
        self.set(QG=list(_vector(place)))
        return self

    def at(self, place: Vector) -> Marker:
        """Make a marker fixed in the body, at a place in ground, with the axes of ground.

        Parameters
        ----------
        place : sequence of float
            The place.

        Returns
        -------
        Marker
            The marker, which `Marker.z` and `Marker.axes` turn.
        """
        return Marker(self._model, self._model._core.at(self._core, _vector(place)))


class ModelBuilder(Words):
    """A model that a program makes, a statement after the other in any order.

    Elements get numbers as they are made and keep their names in written datasets. Lengths, masses,
    forces and times are in one system of units, which `units` tells; angles are radians. Places are
    in ground coordinates, in the position in which the model is drawn. Mistakes are collected, and
    told all at once by `build`.

    Parameters
    ----------
    title : str
        First line of the dataset.

    Examples
    --------
    >>> import pycognate as cg
    >>> model = cg.ModelBuilder("pendulum").units("MKS").gravity(0, -9.81, 0)
    >>> rod = model.part("rod").mass(2).inertia(0, 0.2, 0.2).center([0.5, 0, 0])
    >>> hinge = model.revolute("hinge", rod.at([0, 0, 0]), model.ground)
    >>> tip = rod.at([1, 0, 0])
    >>> run = model.build().run(end=1.0, steps=10, columns=[f"DY({tip})"])
    >>> bool(run[f"DY({tip})"][5] < -0.5)
    True
    """

    def __init__(self, title: str) -> None:
        self._core = _core.Builder(title)
        self._laws: dict[str, tuple[tuple[str, ...], Law]] = {}

    def build(self) -> Model:
        """Make the model, with the callables that compute its laws.

        Returns
        -------
        Model
            The model, whose `Model.text` is its dataset.

        Raises
        ------
        ModelError
            Everything that is wrong, by the names of elements.
        """
        model = Model.from_text(self._core.build())
        model._user.update(self._laws)
        return model

    def units(self, system: str) -> ModelBuilder:
        """Tell the units of all numbers.

        Parameters
        ----------
        system : {"MKS", "MMKS", "CGS", "FPS", "IPS"}
            The system.

        Returns
        -------
        ModelBuilder
            The builder itself.
        """
        self.settings("UNITS").set(SYSTEM=system)
        return self

    def gravity(self, x: float, y: float, z: float) -> ModelBuilder:
        """Set the acceleration of gravity along ground x, y, z.

        Parameters
        ----------
        x, y, z : float
            Its components.

        Returns
        -------
        ModelBuilder
            The builder itself.
        """
        self.settings("ACCGRAV").set(IGRAV=x, JGRAV=y, KGRAV=z)
        return self

    @property
    def ground(self) -> Body:
        """The part that does not move, PART/1."""
        return Body(self, self._core.ground)

    def part(self, name: str) -> Body:
        """Add a rigid body.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        Body
            The body, whose frame is that of ground until `Body.origin` moves it.
        """
        return Body(self, self._core.element("PART", name))

    def point_mass(self, name: str) -> Body:
        """Add a body without extent, which does not turn.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        Body
            The body.
        """
        return Body(self, self._core.element("POINT_MASS", name))

    def _add(self, word: str, name: str, *ends: Body | Marker, **given: Any) -> Any:
        """Add the element of a word, with those arguments that are given."""
        if ends:
            i, j = ends
            core = self._core.add_between(word, name, i._core, j._core)
        else:
            core = self._core.add(word, name)
        keyword = core.element.split("/")[0]
        classes: dict[str, type[Element]] = {"PART": Body, "POINT_MASS": Body, "MARKER": Marker}
        element = classes.get(keyword, Element)(self, core)
        element.set(**{key: x for key, x in given.items() if x is not None and x is not False})
        return element

    def element(self, keyword: str, name: str = "", **arguments: Any) -> Element:
        """Add any statement with a number.

        Parameters
        ----------
        keyword : str
            Its keyword, ``"BUSHING"``.
        name : str
            Its name; may be empty.
        **arguments
            See `Element.set`.

        Returns
        -------
        Element
            The statement, with the next number of its kind.
        """
        element = Element(self, self._core.element(keyword, name))
        element.set(**arguments)
        return element

    def settings(self, keyword: str) -> Element:
        """Return the statement without a number that has this keyword.

        Parameters
        ----------
        keyword : str
            ``"INTEGRATOR"``, ``"ACCGRAV"``, ``"UNITS"`` and so on.

        Returns
        -------
        Element
            The statement, to be given arguments.
        """
        return Element(self, self._core.settings(keyword))

    def between(
        self, keyword: str, name: str, i: Body | Marker, j: Body | Marker, **arguments: Any
    ) -> Element:
        """Add any element with arguments I and J: joints, primitives, forces, bushings, beams.

        Parameters
        ----------
        keyword : str
            Its keyword.
        name : str
            Its name.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        **arguments
            See `Element.set`.

        Returns
        -------
        Element
            The element.
        """
        element = Element(self, self._core.between(keyword, name, i._core, j._core))
        element.set(**arguments)
        return element

    def joint(self, kind: str, name: str, i: Body | Marker, j: Body | Marker) -> Element:
        """Add a joint of any kind; its axis is z of the markers.

        Parameters
        ----------
        kind : str
            Its word in datasets: ``"UNIVERSAL"``.
        name : str
            Its name.
        i, j : Body or Marker
            Its ends.

        Returns
        -------
        Element
            The joint.
        """
        return self.between("JOINT", name, i, j, **{kind: True})

    def motion(
        self, name: str, joint: Element, expression: str | float, **arguments: Any
    ) -> Element:
        """Add a motion of a joint, as an expression of time.

        Parameters
        ----------
        name : str
            Its name.
        joint : Element
            The joint.
        expression : str or float
            An angle in radians of a joint that turns, else a length.
        **arguments
            Others of MOTION: ``VELOCITY=True``.

        Returns
        -------
        Element
            The motion.
        """
        return self.element("MOTION", name, JOINT=joint, FUNCTION=expression, **arguments)

    def force(self, name: str, i: Body | Marker, j: Body | Marker) -> Element:
        """Add a force along the line between two markers; positive pushes them apart.

        Parameters
        ----------
        name : str
            Its name.
        i, j : Body or Marker
            Its ends.

        Returns
        -------
        Element
            The force, to be given a `Element.function` or a `Element.law`.
        """
        return self.between("SFORCE", name, i, j, TRANSLATIONAL=True)

    def torque(self, name: str, i: Body | Marker, j: Body | Marker) -> Element:
        """Add a torque about the z axis of J; positive turns I forward.

        Parameters
        ----------
        name : str
            Its name.
        i, j : Body or Marker
            Its ends.

        Returns
        -------
        Element
            The torque, to be given a `Element.function` or a `Element.law`.
        """
        return self.between("SFORCE", name, i, j, ROTATIONAL=True)

    def spring(self, name: str, i: Body | Marker, j: Body | Marker, **arguments: Any) -> Element:
        """Add a spring with a damper along the line between two markers.

        Parameters
        ----------
        name : str
            Its name.
        i, j : Body or Marker
            Its ends.
        **arguments
            K, C, LENGTH and others of SPRINGDAMPER.

        Returns
        -------
        Element
            The spring.
        """
        return self.between("SPRINGDAMPER", name, i, j, TRANSLATIONAL=True, **arguments)

    def variable(self, name: str, expression: str | float) -> Element:
        """Add an algebraic variable: ``VARVAL`` of it in other expressions.

        Parameters
        ----------
        name : str
            Its name.
        expression : str or float
            Its value.

        Returns
        -------
        Element
            The variable.
        """
        return self.element("VARIABLE", name, FUNCTION=expression)

    def __repr__(self) -> str:
        return "<ModelBuilder>"
