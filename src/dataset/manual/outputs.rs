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
        text: "Either one of the four quantities between markers, or expressions F1 to F8. Columns are called NAME.COMPONENT: RESULTS_NAME (or the name of the comment line, or REQ_id), and CNAMES (or those below). An empty name \"\" leaves a component out.",
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
        text: "Each list is ALL or numbers between colons. It adds nothing here: results have all parts, joints and forces where RESULTS/XRF asks for them.",
        equation: "MREQUEST/1, FORCE, JOINTS=ALL",
        effect: Effect::Kept,
        notes: &[
            D, V, A, F,
            k("PARTS", "Parts that are asked."),
            k("JOINTS", "Joints that are asked."),
            k("JPRIMS", "Primitives that are asked."),
            k("APPFORS", "Forces that are asked."),
            RM,
            f("COMMENT", "A text about the request."),
        ],
        example: "loads",
    },
    Page {
        keyword: "OUTPUT",
        summary: "Which files of Adams are written, and their layout.",
        text: "Results are written as docs/files.md says; the layout of tabular files has no counterpart here.",
        equation: "",
        effect: Effect::Kept,
        notes: &[
            k("REQSAVE", "Write a file of requests."),
            k("GRSAVE", "Write a file of graphics."),
            k("NOPRINT", "Write no tabular file."),
            k("NOSEPARATOR", ADAMS),
            k("YPR", "Angles of displacement requests as yaw, pitch and roll."),
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
        text: "With it the table and the .res hold every part, joint and force; without it the requests alone, where there are some.",
        equation: "",
        effect: Effect::Solved,
        notes: &[
            k("XRF", "The XML form, which is always the one that is written."),
            k("FORMATTED", "As text, which is always so."),
            k("COMMENT", "A text about the results."),
            k("DECIMAL_PLACES", "Digits after the point; numbers are written in full."),
            k("NODISPLACEMENTS", "Leave displacements out."),
            k("NOVELOCITIES", "Leave velocities out."),
            k("NOACCELERATIONS", "Leave accelerations out."),
            k("NOREACTIONFORCES", "Leave reactions out."),
            k("NOAPPLIEDFORCES", "Leave forces out."),
            k("NODATASTRUCTURES", "Leave data out."),
            k("NOSYSTEMELEMENTS", "Leave systems out."),
            k("NOLINEAR", "Leave modes out."),
            k("NOFLOATINGMARKERS", "Leave floating markers out."),
            k("NOTIRES", "Leave tyres out."),
            k("NOREQUESTS", "Leave requests out."),
            k("NOCONTACTS", "Leave contacts out."),
        ],
        example: "slider_crank",
    },
];
