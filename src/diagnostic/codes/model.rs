//! The TABLE of codes of datasets, models, command files and simulations, explained at length for
//! `cognate explain CODE`.

use super::Code;

/// All these codes: those of reading, of checks across statements, of solving.
pub static MODEL_CODES: &[Code] = &[
    Code {
        name: "cannot_open",
        summary: "a file cannot be opened",
        explanation: "The system's own words say why: it is not there, it is a folder, or it may not be read. The first line of a command
file that is no command is taken as the name of the dataset; FILE/MODEL=name is the command that names one.",
    },
    Code {
        name: "no_mass",
        summary: "a part can move in a direction in which it has neither mass nor inertia",
        explanation: "\
An acceleration follows from a force and a mass. Where no constraint holds a direction and nothing that moves in it has mass or inertia, no
acceleration follows. PART without MASS or IP has none; a mass in the axis of a turn does not resist it without IP. Parts without mass are
fine where what they carry has mass, or where joints and motions hold them; statics and kinematics do not ask.

    PART/2, MASS=2, CM=22, IP=0.1,0.1,0.1",
    },
    Code {
        name: "unreadable",
        summary: "a place where the text cannot be taken apart into statements",
        explanation: "\
Statements consist of words, numbers, texts and separators (comma, =, /, \\, :). What stands here begins none of them; a file
that is not text, or a sign pasted from a word processor, does this.",
    },
    Code {
        name: "statement_as_title",
        summary: "the first line of the dataset looks like a statement, but is the title",
        explanation: "\
The first line of a dataset is its title and is never read as a statement. A PART or MARKER in it is lost.

    PART/1, GROUND        is the title when it is the first line: put a line with a title above it",
    },
    Code {
        name: "missing_end",
        summary: "the dataset does not end with END",
        explanation: "END as the last statement shows that the file is complete. Without it, it may have been cut off; all of it is read nevertheless.",
    },
    Code {
        name: "unknown_statement",
        summary: "a statement or kind of element that does not exist",
        explanation: "\
Statements may be shortened as long as they stay unique (MARK for MARKER). A line that begins with a comma continues the
statement before it; without the comma it begins a new one, so a lost comma makes an argument look like a statement.",
    },
    Code {
        name: "ambiguous_statement",
        summary: "a shortened statement that may be one of several",
        explanation: "Write as many letters as make it unique: `SPL` is SPLINE, `SP` may be SPLINE or SPRINGDAMPER.",
    },
    Code {
        name: "missing_identifier",
        summary: "a statement without the number of its element",
        explanation: "Elements have numbers, written after a slash: PART/2, MARKER/21. They need not follow each other.",
    },
    Code {
        name: "unexpected_identifier",
        summary: "a number for something of which there is only one",
        explanation: "Settings such as UNITS, ACCGRAV or INTEGRATOR stand once in a model and take no number.",
    },
    Code {
        name: "not_an_identifier",
        summary: "something else where the number of an element should stand",
        explanation: "Numbers of elements are whole numbers from 1 to 2147483647, without sign, point or exponent.",
    },
    Code {
        name: "unknown_argument",
        summary: "an argument that this statement does not have",
        explanation: "\
The message names near words where there are any. Arguments may be shortened as long as they stay unique. A statement
goes on in the next line only when that line begins with a comma.",
    },
    Code {
        name: "ambiguous_argument",
        summary: "a shortened argument that may be one of several",
        explanation: "Write as many letters as make it unique.",
    },
    Code {
        name: "given_twice",
        summary: "the same argument twice in one statement",
        explanation: "Only one of them can be meant. Often the statement that should follow lost its name.",
    },
    Code {
        name: "excluded_argument",
        summary: "two arguments of which only one may stand",
        explanation: "\
For example END and DURATION of SIMULATE both say when it ends, STEPS and DTOUT both say how often there is output.",
    },
    Code {
        name: "unexpected_value",
        summary: "a value after a keyword that takes none, or none where one is needed",
        explanation: "Some arguments are keywords alone (REVOLUTE, GROUND); the others need = and a value (I = 12).",
    },
    Code {
        name: "unexpected_text",
        summary: "something left over in a statement",
        explanation: "\
Arguments are separated by commas. A statement goes on in the next line when that line begins with a comma.",
    },
    Code {
        name: "not_a_number",
        summary: "something else where a number should stand",
        explanation: "\
Numbers are written 2, 2., .5, 1.5E-3. The suffix D makes degrees (30D); an exponent is written with E.",
    },
    Code {
        name: "not_a_whole_number",
        summary: "something else where a whole number should stand",
        explanation: "Counts and identifiers have neither point nor exponent.",
    },
    Code {
        name: "blank_before_suffix",
        summary: "a blank between a number and its suffix D",
        explanation: "30 D is read as 30D, thirty degrees; other programs may refuse it.",
    },
    Code {
        name: "degrees_of_a_length",
        summary: "the suffix D at something that is not an angle",
        explanation: "D means degrees, and turns the number into radians. At a length or a mass that is surely not meant: write E for an exponent.",
    },
    Code {
        name: "unknown_word",
        summary: "a word that is none of those that may stand here",
        explanation: "The message lists them.",
    },
    Code {
        name: "missing_backslash",
        summary: "an expression is not ended before the next argument",
        explanation: "\
The text of a function goes on to the end of the statement. Where another argument follows, a backslash ends it:

    SFORCE/1, I = 12, J = 11, FUNCTION = -5*DX(12, 11)\\, TRANSLATIONAL",
    },
    Code {
        name: "wrong_count",
        summary: "more or fewer numbers than belong here",
        explanation: "Points have three coordinates, inertias six components, a spline as many values as places, a matrix rows times columns.",
    },
    Code {
        name: "endless_calls",
        summary: "command files call each other too deeply",
        explanation: "A command file may run another one. One that comes back to itself would never end.",
    },
    Code {
        name: "defined_twice",
        summary: "two elements of a kind with the same number",
        explanation: "The message names the line of the first. Numbers are unique within a kind of element: MARKER/1 and PART/1 are different.",
    },
    Code {
        name: "contradiction",
        summary: "arguments of a statement that do not go together",
        explanation: "The message says which; two different types of a joint, for example, or a function and a constant for the same thing.",
    },
    Code {
        name: "missing_argument",
        summary: "an argument without which the element means nothing",
        explanation: "The message says which one is missing. Nothing is guessed.",
    },
    Code {
        name: "unfit_value",
        summary: "a value that this argument cannot have",
        explanation: "The message says why: negative where only positive numbers make sense, zero where it is divided by, infinite.",
    },
    Code {
        name: "marker_without_part",
        summary: "a marker that does not say which part it belongs to",
        explanation: "It is taken to belong to the last PART before it. Write PART = to be safe when statements are moved.",
    },
    Code {
        name: "no_ground",
        summary: "no part is the ground",
        explanation: "Every model has one part that does not move: PART/1, GROUND.",
    },
    Code {
        name: "several_grounds",
        summary: "more than one part is the ground",
        explanation: "There is one ground. Put the markers of both on it.",
    },
    Code {
        name: "mass_of_ground",
        summary: "the ground has a mass",
        explanation: "The ground never moves, so that its mass and inertia mean nothing. Perhaps GROUND stands at the wrong part.",
    },
    Code {
        name: "negative_mass",
        summary: "a mass below zero",
        explanation: "Masses are zero or positive.",
    },
    Code {
        name: "mass_without_cm",
        summary: "a part with a mass but without a centre of mass",
        explanation: "CM = names the marker at the centre of mass.",
    },
    Code {
        name: "inertia_without_marker",
        summary: "moments of inertia about a point that is not given",
        explanation: "IP are the moments about the marker IM, or about CM where there is no IM.",
    },
    Code {
        name: "negative_inertia",
        summary: "a moment of inertia below zero",
        explanation: "Moments of inertia are zero or positive; products may have either sign.",
    },
    Code {
        name: "impossible_inertia",
        summary: "moments of inertia that no distribution of mass has",
        explanation: "\
Each principal moment is at most the sum of the two others, and none is negative. IP is xx, yy, zz, xy, xz, yz, where
products are the integrals of x y dm with positive sign; a tensor with negated products fails here.",
    },
    Code {
        name: "marker_of_another_part",
        summary: "CM or IM is a marker of another part",
        explanation: "The centre of mass and the inertia of a part are given by markers of that part.",
    },
    Code {
        name: "floating_marker",
        summary: "a FLOATING marker where a fixed one is needed",
        explanation: "A floating marker has no place of its own: it is moved by the one force or curve that names it as JFLOAT or IFLOAT.",
    },
    Code {
        name: "floating_marker_shared",
        summary: "a floating marker with two owners",
        explanation: "Each force or curve puts its floating marker somewhere else; every one needs its own.",
    },
    Code {
        name: "not_floating",
        summary: "JFLOAT or IFLOAT names a marker that is not FLOATING",
        explanation: "Write MARKER/id, PART = …, FLOATING for it; its position is found by the solver.",
    },
    Code {
        name: "unknown_marker",
        summary: "a marker that is not there, or has no place",
        explanation: "A marker must exist and belong to a part of the model.",
    },
    Code {
        name: "no_direction",
        summary: "points that give no direction",
        explanation: "ZP and XP (ZG and XG) are points on the axes: different from the origin, from each other, and not in line with it.",
    },
    Code {
        name: "same_part",
        summary: "both markers belong to the same part",
        explanation: "A joint between them would contradict or repeat what is rigid already; a spring between them never acts.",
    },
    Code {
        name: "turns_point_mass",
        summary: "a point mass where something must be able to turn",
        explanation: "POINT_MASS has no orientation. It takes SPHERICAL joints, and the primitives ATPOINT, INLINE and INPLANE.",
    },
    Code {
        name: "driven_twice",
        summary: "two motions for the same freedom of a joint",
        explanation: "One of them would contradict the other.",
    },
    Code {
        name: "motion_on_wrong_joint",
        summary: "a motion at a joint that does not move this way",
        explanation: "Motions drive REVOLUTE (rotation), TRANSLATIONAL (translation) and CYLINDRICAL (either) joints.",
    },
    Code {
        name: "wrong_joint",
        summary: "a joint that this element cannot use",
        explanation: "Couplers and gears take REVOLUTE, TRANSLATIONAL and CYLINDRICAL joints; FRICTION takes those that slide or turn.",
    },
    Code {
        name: "no_common_carrier",
        summary: "the joints of a gear do not share a carrier",
        explanation: "The J markers of both joints and the marker CV must belong to the part that carries both wheels.",
    },
    Code {
        name: "gear_carrier",
        summary: "the joints of a gear do not share a carrier",
        explanation: "The J markers of both joints and the marker CV must belong to the part that carries both wheels.",
    },
    Code {
        name: "gear_line_of_action",
        summary: "the wheels of a gear cannot push each other where CV stands",
        explanation: "CV stands where the pitch circles touch, its z axis along the common velocity there.",
    },
    Code {
        name: "no_units",
        summary: "the dataset names no units",
        explanation: "\
Without UNITS a force is a mass times an acceleration (UCF = 1): right for kg, m, s, N; a thousand times wrong for kg, mm, s, N.

    UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND
    UNITS/SYSTEM=MKS",
    },
    Code {
        name: "unlikely_magnitude",
        summary: "a number that cannot be meant in these units",
        explanation: "\
A gravity of 9.81 where lengths are millimetres, moments of inertia in kg m² among millimetres, a stiffness on which a mass
oscillates faster than any step: the message says the number and what it means.",
    },
    Code {
        name: "negative_stiffness",
        summary: "a spring that pushes away from its free position",
        explanation: "K, KT, KMATRIX and STIFFNESS are positive: the force is against the displacement without a sign of theirs.",
    },
    Code {
        name: "negative_damping",
        summary: "a damper that feeds energy",
        explanation: "\
C, CT, CMATRIX, DAMPING and friction coefficients are positive. In a FUNCTION the force is against the rate by its sign:

    SFORCE/1, TRANSLATION, I=21, J=31, FUNCTION=-20*(DM(21,31)-300)-1.5*VR(21,31)",
    },
    Code {
        name: "nothing_holds",
        summary: "a part that falls for ever",
        explanation: "\
No constraint, force or contact leads from the part to ground, and there is gravity. A part with an initial velocity is taken
as thrown and not doubted.",
    },
    Code {
        name: "forgotten_joint",
        summary: "two markers on each other that nothing uses",
        explanation: "\
Markers of two parts lie on each other, no element uses them, and nothing ties the two parts: what is left where a JOINT
was deleted, or is still to be written.",
    },
    Code {
        name: "stands_twice",
        summary: "two joints that are one",
        explanation: "They are of the same type, between the same parts, at the same place: the second holds nothing, and reactions are not unique.",
    },
    Code {
        name: "superseded",
        summary: "arguments of former releases that do nothing",
        explanation: "JOINT once took MU_STAT_ROT, MU_DYN_ROT and others. They are kept when the dataset is written, and not computed; FRICTION is.",
    },
    Code {
        name: "few_points",
        summary: "fewer points than a cubic spline needs",
        explanation: "AKISPL, CUBSPL and CURVE need at least four.",
    },
    Code {
        name: "not_increasing",
        summary: "places of a spline that do not increase",
        explanation: "X, and Z of a family of curves, must grow from each to the next.",
    },
    Code {
        name: "control_points",
        summary: "a CURVE that does not say what the rows of its MATRIX are",
        explanation: "\
Without CURVE_POINTS they are control points of a B-spline, which passes near them, not through them. Say CURVE_POINTS or
CONTROL_POINTS.",
    },
    Code {
        name: "axes_not_aligned",
        summary: "axes of two markers are not aligned as their element needs them",
        explanation: "\
Pins of a UNIVERSAL (z and z) and of a HOOKE (x of I, y of J) cross at 90 degrees. A RACKPIN has the pinion as I, turning about z,
and the rack as J, with x along that axis. A SCREW, a torsion spring and a rotational SFORCE have both z axes along the axis of
the rotation. CV of a GEAR has z along the common velocity of both bodies where they mesh. The message says how far off they are as
the dataset places the parts.",
    },
    Code {
        name: "open_ends",
        summary: "a CLOSED curve whose ends differ",
        explanation: "The last point of a closed curve is its first one again.",
    },
    Code {
        name: "wrong_array",
        summary: "an ARRAY of another kind than is needed here",
        explanation: "States take ARRAY X, outputs ARRAY Y, inputs ARRAY U, initial conditions ARRAY IC.",
    },
    Code {
        name: "improper_transfer_function",
        summary: "a transfer function with more zeros than poles",
        explanation: "The degree of NUMERATOR must not be above that of DENOMINATOR; otherwise the output would need derivatives of the input.",
    },
    Code {
        name: "unused_initial_condition",
        summary: "an initial condition that nothing uses",
        explanation: "The joint does not have this freedom, or a motion prescribes it.",
    },
    Code {
        name: "no_effect",
        summary: "an element that does nothing",
        explanation: "Usually a component or a component's marker was forgotten.",
    },
    Code {
        name: "model",
        summary: "something in the model stands in the way of solving it",
        explanation: "The message says what.",
    },
    Code {
        name: "unsupported",
        summary: "something that is read but not solved yet",
        explanation: "\
Every statement of a dataset is read, checked and written. Those that cannot be solved stop a run, lest a result be wrong.
--skip-unsupported KEYWORD leaves out all of a kind, knowingly.",
    },
    Code {
        name: "skipped",
        summary: "an element left out because --skip-unsupported or --zero-user says so",
        explanation: "\
The result is that of the model without it, and without what hangs on it: what is attached to a body that is left out, what drives
or couples a joint. It exerts nothing, and functions read zero of it; each of these is named.",
    },
    Code {
        name: "not_a_state",
        summary: "RELOAD of a file that holds no state saved by cognate",
        explanation: "\
SAVE/SYSTEM=name writes name.state.json beside the results: the model as the commands have left it, what is switched off, and where
the last simulation ended, every number exactly. RELOAD/SYSTEM=name goes on from there. What Adams saves under the same command is an image of its
memory, which no other program can read: obey the commands that led there, and SAVE anew.",
    },
    Code {
        name: "assembly",
        summary: "the constraints cannot all be satisfied",
        explanation: "\
Before a simulation the parts are moved so that every joint closes. The message names the equation that stays open and by how
much: parts may start too far away, or two constraints contradict each other.",
    },
    Code {
        name: "freedom",
        summary: "a kinematic simulation of a mechanism that is free to move",
        explanation: "KINEMATIC computes motion from constraints alone. Drive the remaining freedoms by MOTION, or simulate DYNAMIC.",
    },
    Code {
        name: "unavailable",
        summary: "something asked for that cannot be computed here",
        explanation: "The message names the function or column; the run goes on without it where that is possible.",
    },
    Code {
        name: "implicit_loop",
        summary: "a function that methods for implicit equations cannot take",
        explanation: "\
BDF, HHT and the like need derivatives of all equations. Functions that read accelerations or forces which depend on
them have none: choose an explicit method or RADAU5.",
    },
];
