//! Pages of the commands of a command file.

use super::{Effect, Note, Page, f, k, n};

const ID: Note = f("ID", "Numbers of the elements.");
const RANGE: Note = f("RANGE", "First and last number of the elements.");
const SYSTEM: Note = f("SYSTEM", "Name of the file.");

#[rustfmt::skip]
pub(super) static PAGES: &[Page] = &[
    Page {
        keyword: "SIMULATE",
        summary: "Runs one simulation, from where the last one ended.",
        text: "Give END or DURATION, and STEPS or DTOUT. STATIC without END finds one equilibrium, with END one at each output.\nDYNAMIC after STATIC starts there, with the velocities of the dataset: at rest where it gives none.",
        equation: "KINEMATIC   motions determine everything: no freedom is left\nDYNAMIC     forces and masses\nSTATIC      equilibrium\nTRANSIENT   KINEMATIC without freedom, else DYNAMIC",
        effect: Effect::Solved,
        notes: &[
            f("KINEMATICS", "Motions alone move the mechanism."),
            f("DYNAMICS", "Forces move the mechanism."),
            f("STATICS", "The mechanism comes to rest."),
            f("TRANSIENT", "Kinematic without freedom, else dynamic."),
            f("INITIAL_CONDITIONS", "Assembles, and nothing more."),
            n("END", "time", "", "Time at the end, on the model's clock."),
            n("DURATION", "time", "", "Time from here to the end."),
            n("STEPS", "", "50", "Number of output steps."),
            n("DTOUT", "time", "", "Time between outputs."),
        ],
        example: "slider_crank",
    },
    Page {
        keyword: "FILE",
        summary: "Names the dataset, the results, or another command file.",
        text: "FILE/MODEL begins a command file.",
        equation: "",
        effect: Effect::Solved,
        notes: &[
            f("MODEL", "The dataset, with or without .adm, beside the command file."),
            n("OUTPUT_PREFIX", "", "that of the command file", "Base name of the results."),
            f("COMMAND", "A command file that is obeyed here."),
        ],
        example: "slider_crank",
    },
    Page {
        keyword: "ACTIVATE",
        summary: "Switches elements on that were switched off.",
        text: "",
        equation: "ACTIVATE/MOTION, ID=1",
        effect: Effect::Solved,
        notes: &[ID, RANGE],
        example: "sledge",
    },
    Page {
        keyword: "DEACTIVATE",
        summary: "Switches elements off until they are switched on.",
        text: "The next simulation starts where the last ended.",
        equation: "DEACTIVATE/JOINT, ID=3,4",
        effect: Effect::Solved,
        notes: &[ID, RANGE],
        example: "slider_crank",
    },
    Page {
        keyword: "LINEAR",
        summary: "Linearizes at the present state.",
        text: "EIGENSOL writes eigenvalues and mode shapes, STATEMAT the matrices between plant inputs and outputs, as NAME_linear.json and NAME_linear.m.",
        equation: "x' = A x + B u        y = C x + D u",
        effect: Effect::Solved,
        notes: &[
            f("EIGENSOL", "Eigenvalues and mode shapes."),
            f("STATEMAT", "The matrices A, B, C and D."),
            f("NODAMPING", "What depends on velocities is left out."),
            n("COORDS", "", "all", "First and last mode whose shape is written."),
            k("RM", "Marker in whose frame the model would be looked at."),
            f("FILE", "Base name of the files."),
            k("FORMAT", "Format of the matrices."),
            n("PINPUT", "", "all", "PINPUT whose VARIABLEs are the inputs."),
            n("POUTPUT", "", "all", "POUTPUT whose VARIABLEs are the outputs."),
        ],
        example: "control",
    },
    Page {
        keyword: "SAVE",
        summary: "Keeps the state of the model in a file beside the results.",
        text: "",
        equation: "SAVE/SYSTEM=before",
        effect: Effect::Solved,
        notes: &[SYSTEM],
        example: "sledge",
    },
    Page {
        keyword: "RELOAD",
        summary: "Goes back to a state that was kept.",
        text: "",
        equation: "RELOAD/SYSTEM=before",
        effect: Effect::Solved,
        notes: &[SYSTEM],
        example: "sledge",
    },
    Page { keyword: "STOP", summary: "Ends the run, whatever follows.", text: "", equation: "", effect: Effect::Solved, notes: &[], example: "slider_crank" },
    Page { keyword: "INFO", summary: "Asks for a print of numbers of the model: read, said and not obeyed.", text: "", equation: "", effect: Effect::Kept, notes: &[], example: "" },
    Page { keyword: "SHOW", summary: "Asks for a print of the state: read, said and not obeyed.", text: "", equation: "", effect: Effect::Kept, notes: &[], example: "" },
    Page { keyword: "TIME", summary: "Asks for a print of the time: read, said and not obeyed.", text: "", equation: "", effect: Effect::Kept, notes: &[], example: "" },
    Page { keyword: "HELP", summary: "Asks for help on the screen: read, said and not obeyed.", text: "", equation: "", effect: Effect::Kept, notes: &[], example: "" },
    Page { keyword: "MENU", summary: "Asks for a menu on the screen: read, said and not obeyed.", text: "", equation: "", effect: Effect::Kept, notes: &[], example: "" },
];
