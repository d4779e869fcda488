//! Pages of bodies and frames: UNITS, PART, POINT_MASS, MARKER, and gravity.

use super::{Effect, Note, Page, f, k, n};

const QG: Note = n(
    "QG",
    "length",
    "0, 0, 0",
    "Origin of the part's frame, in ground.",
);
const REULER: Note = n(
    "REULER",
    "rad",
    "0, 0, 0",
    "Orientation by the angles psi, theta, phi about z, the new x, the new z.",
);
const ZG: Note = n(
    "ZG",
    "length",
    "",
    "A point of ground on the part's +z axis; orientation by points instead of REULER.",
);
const XG: Note = n(
    "XG",
    "length",
    "",
    "A point of ground in the half plane of the part's +x axis.",
);
const MATERIAL: Note = k("MATERIAL", "Name of a material; masses are explicit.");
const VM: Note = f(
    "VM",
    "Marker in whose axes VX, VY, VZ are given; ground when not given.",
);
const FLEXIBLE: &str = "Body that is read and not solved: such a marker must be left out with it.";

#[rustfmt::skip]
pub(super) static PAGES: &[Page] = &[
    Page {
        keyword: "UNITS",
        summary: "The units of the model, and the factor between force and mass times acceleration.",
        text: "Give all four units, or SYSTEM, or UCF. Numbers of the dataset, functions and results are all in these units; angles are radians, and the suffix D means degrees.\nWithout UNITS the factor is 1 and results have no names of units.",
        equation: "Force * UCF = Mass * Acceleration\n\nnewton, kilogram, millimeter, second   UCF = 1000\nnewton, kilogram, meter, second        UCF = 1",
        effect: Effect::Solved,
        notes: &[
            f("FORCE", "Unit of force."),
            f("MASS", "Unit of mass."),
            f("LENGTH", "Unit of length."),
            f("TIME", "Unit of time."),
            f("SYSTEM", "All four at once: MKS (m kg s N), CGS (cm g s dyne), FPS (ft lbm s lbf), IPS (in lbm s lbf), MMKS (mm kg s N), NONE."),
            n("UCF", "", "from the units", "The factor itself, for units that have no name."),
        ],
        example: "slider_crank",
    },
    Page {
        keyword: "PART",
        summary: "A rigid body: where its frame stands, its mass and inertia, and its motion at the start.",
        text: "Exactly one part is GROUND, the frame in which everything is measured. QG and the orientation place the part's frame; markers are given in that frame, and one of them, CM, is the centre of mass.\nAssembly moves parts until all joints fit; EXACT coordinates move last. A part without mass is allowed where constraints or other masses determine its motion.",
        equation: "            z                  QG       origin of the part's frame, in ground\n            |   CM (marker)    REULER   3-1-3 angles of its axes against ground\n   ground   |  /               QP       of a marker: place in the part's frame\n     o------o-+---- x\n   origin   QG                 inertia about the axes of IM:\n                               [ Ixx -Ixy -Ixz]   Ixy = + integral of x y dm\n                               [-Ixy  Iyy -Iyz]\n                               [-Ixz -Iyz  Izz]",
        effect: Effect::Solved,
        notes: &[
            f("GROUND", "This part is ground: it does not move and has no mass."),
            QG, REULER, ZG, XG,
            n("MASS", "mass", "0", "Mass of the part."),
            f("CM", "Marker of this part at its centre of mass. Needed with MASS."),
            n("IM", "", "CM", "Marker about whose origin and axes IP is given."),
            n("IP", "mass*length^2", "0, 0, 0", "Moments Ixx, Iyy, Izz, then optionally the products Ixy, Ixz, Iyz (positive integrals), about IM."),
            MATERIAL,
            n("VX", "length/time", "0 where constraints allow", "Initial velocity of CM along x of VM. Given velocities are kept before those that are not given."),
            n("VY", "length/time", "0 where constraints allow", "Initial velocity of CM along y of VM."),
            n("VZ", "length/time", "0 where constraints allow", "Initial velocity of CM along z of VM."),
            n("WX", "rad/time", "0 where constraints allow", "Initial angular velocity about x of WM."),
            n("WY", "rad/time", "0 where constraints allow", "Initial angular velocity about y of WM."),
            n("WZ", "rad/time", "0 where constraints allow", "Initial angular velocity about z of WM."),
            VM,
            n("WM", "", "CM", "Marker about whose axes WX, WY, WZ are given."),
            f("EXACT", "Coordinates that assembly changes last: any of X:Y:Z:PSI:THETA:PHI."),
        ],
        example: "slider_crank",
    },
    Page {
        keyword: "POINT_MASS",
        summary: "A body without rotation: three freedoms of translation.",
        text: "Its markers keep their orientation. Nothing may turn it: neither joints that hold angles nor torques.",
        equation: "MASS * acceleration = sum of forces",
        effect: Effect::Solved,
        notes: &[
            QG, REULER, ZG, XG,
            n("MASS", "mass", "0", "Mass of the body."),
            f("CM", "Marker of this body at its centre of mass."),
            MATERIAL,
            n("VX", "length/time", "0 where constraints allow", "Initial velocity along x of VM."),
            n("VY", "length/time", "0 where constraints allow", "Initial velocity along y of VM."),
            n("VZ", "length/time", "0 where constraints allow", "Initial velocity along z of VM."),
            VM,
            f("EXACT", "Coordinates that assembly changes last: any of X:Y:Z."),
        ],
        example: "loads",
    },
    Page {
        keyword: "MARKER",
        summary: "A frame fixed in a part: where joints, forces and requests attach.",
        text: "A FLOATING marker has no place of its own: the element that names it (JFLOAT, IFLOAT) moves it.",
        equation: "orientation   REULER=psi, theta, phi     about z, then the new x, then the new z\n     or       ZP=point, XP=point         z from QP through ZP; XP in the half plane of +x\n     or       ZP=point, XP=point, USEXP  x from QP through XP; ZP in the half plane of +z\n\nREULER=0,90D,0      z of the marker along -y of the part\nREULER=90D,90D,0    z along  x of the part\nREULER=180D,90D,0   z along  y of the part",
        effect: Effect::Solved,
        notes: &[
            n("PART", "", "the part before it", "The part in which the marker is fixed."),
            f("POINT_MASS", "The point mass in which the marker is fixed."),
            k("FLEX_BODY", FLEXIBLE),
            k("FE_PART", FLEXIBLE),
            k("CURVE", FLEXIBLE),
            k("NODE_LABEL", "Node of a flexible body."),
            k("NODE_ID", "Nodes of a flexible body."),
            k("VALUE", "Parameter of a curve."),
            f("FLOATING", "It is moved by the one element that names it."),
            n("QP", "length", "0, 0, 0", "Origin, in the frame of its part."),
            n("ZP", "length", "", "A point on the +z axis, in the frame of its part."),
            n("XP", "length", "", "A point in the half plane of the +x axis, in the frame of its part."),
            f("USEXP", "XP lies on the +x axis exactly, and ZP only in the half plane of +z."),
            n("REULER", "rad", "0, 0, 0", "Orientation by the angles psi, theta, phi about z, the new x, the new z."),
        ],
        example: "slider_crank",
    },
    Page {
        keyword: "ACCGRAV",
        summary: "Gravity, on every part with mass.",
        text: "A negative value pulls along the negative axis.",
        equation: "force on a part = MASS * (IGRAV, JGRAV, KGRAV) / UCF, at its CM",
        effect: Effect::Solved,
        notes: &[
            n("IGRAV", "length/time^2", "0", "Acceleration along x of ground."),
            n("JGRAV", "length/time^2", "0", "Acceleration along y of ground."),
            n("KGRAV", "length/time^2", "0", "Acceleration along z of ground."),
        ],
        example: "slider_crank",
    },
];
