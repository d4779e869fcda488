//! Pages of what is asked for among the results: REQUEST, MREQUEST, OUTPUT, RESULTS.

use super::{Effect, Note, Page, ROUTINE, f, k, n};

const D: Note = f("DISPLACEMENT", "Displacement and orientation of I from J.");
const V: Note = f(
    "VELOCITY",
    "Velocity and angular velocity of I against J, as differences of what ground sees.",
);
const A: Note = f(
    "ACCELERATION",
    "Acceleration and angular acceleration of I against J.",
);
const F: Note = f(
    "FORCE",
    "Force and torque on I of the elements between I and J.",
);
const RM: Note = n(
    "RM",
    "",
    "ground",
    "Marker along whose axes the components are.",
);
const SCALE: &str = "Scale of a chart in the tabular file, which is not written.";
const ADAMS: &str = "About files that are not written here.";

#[rustfmt::skip]
pub(super) static PAGES: &[Page] = &[
    Page {
        keyword: "REQUEST",
        summary: "Up to eight columns among the results.",
        text: "Either one of the four quantities between markers, or expressions F1 to F8. Columns are called NAME.COMPONENT: RESULTS_NAME (or the name of the comment line, or REQUEST_id), and CNAMES (or those below). An empty name \"\" leaves a component out.",
        equation: "              1    2     3     4     5     6     7      8\nDISPLACEMENT  MAG  DX    DY    DZ    -     PSI   THETA  PHI    3-1-3 angles, rad\nVELOCITY      MAG  VX    VY    VZ    AMAG  WX    WY     WZ\nACCELERATION  MAG  ACCX  ACCY  ACCZ  AMAG  WDTX  WDTY   WDTZ\nFORCE         MAG  FX    FY    FZ    AMAG  TX    TY     TZ\n\nREQUEST/1, F2=DX(12,21)\\\n, F3=VX(12,21)\\                  a backslash ends each expression\n, CNAMES=\"\",\"x\",\"v\",\"\",\"\",\"\",\"\",\"\", RESULTS_NAME=slider",
        effect: Effect::Solved,
        notes: &[
            D, V, A, F,
            f("I", "The I marker."),
            n("J", "", "origin of ground", "The J marker."),
            RM,
            f("COMMENT", "A text about the request."),
            f("TITLE", "Headings of the eight components, between colons."),
            f("CUNITS", "Units of the eight components, in double quotes."),
            f("CNAMES", "Names of the eight components, in double quotes."),
            f("CLABELS", "Labels of the eight components for plots, in double quotes."),
            f("RESULTS_NAME", "Name of the request among the results."),
            f("F1", "First component, an expression."),
            f("F2", "Second component, an expression."),
            f("F3", "Third component, an expression."),
            f("F4", "Fourth component, an expression."),
            f("F5", "Fifth component, an expression."),
            f("F6", "Sixth component, an expression."),
            f("F7", "Seventh component, an expression."),
            f("F8", "Eighth component, an expression."),
            f("FUNCTION", "USER(…): the components by a routine."),
            ROUTINE,
        ],
        example: "slider_crank",
    },
    Page {
        keyword: "MREQUEST",
        summary: "The same quantity of many elements at once.",
        text: "Stands for a REQUEST of the quantity for each element: of a part at its CM, of a joint, primitive or force at I against J. Each list is ALL or numbers between colons; a force may be named with its statement. Columns are called NAME.ELEMENT.COMPONENT.",
        equation: "MREQUEST/1, FORCE, JOINTS=ALL, APPFORS=SFORCE/3",
        effect: Effect::Solved,
        notes: &[
            D, V, A, F,
            f("PARTS", "Parts that are asked."),
            f("JOINTS", "Joints that are asked."),
            f("JPRIMS", "Primitives that are asked."),
            f("APPFORS", "Forces that are asked."),
            RM,
            f("COMMENT", "A text about the request."),
        ],
        example: "loads",
    },
    Page {
        keyword: "OUTPUT",
        summary: "Which files are written beside the table.",
        text: "Files are described in docs/files.md; the layout of tabular files has no counterpart here.",
        equation: "",
        effect: Effect::Solved,
        notes: &[
            f("REQSAVE", "Write a file of requests, .req."),
            f("GRSAVE", "Write a file of the places of parts, .gra."),
            k("NOPRINT", "Write no tabular file, which is never written."),
            k("NOSEPARATOR", ADAMS),
            f("YPR", "Angles of displacement requests as yaw, pitch and roll."),
            k("TELETYPE", ADAMS),
            k("FIXED", ADAMS),
            k("OSFORMAT", ADAMS),
            k("GR521SAV", ADAMS),
            k("CHART", SCALE),
            k("DSCALE", SCALE), k("VSCALE", SCALE), k("ASCALE", SCALE), k("FSCALE", SCALE),
            k("DZERO", SCALE), k("VZERO", SCALE), k("AZERO", SCALE), k("FZERO", SCALE),
        ],
        example: "slider_crank",
    },
    Page {
        keyword: "RESULTS",
        summary: "Asks for a file of results, .res, with parts, joints and forces beside the requests.",
        text: "With it the .res holds a set for every element, and so does the table if there are no requests; without it the requests alone. The words that begin with NO leave sets out, of all files.",
        equation: "",
        effect: Effect::Solved,
        notes: &[
            k("XRF", "The XML form, which is always the one that is written."),
            k("FORMATTED", "As text, which is always so."),
            k("COMMENT", "A text about the results."),
            k("DECIMAL_PLACES", "Digits after the point; numbers are written in full."),
            f("NODISPLACEMENTS", "Leave out positions and angles of parts, and variables of joints."),
            f("NOVELOCITIES", "Leave out velocities of parts."),
            f("NOACCELERATIONS", "Leave out accelerations of parts."),
            f("NOREACTIONFORCES", "Leave out what constraints exert."),
            f("NOAPPLIEDFORCES", "Leave out what forces exert."),
            k("NODATASTRUCTURES", "Leave data out, which have no sets."),
            f("NOSYSTEMELEMENTS", "Leave out variables, equations, and inputs and outputs of the plant."),
            k("NOLINEAR", "Leave modes out, which stand in a file of their own."),
            f("NOFLOATINGMARKERS", "Leave out where curves touch."),
            k("NOTIRES", "Leave tyres out, which are not solved."),
            f("NOREQUESTS", "Leave out the components of requests."),
            f("NOCONTACTS", "Leave out what solids exert where they touch."),
        ],
        example: "slider_crank",
    },
];
