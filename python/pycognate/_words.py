"""Elements by their words, a method each: made from the table of statements by tests/words.py."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._builder import Body, Element, Marker

    Numbers = Sequence[float] | NDArray[Any]

__all__ = ["Words"]


class Words:
    """Adds elements by their words: statements, and types of JOINT, JPRIM and GRAPHICS."""

    def _add(self, word: str, name: str, *ends: Body | Marker, **given: Any) -> Any:
        raise NotImplementedError

    def marker(
        self,
        name: str,
        *,
        PART: Element | int | None = None,
        POINT_MASS: Element | int | None = None,
        FLOATING: bool = False,
        QP: Numbers | None = None,
        ZP: Numbers | None = None,
        XP: Numbers | None = None,
        USEXP: bool = False,
        REULER: Numbers | None = None,
    ) -> Marker:
        """Add a MARKER.

        A frame fixed in a part: where joints, forces and requests attach.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        PART : Element | int, optional
            The part in which the marker is fixed. Default: the part before it.
        POINT_MASS : Element | int, optional
            The point mass in which the marker is fixed.
        FLOATING : bool, optional
            It is moved by the one element that names it.
        QP : Numbers [length], optional
            Origin, in the frame of its part. Default: 0, 0, 0.
        ZP : Numbers [length], optional
            A point on the +z axis, in the frame of its part.
        XP : Numbers [length], optional
            A point in the half plane of the +x axis, in the frame of its part.
        USEXP : bool, optional
            XP lies on the +x axis exactly, and ZP only in the half plane of +z.
        REULER : Numbers [rad], optional
            Orientation by the angles psi, theta, phi about z, the new x, the new z. Default: 0,
            0, 0.

        Returns
        -------
        Marker
            The element.
        """
        made: Marker = self._add(
            "MARKER",
            name,
            PART=PART,
            POINT_MASS=POINT_MASS,
            FLOATING=FLOATING,
            QP=QP,
            ZP=ZP,
            XP=XP,
            USEXP=USEXP,
            REULER=REULER,
        )
        return made

    def fixed(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, FIXED.

        I and J move as one.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "FIXED",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def revolute(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, REVOLUTE.

        A hinge: I turns about z of J.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "REVOLUTE",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def translational(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, TRANSLATIONAL.

        A slide: I moves along z of J without turning.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "TRANSLATIONAL",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def cylindrical(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, CYLINDRICAL.

        A pin in a bore: I slides along z of J and turns about it.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "CYLINDRICAL",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def spherical(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, SPHERICAL.

        A ball: the origins coincide, all turns are free.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "SPHERICAL",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def planar(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, PLANAR.

        I stays in the x-y plane of J and turns about its z.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "PLANAR",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def universal(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, UNIVERSAL.

        A universal joint whose pins are the z axes of the two markers.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "UNIVERSAL",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def hooke(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, HOOKE.

        A universal joint whose shafts are the z axes; its pins are x of I and y of J.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "HOOKE",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def convel(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
    ) -> Element:
        """Add a JOINT, CONVEL.

        A joint of constant velocity between two shafts along the z axes.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "CONVEL",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
        )
        return made

    def rackpin(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
        PD: float | None = None,
    ) -> Element:
        """Add a JOINT, RACKPIN.

        A pinion (I, axis z_I parallel to x_J) rolls on a rack along z of J. Needs PD; other
        joints hold the pinion at its height.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).
        PD : float [length], optional
            RACKPIN: diameter of the pitch circle; positive puts the pinion's centre on the +y
            side of the rack. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "RACKPIN",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
            PD=PD,
        )
        return made

    def screw(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        IC: Numbers | None = None,
        ICTRAN: Numbers | None = None,
        ICROT: Numbers | None = None,
        PITCH: float | None = None,
    ) -> Element:
        """Add a JOINT, SCREW.

        I advances along z of J as it turns. Needs PITCH; other joints keep the axes in line.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        IC : Numbers [length or rad, over time], optional
            Displacement, velocity of REVOLUTE or TRANSLATIONAL at the start; velocity first in
            datasets that Adams View wrote, which is told.
        ICTRAN : Numbers [length, length/time], optional
            The same for the translation of CYLINDRICAL (or TRANSLATIONAL).
        ICROT : Numbers [rad, rad/time], optional
            The same for the rotation of CYLINDRICAL (or REVOLUTE).
        PITCH : float [length per turn], optional
            SCREW: advance of I along z_J in a full turn; positive is a right-hand thread.
            Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "SCREW",
            name,
            i,
            j,
            IC=IC,
            ICTRAN=ICTRAN,
            ICROT=ICROT,
            PITCH=PITCH,
        )
        return made

    def jprim(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        ATPOINT: bool = False,
        INLINE: bool = False,
        INPLANE: bool = False,
        ORIENTATION: bool = False,
        PARALLEL_AXES: bool = False,
        PERPENDICULAR: bool = False,
    ) -> Element:
        """Add a JPRIM.

        A primitive constraint between two markers; joints are sums of these.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        ATPOINT : bool
            The origins of I and J coincide.
        INLINE : bool
            The origin of I stays on the z axis of J.
        INPLANE : bool
            The origin of I stays in the x-y plane of J.
        ORIENTATION : bool
            All axes of I stay parallel to those of J.
        PARALLEL_AXES : bool
            The z axes stay parallel and point the same way.
        PERPENDICULAR : bool
            The z axes stay square to each other.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "JPRIM",
            name,
            i,
            j,
            ATPOINT=ATPOINT,
            INLINE=INLINE,
            INPLANE=INPLANE,
            ORIENTATION=ORIENTATION,
            PARALLEL_AXES=PARALLEL_AXES,
            PERPENDICULAR=PERPENDICULAR,
        )
        return made

    def atpoint(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
    ) -> Element:
        """Add a JPRIM, ATPOINT.

        The origins of I and J coincide.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "ATPOINT",
            name,
            i,
            j,
        )
        return made

    def inline(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
    ) -> Element:
        """Add a JPRIM, INLINE.

        The origin of I stays on the z axis of J.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "INLINE",
            name,
            i,
            j,
        )
        return made

    def inplane(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
    ) -> Element:
        """Add a JPRIM, INPLANE.

        The origin of I stays in the x-y plane of J.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "INPLANE",
            name,
            i,
            j,
        )
        return made

    def orientation(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
    ) -> Element:
        """Add a JPRIM, ORIENTATION.

        All axes of I stay parallel to those of J.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "ORIENTATION",
            name,
            i,
            j,
        )
        return made

    def parallel_axes(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
    ) -> Element:
        """Add a JPRIM, PARALLEL_AXES.

        The z axes stay parallel and point the same way.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "PARALLEL_AXES",
            name,
            i,
            j,
        )
        return made

    def perpendicular(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
    ) -> Element:
        """Add a JPRIM, PERPENDICULAR.

        The z axes stay square to each other.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "PERPENDICULAR",
            name,
            i,
            j,
        )
        return made

    def coupler(
        self,
        name: str,
        *,
        JOINTS: Sequence[Element | int] | None = None,
        TYPE: str | None = None,
        SCALES: Numbers | None = None,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a COUPLER.

        Two or three joint displacements whose weighted sum stays constant.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        JOINTS : Sequence[Element | int]
            Two or three REVOLUTE, TRANSLATIONAL or CYLINDRICAL joints.
        TYPE : str, optional
            T (translation) or R (rotation) for each joint, between colons: needed for CYLINDRICAL
            joints.
        SCALES : Numbers, optional
            r1, r2 and r3; with one number fewer than joints r1 is 1. Default: 1 for the first.
        FUNCTION : str | float, optional
            USER(…): what is zero instead of the sum is computed by a routine, COUSUB.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "COUPLER",
            name,
            JOINTS=JOINTS,
            TYPE=TYPE,
            SCALES=SCALES,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def gear(
        self,
        name: str,
        *,
        JOINTS: Sequence[Element | int] | None = None,
        CV: Element | int | None = None,
    ) -> Element:
        """Add a GEAR.

        A pair of gears: two joints on one carrier whose bodies have a common velocity at the
        pitch point.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        JOINTS : Sequence[Element | int]
            The two joints, REVOLUTE, TRANSLATIONAL or CYLINDRICAL, whose J markers stand on the
            carrier.
        CV : Element | int
            Marker of the carrier at the pitch point; its z axis points along the common velocity.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "GEAR",
            name,
            JOINTS=JOINTS,
            CV=CV,
        )
        return made

    def gcon(
        self,
        name: str,
        *,
        I: Element | int | None = None,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a GCON.

        An equation of your own that stays zero: of places, or of velocities as rolling is.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        I : Element | int, optional
            Marker on whose part the reaction is told.
        FUNCTION : str | float
            The expression that stays zero.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "GCON",
            name,
            I=I,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def ptcv(
        self,
        name: str,
        *,
        I: Element | int | None = None,
        JFLOAT: Element | int | None = None,
        RM: Element | int | None = None,
        CURVE: Element | int | None = None,
        DISP: Numbers | None = None,
        VEL: float | None = None,
        ICM: Element | int | None = None,
    ) -> Element:
        """Add a PTCV.

        A point stays on a curve: a pin in a slot, a knife-edge follower on a cam.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        I : Element | int
            Marker whose origin stays on the curve.
        JFLOAT : Element | int, optional
            FLOATING marker on the part of RM, at the touch: x along the curve, y away from its
            centre of curvature.
        RM : Element | int
            Marker in whose frame the points of the curve are given.
        CURVE : Element | int
            The curve.
        DISP : Numbers [length], optional
            Where on the curve to start: a point, in the frame of ICM. Default: the nearest point.
        VEL : float [length/time], optional
            Velocity along the curve at the start. Default: free.
        ICM : Element | int, optional
            Marker in whose frame DISP is given. Default: RM.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "PTCV",
            name,
            I=I,
            JFLOAT=JFLOAT,
            RM=RM,
            CURVE=CURVE,
            DISP=DISP,
            VEL=VEL,
            ICM=ICM,
        )
        return made

    def cvcv(
        self,
        name: str,
        *,
        ICURVE: Element | int | None = None,
        IRM: Element | int | None = None,
        IFLOAT: Element | int | None = None,
        JCURVE: Element | int | None = None,
        JRM: Element | int | None = None,
        JFLOAT: Element | int | None = None,
        IDISP: Numbers | None = None,
        IICM: Element | int | None = None,
        IVEL: float | None = None,
        JDISP: Numbers | None = None,
        JICM: Element | int | None = None,
        JVEL: float | None = None,
    ) -> Element:
        """Add a CVCV.

        Two plane curves touch: a cam with a flat or round follower.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        ICURVE : Element | int
            The curve on the part of I.
        IRM : Element | int
            Marker in whose frame ICURVE is given.
        IFLOAT : Element | int, optional
            FLOATING marker on the part of IRM, at the touch: x along the curve, z that of IRM.
        JCURVE : Element | int
            The curve on the part of J.
        JRM : Element | int
            Marker in whose frame JCURVE is given.
        JFLOAT : Element | int, optional
            FLOATING marker on the part of JRM, at the touch.
        IDISP : Numbers [length], optional
            Where on ICURVE to start, in the frame of IICM. Default: the nearest point.
        IICM : Element | int, optional
            Marker in whose frame IDISP is given. Default: IRM.
        IVEL : float [length/time], optional
            Velocity along ICURVE at the start. Default: free.
        JDISP : Numbers [length], optional
            Where on JCURVE to start, in the frame of JICM. Default: the nearest point.
        JICM : Element | int, optional
            Marker in whose frame JDISP is given. Default: JRM.
        JVEL : float [length/time], optional
            Velocity along JCURVE at the start. Default: free.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "CVCV",
            name,
            ICURVE=ICURVE,
            IRM=IRM,
            IFLOAT=IFLOAT,
            JCURVE=JCURVE,
            JRM=JRM,
            JFLOAT=JFLOAT,
            IDISP=IDISP,
            IICM=IICM,
            IVEL=IVEL,
            JDISP=JDISP,
            JICM=JICM,
            JVEL=JVEL,
        )
        return made

    def sforce(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        TRANSLATIONAL: bool = False,
        ROTATIONAL: bool = False,
        ACTIONONLY: bool = False,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add an SFORCE.

        A force along the line between two markers, or a torque about an axis, as an expression.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        TRANSLATIONAL : bool
            A force along a line.
        ROTATIONAL : bool
            A torque about z of J; the z axes should stay parallel.
        ACTIONONLY : bool, optional
            Only I is acted on, and the force is along z of J.
        FUNCTION : str | float [force or torque]
            The force or torque, e, as an expression of time, displacements, velocities and other
            elements.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "SFORCE",
            name,
            i,
            j,
            TRANSLATIONAL=TRANSLATIONAL,
            ROTATIONAL=ROTATIONAL,
            ACTIONONLY=ACTIONONLY,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def vforce(
        self,
        name: str,
        *,
        I: Element | int | None = None,
        JFLOAT: Element | int | None = None,
        RM: Element | int | None = None,
        FX: str | float | None = None,
        FY: str | float | None = None,
        FZ: str | float | None = None,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a VFORCE.

        A force by its three components.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        I : Element | int
            The I marker: the element acts on its part.
        JFLOAT : Element | int, optional
            FLOATING marker: its part feels the reaction, at the origin of I.
        RM : Element | int, optional
            Marker along whose axes the components are. Default: ground.
        FX : str | float [force], optional
            Force along x of RM. Default: 0.
        FY : str | float [force], optional
            Force along y of RM. Default: 0.
        FZ : str | float [force], optional
            Force along z of RM. Default: 0.
        FUNCTION : str | float, optional
            USER(…): all components by a routine.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "VFORCE",
            name,
            I=I,
            JFLOAT=JFLOAT,
            RM=RM,
            FX=FX,
            FY=FY,
            FZ=FZ,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def vtorque(
        self,
        name: str,
        *,
        I: Element | int | None = None,
        JFLOAT: Element | int | None = None,
        RM: Element | int | None = None,
        TX: str | float | None = None,
        TY: str | float | None = None,
        TZ: str | float | None = None,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a VTORQUE.

        A torque by its three components.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        I : Element | int
            The I marker: the element acts on its part.
        JFLOAT : Element | int, optional
            FLOATING marker: its part feels the reaction, at the origin of I.
        RM : Element | int, optional
            Marker along whose axes the components are. Default: ground.
        TX : str | float [torque], optional
            Torque about x of RM. Default: 0.
        TY : str | float [torque], optional
            Torque about y of RM. Default: 0.
        TZ : str | float [torque], optional
            Torque about z of RM. Default: 0.
        FUNCTION : str | float, optional
            USER(…): all components by a routine.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "VTORQUE",
            name,
            I=I,
            JFLOAT=JFLOAT,
            RM=RM,
            TX=TX,
            TY=TY,
            TZ=TZ,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def gforce(
        self,
        name: str,
        *,
        I: Element | int | None = None,
        JFLOAT: Element | int | None = None,
        RM: Element | int | None = None,
        FX: str | float | None = None,
        FY: str | float | None = None,
        FZ: str | float | None = None,
        TX: str | float | None = None,
        TY: str | float | None = None,
        TZ: str | float | None = None,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a GFORCE.

        A force and a torque by their six components.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        I : Element | int
            The I marker: the element acts on its part.
        JFLOAT : Element | int, optional
            FLOATING marker: its part feels the reaction, at the origin of I.
        RM : Element | int, optional
            Marker along whose axes the components are. Default: ground.
        FX : str | float [force], optional
            Force along x of RM. Default: 0.
        FY : str | float [force], optional
            Force along y of RM. Default: 0.
        FZ : str | float [force], optional
            Force along z of RM. Default: 0.
        TX : str | float [torque], optional
            Torque about x of RM. Default: 0.
        TY : str | float [torque], optional
            Torque about y of RM. Default: 0.
        TZ : str | float [torque], optional
            Torque about z of RM. Default: 0.
        FUNCTION : str | float, optional
            USER(…): all components by a routine.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "GFORCE",
            name,
            I=I,
            JFLOAT=JFLOAT,
            RM=RM,
            FX=FX,
            FY=FY,
            FZ=FZ,
            TX=TX,
            TY=TY,
            TZ=TZ,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def springdamper(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        TRANSLATIONAL: bool = False,
        ROTATIONAL: bool = False,
        C: float | None = None,
        K: float | None = None,
        FORCE: float | None = None,
        LENGTH: float | None = None,
        CT: float | None = None,
        KT: float | None = None,
        TORQUE: float | None = None,
        ANGLE: float | None = None,
    ) -> Element:
        """Add a SPRINGDAMPER.

        A linear spring and damper between two markers, along their line or about an axis.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        TRANSLATIONAL : bool
            Along the line between I and J.
        ROTATIONAL : bool
            About z of J.
        C : float [force*time/length], optional
            Damping along the line. Default: 0.
        K : float [force/length], optional
            Stiffness along the line. Default: 0.
        FORCE : float [force], optional
            Force at LENGTH. Default: 0.
        LENGTH : float [length], optional
            Distance at which the force is FORCE. Default: 0.
        CT : float [torque*time/rad], optional
            Damping about z. Default: 0.
        KT : float [torque/rad], optional
            Stiffness about z. Default: 0.
        TORQUE : float [torque], optional
            Torque at ANGLE. Default: 0.
        ANGLE : float [rad], optional
            Angle at which the torque is TORQUE. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "SPRINGDAMPER",
            name,
            i,
            j,
            TRANSLATIONAL=TRANSLATIONAL,
            ROTATIONAL=ROTATIONAL,
            C=C,
            K=K,
            FORCE=FORCE,
            LENGTH=LENGTH,
            CT=CT,
            KT=KT,
            TORQUE=TORQUE,
            ANGLE=ANGLE,
        )
        return made

    def bushing(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        C: Numbers | None = None,
        K: Numbers | None = None,
        FORCE: Numbers | None = None,
        CT: Numbers | None = None,
        KT: Numbers | None = None,
        TORQUE: Numbers | None = None,
    ) -> Element:
        """Add a BUSHING.

        Six springs with dampers between two markers: a rubber mount.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        C : Numbers [force*time/length], optional
            Damping along x, y, z of J. Default: 0, 0, 0.
        K : Numbers [force/length], optional
            Stiffness along x, y, z of J. Default: 0, 0, 0.
        FORCE : Numbers [force], optional
            Force where I and J coincide. Default: 0, 0, 0.
        CT : Numbers [torque*time/rad], optional
            Damping about x, y, z of J. Default: 0, 0, 0.
        KT : Numbers [torque/rad], optional
            Stiffness about x, y, z of J. Default: 0, 0, 0.
        TORQUE : Numbers [torque], optional
            Torque where the axes coincide. Default: 0, 0, 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "BUSHING",
            name,
            i,
            j,
            C=C,
            K=K,
            FORCE=FORCE,
            CT=CT,
            KT=KT,
            TORQUE=TORQUE,
        )
        return made

    def field(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        CMATRIX: Numbers | None = None,
        CRATIO: float | None = None,
        KMATRIX: Numbers | None = None,
        FORCE: Numbers | None = None,
        LENGTH: Numbers | None = None,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a FIELD.

        Six forces from six displacements by full matrices.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        CMATRIX : Numbers [force*time/length … torque*time/rad], optional
            Damping: 36 numbers by columns. Default: 0.
        CRATIO : float [time], optional
            Damping as a multiple of the stiffness, instead of CMATRIX. Default: 0.
        KMATRIX : Numbers [force/length … torque/rad], optional
            Stiffness: 36 numbers by columns. Default: 0.
        FORCE : Numbers [force, torque], optional
            Six forces and torques at LENGTH. Default: 0.
        LENGTH : Numbers [length, rad], optional
            Six displacements at which the law gives FORCE. Default: 0.
        FUNCTION : str | float, optional
            USER(…): the six components by a routine.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "FIELD",
            name,
            i,
            j,
            CMATRIX=CMATRIX,
            CRATIO=CRATIO,
            KMATRIX=KMATRIX,
            FORCE=FORCE,
            LENGTH=LENGTH,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def beam(
        self,
        name: str,
        i: Body | Marker,
        j: Body | Marker,
        *,
        LENGTH: float | None = None,
        IXX: float | None = None,
        IYY: float | None = None,
        IZZ: float | None = None,
        AREA: float | None = None,
        ASY: float | None = None,
        ASZ: float | None = None,
        EMODULUS: float | None = None,
        GMODULUS: float | None = None,
        CRATIO: float | None = None,
        CMATRIX: Numbers | None = None,
        FORMULATION: str | None = None,
    ) -> Element:
        """Add a BEAM.

        A massless uniform beam between two markers, with shear (Timoshenko).

        Parameters
        ----------
        name : str
            Its name; may be empty.
        i, j : Body or Marker
            Its ends; a body gets a marker where the other end is.
        LENGTH : float [length]
            Undeflected length.
        IXX : float [length^4], optional
            Torsion constant. Default: 0.
        IYY : float [length^4], optional
            Second moment of area about y. Default: 0.
        IZZ : float [length^4], optional
            Second moment of area about z. Default: 0.
        AREA : float [length^2], optional
            Area of the section. Default: 0.
        ASY : float, optional
            Shear factor for deflection along y; 0 is no shear. Default: 0.
        ASZ : float, optional
            Shear factor for deflection along z. Default: 0.
        EMODULUS : float [force/length^2], optional
            Young's modulus. Default: 0.
        GMODULUS : float [force/length^2], optional
            Shear modulus. Default: 0.
        CRATIO : float [time], optional
            Damping as a multiple of the stiffness. Default: 0.01.
        CMATRIX : Numbers [force*time/length … torque*time/rad], optional
            Damping instead of CRATIO: 21 numbers, the lower triangle by rows.
        FORMULATION : str, optional
            STRING and NONLINEAR are solved as LINEAR, which is told. Default: LINEAR.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "BEAM",
            name,
            i,
            j,
            LENGTH=LENGTH,
            IXX=IXX,
            IYY=IYY,
            IZZ=IZZ,
            AREA=AREA,
            ASY=ASY,
            ASZ=ASZ,
            EMODULUS=EMODULUS,
            GMODULUS=GMODULUS,
            CRATIO=CRATIO,
            CMATRIX=CMATRIX,
            FORMULATION=FORMULATION,
        )
        return made

    def nforce(
        self,
        name: str,
        *,
        IMARKERS: Sequence[Element | int] | None = None,
        J: Element | int | None = None,
        KMATRIX: Element | int | None = None,
        LENGTH: Element | int | None = None,
        FORCE: Element | int | None = None,
        CMATRIX: Element | int | None = None,
        CRATIO: float | None = None,
    ) -> Element:
        """Add an NFORCE.

        The linear law of FIELD for many markers at once: the stiffness matrix of a structure.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        IMARKERS : Sequence[Element | int]
            The I markers, in the order of the matrix.
        J : Element | int
            Marker from which all displacements are measured; its part feels the reactions.
        KMATRIX : Element | int
            MATRIX of the stiffness, 6n by 6n.
        LENGTH : Element | int, optional
            MATRIX of the displacements at which the law gives FORCE, 6n numbers. Default: 0.
        FORCE : Element | int, optional
            MATRIX of the preloads, 6n numbers. Default: 0.
        CMATRIX : Element | int, optional
            MATRIX of the damping, 6n by 6n. Default: 0.
        CRATIO : float [time], optional
            Damping as a multiple of the stiffness. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "NFORCE",
            name,
            IMARKERS=IMARKERS,
            J=J,
            KMATRIX=KMATRIX,
            LENGTH=LENGTH,
            FORCE=FORCE,
            CMATRIX=CMATRIX,
            CRATIO=CRATIO,
        )
        return made

    def contact(
        self,
        name: str,
        *,
        IGEOM: Sequence[Element | int] | None = None,
        JGEOM: Sequence[Element | int] | None = None,
        IMPACT: bool = False,
        POISSON: bool = False,
        STIFFNESS: float | None = None,
        DAMPING: float | None = None,
        DMAX: float | None = None,
        EXPONENT: float | None = None,
        PENALTY: float | None = None,
        RESTITUTION_COEFFICIENT: float | None = None,
        COULOMB_FRICTION: str | None = None,
        MU_STATIC: float | None = None,
        MU_DYNAMIC: float | None = None,
        STICTION_TRANSITION_VELOCITY: float | None = None,
        FRICTION_TRANSITION_VELOCITY: float | None = None,
        IFLIP: bool = False,
        JFLIP: bool = False,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
        FRICTION_FUNCTION: str | float | None = None,
        FRICTION_ROUTINE: str | None = None,
    ) -> Element:
        """Add a CONTACT.

        Forces where shapes touch: a stiff spring along the normal, and friction across it.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        IGEOM : Sequence[Element | int]
            GRAPHICS on one side; the shapes of one list all touch those of the other.
        JGEOM : Sequence[Element | int]
            GRAPHICS on the other side.
        IMPACT : bool, optional
            The law IMPACT. Default: holds when no law is given.
        POISSON : bool, optional
            The law with a coefficient of restitution.
        STIFFNESS : float [force/length^EXPONENT], optional
            IMPACT: force at a depth of one. Usual for steel in N and mm: 1E5.
        DAMPING : float [force*time/length], optional
            IMPACT: largest damping. Usual: a ten-thousandth of STIFFNESS. Default: 0.
        DMAX : float [length], optional
            IMPACT: depth at which the damping is fully there. Needed with DAMPING; usual in mm:
            0.1.
        EXPONENT : float, optional
            IMPACT: 1 linear, 1.5 sphere after Hertz, 2.2 usual for steel.
        PENALTY : float [force/length], optional
            POISSON: stiffness.
        RESTITUTION_COEFFICIENT : float, optional
            POISSON: speed after over speed before, 0 to 1. Default: 0.
        COULOMB_FRICTION : str, optional
            ON, or DYNAMICS_ONLY: not in statics. Default: OFF.
        MU_STATIC : float, optional
            Coefficient at STICTION_TRANSITION_VELOCITY. Default: 0.
        MU_DYNAMIC : float, optional
            Coefficient beyond FRICTION_TRANSITION_VELOCITY. Default: 0.
        STICTION_TRANSITION_VELOCITY : float [length/time], optional
            Slip speed of the largest coefficient. Below it friction is a steep damper: bodies at
            rest creep.
        FRICTION_TRANSITION_VELOCITY : float [length/time], optional
            Slip speed from which on the coefficient is MU_DYNAMIC.
        IFLIP : bool, optional
            The outside of the I curves is their inside; not for solids.
        JFLIP : bool, optional
            The outside of the J curves is their inside; not for solids.
        FUNCTION : str | float, optional
            USER(…): the normal force by a routine, CNFSUB.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.
        FRICTION_FUNCTION : str | float, optional
            USER(…): the friction force by a routine, CFFSUB.
        FRICTION_ROUTINE : str, optional
            Library and entry of that routine, as library::entry.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "CONTACT",
            name,
            IGEOM=IGEOM,
            JGEOM=JGEOM,
            IMPACT=IMPACT,
            POISSON=POISSON,
            STIFFNESS=STIFFNESS,
            DAMPING=DAMPING,
            DMAX=DMAX,
            EXPONENT=EXPONENT,
            PENALTY=PENALTY,
            RESTITUTION_COEFFICIENT=RESTITUTION_COEFFICIENT,
            COULOMB_FRICTION=COULOMB_FRICTION,
            MU_STATIC=MU_STATIC,
            MU_DYNAMIC=MU_DYNAMIC,
            STICTION_TRANSITION_VELOCITY=STICTION_TRANSITION_VELOCITY,
            FRICTION_TRANSITION_VELOCITY=FRICTION_TRANSITION_VELOCITY,
            IFLIP=IFLIP,
            JFLIP=JFLIP,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
            FRICTION_FUNCTION=FRICTION_FUNCTION,
            FRICTION_ROUTINE=FRICTION_ROUTINE,
        )
        return made

    def friction(
        self,
        name: str,
        *,
        JOINT: Element | int | None = None,
        MU_STATIC: float | None = None,
        MU_DYNAMIC: float | None = None,
        STICTION_TRANSITION_VELOCITY: float | None = None,
        MAX_STICTION_DEFORMATION: float | None = None,
        EFFECT: str | None = None,
        INPUTS: str | None = None,
        FRICTION_FORCE_PRELOAD: float | None = None,
        FRICTION_TORQUE_PRELOAD: float | None = None,
        FRICTION_ARM: float | None = None,
        BENDING_REACTION_ARM: float | None = None,
        PIN_RADIUS: float | None = None,
        BALL_RADIUS: float | None = None,
        INITIAL_OVERLAP: float | None = None,
        REACTION_ARM: float | None = None,
        OVERLAP_DELTA: str | None = None,
        INACTIVE: str | None = None,
        FORMULATION: str | None = None,
    ) -> Element:
        """Add a FRICTION.

        Coulomb friction with stiction in a joint.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        JOINT : Element | int
            The joint that is braked.
        MU_STATIC : float, optional
            Coefficient while the surfaces stick. Default: 0.
        MU_DYNAMIC : float, optional
            Coefficient while they slide. Default: 0.
        STICTION_TRANSITION_VELOCITY : float [length/time], optional
            Speed of the surfaces below which they can stick. Default: 0.1.
        MAX_STICTION_DEFORMATION : float [length], optional
            Largest creep while they stick. Default: 0.01.
        EFFECT : str, optional
            STICTION or SLIDING alone. Default: ALL.
        INPUTS : str, optional
            Which parts of the reaction press: PRELOAD, REACTION_FORCE, BENDING_MOMENT,
            TORSIONAL_MOMENT between colons, or NONE. Default: ALL.
        FRICTION_FORCE_PRELOAD : float [force], optional
            Friction force that is there without any reaction. Default: 0.
        FRICTION_TORQUE_PRELOAD : float [torque], optional
            Friction torque that is there without any reaction. Default: 0.
        FRICTION_ARM : float [length], optional
            Arm of the force along the axis of a revolute joint. Default: 1.
        BENDING_REACTION_ARM : float [length], optional
            Distance between the bearings that carry the bending moment. Default: 1.
        PIN_RADIUS : float [length], optional
            Radius of the pin. Default: 1.
        BALL_RADIUS : float [length], optional
            Radius of the ball of a spherical joint. Default: 1.
        INITIAL_OVERLAP : float [length], optional
            Overlap of the slide in its bearing where the joint is at zero. Default: 1000.
        REACTION_ARM : float [length], optional
            Arm at which a slide carries the torsional moment. Default: 1.
        OVERLAP_DELTA : str, optional
            The overlap may INCREASE or DECREASE with the displacement. Default: CONSTANT.
        INACTIVE : str, optional
            STATIC says that there is to be no friction in statics, as is the case anyway, without
            a warning. Default: NEVER.
        FORMULATION : str, optional
            LUGRE is solved by the law above, which is told. Default: ORIGINAL.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "FRICTION",
            name,
            JOINT=JOINT,
            MU_STATIC=MU_STATIC,
            MU_DYNAMIC=MU_DYNAMIC,
            STICTION_TRANSITION_VELOCITY=STICTION_TRANSITION_VELOCITY,
            MAX_STICTION_DEFORMATION=MAX_STICTION_DEFORMATION,
            EFFECT=EFFECT,
            INPUTS=INPUTS,
            FRICTION_FORCE_PRELOAD=FRICTION_FORCE_PRELOAD,
            FRICTION_TORQUE_PRELOAD=FRICTION_TORQUE_PRELOAD,
            FRICTION_ARM=FRICTION_ARM,
            BENDING_REACTION_ARM=BENDING_REACTION_ARM,
            PIN_RADIUS=PIN_RADIUS,
            BALL_RADIUS=BALL_RADIUS,
            INITIAL_OVERLAP=INITIAL_OVERLAP,
            REACTION_ARM=REACTION_ARM,
            OVERLAP_DELTA=OVERLAP_DELTA,
            INACTIVE=INACTIVE,
            FORMULATION=FORMULATION,
        )
        return made

    def diff(
        self,
        name: str,
        *,
        IC: Numbers | None = None,
        STATIC_HOLD: bool = False,
        IMPLICIT: bool = False,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a DIFF.

        A differential equation of first order of your own, which functions read as DIF(id) and
        DIF1(id).

        Parameters
        ----------
        name : str
            Its name; may be empty.
        IC : Numbers, optional
            Value at the start, and as a second number the guess of its rate. Default: 0.
        STATIC_HOLD : bool, optional
            The states keep their values in statics; without it their rates are zero there.
        IMPLICIT : bool, optional
            FUNCTION stays zero instead of being the rate.
        FUNCTION : str | float
            The rate, or what stays zero.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "DIFF",
            name,
            IC=IC,
            STATIC_HOLD=STATIC_HOLD,
            IMPLICIT=IMPLICIT,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def lse(
        self,
        name: str,
        *,
        X: Element | int | None = None,
        IC: Element | int | None = None,
        U: Element | int | None = None,
        Y: Element | int | None = None,
        A: Element | int | None = None,
        B: Element | int | None = None,
        C: Element | int | None = None,
        D: Element | int | None = None,
        STATIC_HOLD: bool = False,
    ) -> Element:
        """Add an LSE.

        A linear system of differential equations.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        X : Element | int
            ARRAY of the states.
        IC : Element | int, optional
            ARRAY of the states at the start. Default: zeros.
        U : Element | int, optional
            ARRAY of the inputs.
        Y : Element | int, optional
            ARRAY of the outputs.
        A : Element | int
            MATRIX, states by states.
        B : Element | int, optional
            MATRIX, states by inputs. Default: zero.
        C : Element | int, optional
            MATRIX, outputs by states. Default: zero.
        D : Element | int, optional
            MATRIX, outputs by inputs. Default: zero.
        STATIC_HOLD : bool, optional
            The states keep their values in statics; without it their rates are zero there.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "LSE",
            name,
            X=X,
            IC=IC,
            U=U,
            Y=Y,
            A=A,
            B=B,
            C=C,
            D=D,
            STATIC_HOLD=STATIC_HOLD,
        )
        return made

    def tfsiso(
        self,
        name: str,
        *,
        X: Element | int | None = None,
        U: Element | int | None = None,
        Y: Element | int | None = None,
        NUMERATOR: Numbers | None = None,
        DENOMINATOR: Numbers | None = None,
        STATIC_HOLD: bool = False,
    ) -> Element:
        """Add a TFSISO.

        A transfer function of one input and one output.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        X : Element | int
            ARRAY of the states.
        U : Element | int
            ARRAY of the one input.
        Y : Element | int
            ARRAY of the one output.
        NUMERATOR : Numbers
            Coefficients b0, b1, b2 …, lowest power first.
        DENOMINATOR : Numbers
            Coefficients a0, a1, a2 …, lowest power first.
        STATIC_HOLD : bool, optional
            The states keep their values in statics; without it their rates are zero there.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "TFSISO",
            name,
            X=X,
            U=U,
            Y=Y,
            NUMERATOR=NUMERATOR,
            DENOMINATOR=DENOMINATOR,
            STATIC_HOLD=STATIC_HOLD,
        )
        return made

    def gse(
        self,
        name: str,
        *,
        NS: Element | int | None = None,
        NO: Element | int | None = None,
        X: Element | int | None = None,
        U: Element | int | None = None,
        Y: Element | int | None = None,
        IC: Element | int | None = None,
        XD: Element | int | None = None,
        ND: Element | int | None = None,
        ICD: Element | int | None = None,
        SAMPLE_PERIOD: str | float | None = None,
        STATIC_HOLD: bool = False,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a GSE.

        A system of equations computed by routines: continuous and sampled states, and outputs.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        NS : Element | int, optional
            Number of continuous states. Default: 0.
        NO : Element | int, optional
            Number of outputs. Default: 0.
        X : Element | int, optional
            ARRAY of the states.
        U : Element | int, optional
            ARRAY of the inputs.
        Y : Element | int, optional
            ARRAY of the outputs.
        IC : Element | int, optional
            ARRAY of the continuous states at the start. Default: zeros.
        XD : Element | int, optional
            ARRAY of the discrete states.
        ND : Element | int, optional
            Number of discrete states. Default: 0.
        ICD : Element | int, optional
            ARRAY of the discrete states at the start. Default: zeros.
        SAMPLE_PERIOD : str | float [time], optional
            Time between samples, an expression.
        STATIC_HOLD : bool, optional
            The states keep their values in statics; without it their rates are zero there.
        FUNCTION : str | float, optional
            USER(…): the numbers that are passed to the routines.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "GSE",
            name,
            NS=NS,
            NO=NO,
            X=X,
            U=U,
            Y=Y,
            IC=IC,
            XD=XD,
            ND=ND,
            ICD=ICD,
            SAMPLE_PERIOD=SAMPLE_PERIOD,
            STATIC_HOLD=STATIC_HOLD,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def pinput(
        self,
        name: str,
        *,
        VARIABLES: Sequence[Element | int] | None = None,
    ) -> Element:
        """Add a PINPUT.

        The inputs of the model as a plant, for LINEAR and for co-simulation.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        VARIABLES : Sequence[Element | int]
            Numbers of the VARIABLEs, in order.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "PINPUT",
            name,
            VARIABLES=VARIABLES,
        )
        return made

    def poutput(
        self,
        name: str,
        *,
        VARIABLES: Sequence[Element | int] | None = None,
    ) -> Element:
        """Add a POUTPUT.

        The outputs of the model as a plant, for LINEAR and for co-simulation.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        VARIABLES : Sequence[Element | int]
            Numbers of the VARIABLEs, in order.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "POUTPUT",
            name,
            VARIABLES=VARIABLES,
        )
        return made

    def sensor(
        self,
        name: str,
        *,
        VALUE: float | None = None,
        EQ: bool = False,
        GE: bool = False,
        LE: bool = False,
        ERROR: float | None = None,
        ANGULAR: bool = False,
        HALT: bool = False,
        RETURN: bool = False,
        PRINT: bool = False,
        DT: float | None = None,
        STEPSIZE: float | None = None,
        RESTART: bool = False,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
        EVALUATE: str | float | None = None,
    ) -> Element:
        """Add a SENSOR.

        Watches an expression and acts when it reaches a value.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        VALUE : float
            The value that is waited for; radians with ANGULAR.
        EQ : bool, optional
            Acts when the expression passes VALUE. Default: holds when none is given.
        GE : bool, optional
            Acts when the expression becomes larger.
        LE : bool, optional
            Acts when the expression becomes smaller.
        ERROR : float [as FUNCTION], optional
            Within this of VALUE it counts as reached. Default: 1E-3.
        ANGULAR : bool, optional
            Angles: whole turns do not count.
        HALT : bool, optional
            Ends the run.
        RETURN : bool, optional
            Ends this simulation; the next command goes on.
        PRINT : bool, optional
            Writes a row of results at the instant.
        DT : float [time], optional
            Distance of output times from there on.
        STEPSIZE : float [time], optional
            First step of the integration from there on.
        RESTART : bool, optional
            Begins the integration anew.
        FUNCTION : str | float
            The expression that is watched.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.
        EVALUATE : str | float, optional
            Its value at the instant is SENVAL(id) from there on.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "SENSOR",
            name,
            VALUE=VALUE,
            EQ=EQ,
            GE=GE,
            LE=LE,
            ERROR=ERROR,
            ANGULAR=ANGULAR,
            HALT=HALT,
            RETURN=RETURN,
            PRINT=PRINT,
            DT=DT,
            STEPSIZE=STEPSIZE,
            RESTART=RESTART,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
            EVALUATE=EVALUATE,
        )
        return made

    def array(
        self,
        name: str,
        *,
        IC: bool = False,
        X: bool = False,
        Y: bool = False,
        U: bool = False,
        SIZE: Element | int | None = None,
        NUMBERS: Numbers | None = None,
        VARIABLES: Sequence[Element | int] | None = None,
    ) -> Element:
        """Add an ARRAY.

        A list of numbers: constants, or inputs, states and outputs of a system.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        IC : bool
            Constants, in NUMBERS.
        X : bool
            States of the LSE, TFSISO or GSE that names it.
        Y : bool
            Outputs of the system that names it.
        U : bool
            Values of the VARIABLES.
        SIZE : Element | int, optional
            Number of entries. Default: from the system.
        NUMBERS : Numbers, optional
            IC: the constants.
        VARIABLES : Sequence[Element | int], optional
            U: numbers of the VARIABLEs.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "ARRAY",
            name,
            IC=IC,
            X=X,
            Y=Y,
            U=U,
            SIZE=SIZE,
            NUMBERS=NUMBERS,
            VARIABLES=VARIABLES,
        )
        return made

    def curve(
        self,
        name: str,
        *,
        OPEN: bool = False,
        CLOSED: bool = False,
        ORDER: Element | int | None = None,
        MATRIX: Element | int | None = None,
        CURVE_POINTS: bool = False,
        CONTROL_POINTS: bool = False,
        MINPAR: float | None = None,
        MAXPAR: float | None = None,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a CURVE.

        A B-spline through points, or near them: the path or profile of a cam.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        OPEN : bool, optional
            The curve has two ends. Default: holds when CLOSED is not given.
        CLOSED : bool, optional
            The end meets the beginning: the last point equals the first.
        ORDER : Element | int, optional
            One more than the degree of the pieces: 4 cubic, 2 straight lines. Default: 4.
        MATRIX : Element | int, optional
            The MATRIX with a row x, y, z for each point; at least four.
        CURVE_POINTS : bool, optional
            The points lie on the curve.
        CONTROL_POINTS : bool, optional
            The points are control points, which the curve follows without touching. Default:
            holds when CURVE_POINTS is not given.
        MINPAR : float, optional
            Least parameter of a curve that a routine computes. Default: -1.
        MAXPAR : float, optional
            Largest parameter of a curve that a routine computes. Default: 1.
        FUNCTION : str | float, optional
            USER(…): a routine computes the curve. Such a curve cannot be touched.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "CURVE",
            name,
            OPEN=OPEN,
            CLOSED=CLOSED,
            ORDER=ORDER,
            MATRIX=MATRIX,
            CURVE_POINTS=CURVE_POINTS,
            CONTROL_POINTS=CONTROL_POINTS,
            MINPAR=MINPAR,
            MAXPAR=MAXPAR,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def spline(
        self,
        name: str,
        *,
        X: Numbers | None = None,
        Y: Numbers | Sequence[Numbers] | None = None,
        LINEAR_EXTRAPOLATE: bool = False,
    ) -> Element:
        """Add a SPLINE.

        A curve, or a family of curves, through data; read by AKISPL, CUBSPL and INTERP.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        X : Numbers, optional
            Abscissae, increasing; at least four.
        Y : Numbers, optional, several rows
            Ordinates, as many as abscissae; in a surface led by the z of the curve.
        LINEAR_EXTRAPOLATE : bool, optional
            Straight beyond the first and last X. Default: parabolic.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "SPLINE",
            name,
            X=X,
            Y=Y,
            LINEAR_EXTRAPOLATE=LINEAR_EXTRAPOLATE,
        )
        return made

    def string(
        self,
        name: str,
        *,
        STRING: str | None = None,
    ) -> Element:
        """Add a STRING.

        A text that routines read.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        STRING : str
            The text, up to the end of the line.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "STRING",
            name,
            STRING=STRING,
        )
        return made

    def matrix(
        self,
        name: str,
        *,
        FULL: str | None = None,
        SPARSE: bool = False,
        ROWS: Element | int | None = None,
        COLUMNS: Element | int | None = None,
        I: Sequence[Element | int] | None = None,
        J: Sequence[Element | int] | None = None,
        VALUES: Numbers | None = None,
    ) -> Element:
        """Add a MATRIX.

        Numbers in rows and columns: points of a CURVE, matrices of LSE and NFORCE.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        FULL : str, optional
            All numbers are given: by rows (RORDER) or by columns (CORDER).
        SPARSE : bool, optional
            Only some entries are given; the others are zero.
        ROWS : Element | int, optional
            Number of rows.
        COLUMNS : Element | int, optional
            Number of columns.
        I : Sequence[Element | int], optional
            SPARSE: row of each value, from 1 on.
        J : Sequence[Element | int], optional
            SPARSE: column of each value, from 1 on.
        VALUES : Numbers, optional
            The numbers.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "MATRIX",
            name,
            FULL=FULL,
            SPARSE=SPARSE,
            ROWS=ROWS,
            COLUMNS=COLUMNS,
            I=I,
            J=J,
            VALUES=VALUES,
        )
        return made

    def request(
        self,
        name: str,
        *,
        DISPLACEMENT: bool = False,
        VELOCITY: bool = False,
        ACCELERATION: bool = False,
        FORCE: bool = False,
        I: Element | int | None = None,
        J: Element | int | None = None,
        RM: Element | int | None = None,
        COMMENT: str | None = None,
        TITLE: str | None = None,
        CUNITS: Sequence[str] | None = None,
        CNAMES: Sequence[str] | None = None,
        CLABELS: Sequence[str] | None = None,
        RESULTS_NAME: str | None = None,
        F1: str | float | None = None,
        F2: str | float | None = None,
        F3: str | float | None = None,
        F4: str | float | None = None,
        F5: str | float | None = None,
        F6: str | float | None = None,
        F7: str | float | None = None,
        F8: str | float | None = None,
        FUNCTION: str | float | None = None,
        ROUTINE: str | None = None,
    ) -> Element:
        """Add a REQUEST.

        Up to eight columns among the results.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        DISPLACEMENT : bool, optional
            Displacement and orientation of I from J.
        VELOCITY : bool, optional
            Velocity and angular velocity of I against J, as differences of what ground sees.
        ACCELERATION : bool, optional
            Acceleration and angular acceleration of I against J.
        FORCE : bool, optional
            Force and torque on I of the elements between I and J.
        I : Element | int, optional
            The I marker.
        J : Element | int, optional
            The J marker. Default: origin of ground.
        RM : Element | int, optional
            Marker along whose axes the components are. Default: ground.
        COMMENT : str, optional
            A text about the request.
        TITLE : str, optional
            Headings of the eight components, between colons.
        CUNITS : Sequence[str], optional
            Units of the eight components, in double quotes.
        CNAMES : Sequence[str], optional
            Names of the eight components, in double quotes.
        CLABELS : Sequence[str], optional
            Labels of the eight components for plots, in double quotes.
        RESULTS_NAME : str, optional
            Name of the request among the results.
        F1 : str | float, optional
            First component, an expression.
        F2 : str | float, optional
            Second component, an expression.
        F3 : str | float, optional
            Third component, an expression.
        F4 : str | float, optional
            Fourth component, an expression.
        F5 : str | float, optional
            Fifth component, an expression.
        F6 : str | float, optional
            Sixth component, an expression.
        F7 : str | float, optional
            Seventh component, an expression.
        F8 : str | float, optional
            Eighth component, an expression.
        FUNCTION : str | float, optional
            USER(…): the components by a routine.
        ROUTINE : str, optional
            Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run
            --routines` loads libraries that have it; programs register closures.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "REQUEST",
            name,
            DISPLACEMENT=DISPLACEMENT,
            VELOCITY=VELOCITY,
            ACCELERATION=ACCELERATION,
            FORCE=FORCE,
            I=I,
            J=J,
            RM=RM,
            COMMENT=COMMENT,
            TITLE=TITLE,
            CUNITS=CUNITS,
            CNAMES=CNAMES,
            CLABELS=CLABELS,
            RESULTS_NAME=RESULTS_NAME,
            F1=F1,
            F2=F2,
            F3=F3,
            F4=F4,
            F5=F5,
            F6=F6,
            F7=F7,
            F8=F8,
            FUNCTION=FUNCTION,
            ROUTINE=ROUTINE,
        )
        return made

    def mrequest(
        self,
        name: str,
        *,
        DISPLACEMENT: bool = False,
        VELOCITY: bool = False,
        ACCELERATION: bool = False,
        FORCE: bool = False,
        PARTS: str | None = None,
        JOINTS: str | None = None,
        JPRIMS: str | None = None,
        APPFORS: str | None = None,
        RM: Element | int | None = None,
        COMMENT: str | None = None,
    ) -> Element:
        """Add an MREQUEST.

        The same quantity of many elements at once.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        DISPLACEMENT : bool
            Displacement and orientation of I from J.
        VELOCITY : bool
            Velocity and angular velocity of I against J, as differences of what ground sees.
        ACCELERATION : bool
            Acceleration and angular acceleration of I against J.
        FORCE : bool
            Force and torque on I of the elements between I and J.
        PARTS : str, optional
            Parts that are asked.
        JOINTS : str, optional
            Joints that are asked.
        JPRIMS : str, optional
            Primitives that are asked.
        APPFORS : str, optional
            Forces that are asked.
        RM : Element | int, optional
            Marker along whose axes the components are. Default: ground.
        COMMENT : str, optional
            A text about the request.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "MREQUEST",
            name,
            DISPLACEMENT=DISPLACEMENT,
            VELOCITY=VELOCITY,
            ACCELERATION=ACCELERATION,
            FORCE=FORCE,
            PARTS=PARTS,
            JOINTS=JOINTS,
            JPRIMS=JPRIMS,
            APPFORS=APPFORS,
            RM=RM,
            COMMENT=COMMENT,
        )
        return made

    def graphics(
        self,
        name: str,
        *,
        BOX: bool = False,
        CYLINDER: bool = False,
        FRUSTUM: bool = False,
        ELLIPSOID: bool = False,
        TORUS: bool = False,
        PLANE: bool = False,
        CIRCLE: bool = False,
        POINT: bool = False,
        CURVE: bool = False,
        ARC: bool = False,
        SHELL: bool = False,
        CORNER: Element | int | None = None,
        CM: Sequence[Element | int] | None = None,
        RM: Element | int | None = None,
        CID: Element | int | None = None,
        CRM: Element | int | None = None,
        X: float | None = None,
        Y: float | None = None,
        Z: float | None = None,
        XSCALE: float | None = None,
        YSCALE: float | None = None,
        ZSCALE: float | None = None,
        LENGTH: float | None = None,
        TOP: float | None = None,
        BOTTOM: float | None = None,
        RADIUS: float | None = None,
        MAJOR_RADIUS: float | None = None,
        MINOR_RADIUS: float | None = None,
        XMIN: float | None = None,
        XMAX: float | None = None,
        YMIN: float | None = None,
        YMAX: float | None = None,
        FILE: str | None = None,
        RANGLE: float | None = None,
    ) -> Element:
        """Add a GRAPHICS.

        A shape fixed to a marker: for contact, and to be drawn.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        BOX : bool
            A block from the marker CORNER.
        CYLINDER : bool
            A cylinder from CM along its z.
        FRUSTUM : bool
            A cone without its tip, from CM along its z.
        ELLIPSOID : bool
            An ellipsoid about CM.
        TORUS : bool
            A ring about z of CM.
        PLANE : bool
            The x-y plane of RM.
        CIRCLE : bool
            A circle about z of CM.
        POINT : bool
            The origin of RM.
        CURVE : bool
            A plane CURVE.
        ARC : bool
            A part of a circle about z of CM.
        SHELL : bool
            Triangles in a file; in contacts their convex hull.
        CORNER : Element | int, optional
            BOX: the marker at a corner.
        CM : Sequence[Element | int], optional
            CYLINDER, FRUSTUM, ELLIPSOID, TORUS, CIRCLE, ARC: the marker at the centre, or at the
            middle of the bottom.
        RM : Element | int, optional
            PLANE, POINT, SHELL, EXTERNAL: the marker in whose frame it stands.
        CID : Element | int, optional
            CURVE: the CURVE.
        CRM : Element | int, optional
            CURVE: the marker in whose frame its points are.
        X : float [length], optional
            BOX: extent along x of CORNER, signed. Default: 0.
        Y : float [length], optional
            BOX: extent along y of CORNER, signed. Default: 0.
        Z : float [length], optional
            BOX: extent along z of CORNER, signed. Default: 0.
        XSCALE : float [length], optional
            ELLIPSOID: diameter along x. Default: 0.
        YSCALE : float [length], optional
            ELLIPSOID: diameter along y. Default: 0.
        ZSCALE : float [length], optional
            ELLIPSOID: diameter along z. Default: 0.
        LENGTH : float [length], optional
            CYLINDER, FRUSTUM: length along z of CM. Default: 0.
        TOP : float [length], optional
            FRUSTUM: radius at the far end. Default: 0.
        BOTTOM : float [length], optional
            FRUSTUM: radius at CM. Default: 0.
        RADIUS : float [length], optional
            CYLINDER, CIRCLE, ARC: radius. Default: 0.
        MAJOR_RADIUS : float [length], optional
            TORUS: radius of the circle in the middle of the tube. Default: 0.
        MINOR_RADIUS : float [length], optional
            TORUS: radius of the tube. Default: 0.
        XMIN : float [length], optional
            PLANE: least x; beyond its bounds nothing touches it. Default: no bound.
        XMAX : float [length], optional
            PLANE: largest x. Default: no bound.
        YMIN : float [length], optional
            PLANE: least y. Default: no bound.
        YMAX : float [length], optional
            PLANE: largest y. Default: no bound.
        FILE : str, optional
            SHELL, EXTERNAL: the file, beside the dataset.
        RANGLE : float [rad], optional
            ARC: angle that it covers, from x of CM on. Default: 360D.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "GRAPHICS",
            name,
            BOX=BOX,
            CYLINDER=CYLINDER,
            FRUSTUM=FRUSTUM,
            ELLIPSOID=ELLIPSOID,
            TORUS=TORUS,
            PLANE=PLANE,
            CIRCLE=CIRCLE,
            POINT=POINT,
            CURVE=CURVE,
            ARC=ARC,
            SHELL=SHELL,
            CORNER=CORNER,
            CM=CM,
            RM=RM,
            CID=CID,
            CRM=CRM,
            X=X,
            Y=Y,
            Z=Z,
            XSCALE=XSCALE,
            YSCALE=YSCALE,
            ZSCALE=ZSCALE,
            LENGTH=LENGTH,
            TOP=TOP,
            BOTTOM=BOTTOM,
            RADIUS=RADIUS,
            MAJOR_RADIUS=MAJOR_RADIUS,
            MINOR_RADIUS=MINOR_RADIUS,
            XMIN=XMIN,
            XMAX=XMAX,
            YMIN=YMIN,
            YMAX=YMAX,
            FILE=FILE,
            RANGLE=RANGLE,
        )
        return made

    def box(
        self,
        name: str,
        *,
        CORNER: Element | int | None = None,
        X: float | None = None,
        Y: float | None = None,
        Z: float | None = None,
    ) -> Element:
        """Add a GRAPHICS, BOX.

        A block from the marker CORNER.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        CORNER : Element | int, optional
            BOX: the marker at a corner.
        X : float [length], optional
            BOX: extent along x of CORNER, signed. Default: 0.
        Y : float [length], optional
            BOX: extent along y of CORNER, signed. Default: 0.
        Z : float [length], optional
            BOX: extent along z of CORNER, signed. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "BOX",
            name,
            CORNER=CORNER,
            X=X,
            Y=Y,
            Z=Z,
        )
        return made

    def cylinder(
        self,
        name: str,
        *,
        CM: Sequence[Element | int] | None = None,
        LENGTH: float | None = None,
        RADIUS: float | None = None,
    ) -> Element:
        """Add a GRAPHICS, CYLINDER.

        A cylinder from CM along its z.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        CM : Sequence[Element | int], optional
            CYLINDER, FRUSTUM, ELLIPSOID, TORUS, CIRCLE, ARC: the marker at the centre, or at the
            middle of the bottom.
        LENGTH : float [length], optional
            CYLINDER, FRUSTUM: length along z of CM. Default: 0.
        RADIUS : float [length], optional
            CYLINDER, CIRCLE, ARC: radius. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "CYLINDER",
            name,
            CM=CM,
            LENGTH=LENGTH,
            RADIUS=RADIUS,
        )
        return made

    def frustum(
        self,
        name: str,
        *,
        CM: Sequence[Element | int] | None = None,
        LENGTH: float | None = None,
        TOP: float | None = None,
        BOTTOM: float | None = None,
    ) -> Element:
        """Add a GRAPHICS, FRUSTUM.

        A cone without its tip, from CM along its z.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        CM : Sequence[Element | int], optional
            CYLINDER, FRUSTUM, ELLIPSOID, TORUS, CIRCLE, ARC: the marker at the centre, or at the
            middle of the bottom.
        LENGTH : float [length], optional
            CYLINDER, FRUSTUM: length along z of CM. Default: 0.
        TOP : float [length], optional
            FRUSTUM: radius at the far end. Default: 0.
        BOTTOM : float [length], optional
            FRUSTUM: radius at CM. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "FRUSTUM",
            name,
            CM=CM,
            LENGTH=LENGTH,
            TOP=TOP,
            BOTTOM=BOTTOM,
        )
        return made

    def ellipsoid(
        self,
        name: str,
        *,
        CM: Sequence[Element | int] | None = None,
        XSCALE: float | None = None,
        YSCALE: float | None = None,
        ZSCALE: float | None = None,
    ) -> Element:
        """Add a GRAPHICS, ELLIPSOID.

        An ellipsoid about CM.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        CM : Sequence[Element | int], optional
            CYLINDER, FRUSTUM, ELLIPSOID, TORUS, CIRCLE, ARC: the marker at the centre, or at the
            middle of the bottom.
        XSCALE : float [length], optional
            ELLIPSOID: diameter along x. Default: 0.
        YSCALE : float [length], optional
            ELLIPSOID: diameter along y. Default: 0.
        ZSCALE : float [length], optional
            ELLIPSOID: diameter along z. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "ELLIPSOID",
            name,
            CM=CM,
            XSCALE=XSCALE,
            YSCALE=YSCALE,
            ZSCALE=ZSCALE,
        )
        return made

    def torus(
        self,
        name: str,
        *,
        CM: Sequence[Element | int] | None = None,
        MAJOR_RADIUS: float | None = None,
        MINOR_RADIUS: float | None = None,
    ) -> Element:
        """Add a GRAPHICS, TORUS.

        A ring about z of CM.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        CM : Sequence[Element | int], optional
            CYLINDER, FRUSTUM, ELLIPSOID, TORUS, CIRCLE, ARC: the marker at the centre, or at the
            middle of the bottom.
        MAJOR_RADIUS : float [length], optional
            TORUS: radius of the circle in the middle of the tube. Default: 0.
        MINOR_RADIUS : float [length], optional
            TORUS: radius of the tube. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "TORUS",
            name,
            CM=CM,
            MAJOR_RADIUS=MAJOR_RADIUS,
            MINOR_RADIUS=MINOR_RADIUS,
        )
        return made

    def plane(
        self,
        name: str,
        *,
        RM: Element | int | None = None,
        XMIN: float | None = None,
        XMAX: float | None = None,
        YMIN: float | None = None,
        YMAX: float | None = None,
    ) -> Element:
        """Add a GRAPHICS, PLANE.

        The x-y plane of RM.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        RM : Element | int, optional
            PLANE, POINT, SHELL, EXTERNAL: the marker in whose frame it stands.
        XMIN : float [length], optional
            PLANE: least x; beyond its bounds nothing touches it. Default: no bound.
        XMAX : float [length], optional
            PLANE: largest x. Default: no bound.
        YMIN : float [length], optional
            PLANE: least y. Default: no bound.
        YMAX : float [length], optional
            PLANE: largest y. Default: no bound.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "PLANE",
            name,
            RM=RM,
            XMIN=XMIN,
            XMAX=XMAX,
            YMIN=YMIN,
            YMAX=YMAX,
        )
        return made

    def circle(
        self,
        name: str,
        *,
        CM: Sequence[Element | int] | None = None,
        RADIUS: float | None = None,
    ) -> Element:
        """Add a GRAPHICS, CIRCLE.

        A circle about z of CM.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        CM : Sequence[Element | int], optional
            CYLINDER, FRUSTUM, ELLIPSOID, TORUS, CIRCLE, ARC: the marker at the centre, or at the
            middle of the bottom.
        RADIUS : float [length], optional
            CYLINDER, CIRCLE, ARC: radius. Default: 0.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "CIRCLE",
            name,
            CM=CM,
            RADIUS=RADIUS,
        )
        return made

    def point(
        self,
        name: str,
        *,
        RM: Element | int | None = None,
    ) -> Element:
        """Add a GRAPHICS, POINT.

        The origin of RM.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        RM : Element | int, optional
            PLANE, POINT, SHELL, EXTERNAL: the marker in whose frame it stands.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "POINT",
            name,
            RM=RM,
        )
        return made

    def graphics_curve(
        self,
        name: str,
        *,
        CID: Element | int | None = None,
        CRM: Element | int | None = None,
    ) -> Element:
        """Add a GRAPHICS, GRAPHICS_CURVE.

        A plane CURVE.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        CID : Element | int, optional
            CURVE: the CURVE.
        CRM : Element | int, optional
            CURVE: the marker in whose frame its points are.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "GRAPHICS_CURVE",
            name,
            CID=CID,
            CRM=CRM,
        )
        return made

    def arc(
        self,
        name: str,
        *,
        CM: Sequence[Element | int] | None = None,
        RADIUS: float | None = None,
        RANGLE: float | None = None,
    ) -> Element:
        """Add a GRAPHICS, ARC.

        A part of a circle about z of CM.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        CM : Sequence[Element | int], optional
            CYLINDER, FRUSTUM, ELLIPSOID, TORUS, CIRCLE, ARC: the marker at the centre, or at the
            middle of the bottom.
        RADIUS : float [length], optional
            CYLINDER, CIRCLE, ARC: radius. Default: 0.
        RANGLE : float [rad], optional
            ARC: angle that it covers, from x of CM on. Default: 360D.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "ARC",
            name,
            CM=CM,
            RADIUS=RADIUS,
            RANGLE=RANGLE,
        )
        return made

    def shell(
        self,
        name: str,
        *,
        RM: Element | int | None = None,
        FILE: str | None = None,
    ) -> Element:
        """Add a GRAPHICS, SHELL.

        Triangles in a file; in contacts their convex hull.

        Parameters
        ----------
        name : str
            Its name; may be empty.
        RM : Element | int, optional
            PLANE, POINT, SHELL, EXTERNAL: the marker in whose frame it stands.
        FILE : str, optional
            SHELL, EXTERNAL: the file, beside the dataset.

        Returns
        -------
        Element
            The element.
        """
        made: Element = self._add(
            "SHELL",
            name,
            RM=RM,
            FILE=FILE,
        )
        return made
