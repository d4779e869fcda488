//! The TABLE of codes of datasets, models, command files and simulations, explained at length for
//! `cognate explain CODE`.

use super::Code;

/// All these codes: those of reading, of checks across statements, of solving.
pub static MODEL_CODES: &[Code] = &[
    Code {
        name: "cannot_open",
        summary: "a file cannot be opened",
        explanation: "\
The system's own words say why: it is not there, it is a folder, or it may not be read. The first line of a command
file that is no command is taken as the name of the dataset; FILE/MODEL=name is the command that names one.

    FILE/MODEL=slider_crank     means slider_crank.adm beside the command file",
    },
    Code {
        name: "no_text",
        summary: "a file is no text",
        explanation: "\
Datasets, command files and logs are lines of text in UTF-8, UTF-16 or Windows-1252; a stray control character is passed over.
What a program keeps in a format of its own (.bin, archives, pictures, Parquet) is exported as a dataset first.

    cognate run model.adm --end 1     and not model.bin",
    },
    Code {
        name: "element_in_use",
        summary: "an element that is to be deleted is named by others",
        explanation: "\
A model without it would name what is not there. Delete the others first or with it, or let them name another.

    cognate elements belt.adm --delete JOINT/1 -o out.adm                     COUPLER/1 names it
    cognate elements belt.adm --delete JOINT/1 --delete COUPLER/1 -o out.adm  both go",
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
that is not text, or a sign pasted from a word processor, does this.

    MARKER/1, QP=1;2;3          write QP=1,2,3
    PART/2, MASS=“5”            write MASS=5",
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
        explanation: "\
END as the last statement shows that the file is complete. Without it, it may have been cut off; all of it is read nevertheless.

    END                         as the last line",
    },
    Code {
        name: "beyond_end",
        summary: "statements after END, or commands after STOP, which nothing reads",
        explanation: "\
A dataset ends with END and the commands end with STOP, also where another command file calls them: what follows is not read. Put END
last when statements are added at the end of a file, and STOP last among all commands.

    END
    SFORCE/7, ROTATIONAL, I=21, J=10, FUNCTION=2     is not in the model: put it above END",
    },
    Code {
        name: "no_simulation",
        summary: "commands that simulate nothing",
        explanation: "\
A command file without SIMULATE and LINEAR reads the model and ends: its table has no rows.

    FILE/MODEL=crank
    SIMULATE/DYNAMIC, END=1, STEPS=100               is what is missing
    STOP",
    },
    Code {
        name: "unknown_statement",
        summary: "a statement or kind of element that does not exist",
        explanation: "\
Statements may be shortened as long as they stay unique (MARK for MARKER). A line that begins with a comma continues the
statement before it; without the comma it begins a new one, so a lost comma makes an argument look like a statement.

    MARKR/1, PART=1             write MARKER/1, PART=1
    PART/2, MASS=1
    CM=20                       the comma is lost: , CM=20",
    },
    Code {
        name: "ambiguous_statement",
        summary: "a shortened statement that may be one of several",
        explanation: "\
Write as many letters as make it unique: `SPL` is SPLINE, `SP` may be SPLINE or SPRINGDAMPER.

    SP/1, X=0,1,2,3             write SPL/1 or SPLINE/1",
    },
    Code {
        name: "missing_identifier",
        summary: "a statement without the number of its element",
        explanation: "\
Elements have numbers, written after a slash: PART/2, MARKER/21. They need not follow each other.

    MARKER, PART=1              write MARKER/1, PART=1",
    },
    Code {
        name: "unexpected_identifier",
        summary: "a number for something of which there is only one",
        explanation: "\
Settings such as UNITS, ACCGRAV or INTEGRATOR stand once in a model and take no number.

    ACCGRAV/1, JGRAV=-9.81      write ACCGRAV/JGRAV=-9.81",
    },
    Code {
        name: "not_an_identifier",
        summary: "something else where the number of an element should stand",
        explanation: "\
Numbers of elements are whole numbers from 1 to 2147483647, without sign, point or exponent.

    PART/-2                     write PART/2
    MARKER/1.5                  write MARKER/15",
    },
    Code {
        name: "unknown_argument",
        summary: "an argument that this statement does not have",
        explanation: "\
The message names near words where there are any. Arguments may be shortened as long as they stay unique. A statement
goes on in the next line only when that line begins with a comma.

    PART/3, MASSE=1             write PART/3, MASS=1
    cognate statements PART     shows all of its arguments",
    },
    Code {
        name: "ambiguous_argument",
        summary: "a shortened argument that may be one of several",
        explanation: "\
Write as many letters as make it unique.

    FRICTION/1, MU=0.3          write MU_STATIC=0.3",
    },
    Code {
        name: "given_twice",
        summary: "the same argument twice in one statement",
        explanation: "\
Only one of them can be meant. Often the statement that should follow lost its name.

    PART/2, MASS=1, MASS=2      write PART/2, MASS=2",
    },
    Code {
        name: "excluded_argument",
        summary: "two arguments of which only one may stand",
        explanation: "\
For example END and DURATION of SIMULATE both say when it ends, STEPS and DTOUT both say how often there is output.

    SIMULATE/DYNAMIC, END=2, DURATION=1       write one of them",
    },
    Code {
        name: "unexpected_value",
        summary: "a value after a keyword that takes none, or none where one is needed",
        explanation: "\
Some arguments are keywords alone (REVOLUTE, GROUND); the others need = and a value (I = 12).

    JOINT/1, REVOLUTE=1, I=12, J=21           write JOINT/1, REVOLUTE, I=12, J=21",
    },
    Code {
        name: "unexpected_text",
        summary: "something left over in a statement",
        explanation: "\
Arguments are separated by commas. A statement goes on in the next line when that line begins with a comma.

    MARKER/1, PART=1 QP=1,2,3   write MARKER/1, PART=1, QP=1,2,3",
    },
    Code {
        name: "not_a_number",
        summary: "something else where a number should stand",
        explanation: "\
Numbers are written 2, 2., .5, 1.5E-3. The suffix D makes degrees (30D); an exponent is written with E.

    MASS=1,5                    write MASS=1.5
    MASS=1D3                    write MASS=1E3",
    },
    Code {
        name: "not_a_whole_number",
        summary: "something else where a whole number should stand",
        explanation: "\
Counts and identifiers have neither point nor exponent.

    JOINT/1, REVOLUTE, I=12.0, J=21           write I=12",
    },
    Code {
        name: "blank_before_suffix",
        summary: "a blank between a number and its suffix D",
        explanation: "\
30 D is read as 30D, thirty degrees; other programs may refuse it.

    REULER=90 D,0,0             write REULER=90D,0,0",
    },
    Code {
        name: "degrees_of_a_length",
        summary: "the suffix D at something that is not an angle",
        explanation: "\
D means degrees, and turns the number into radians. At a length or a mass that is surely not meant: write E for an exponent.

    QP=1D3,0,0                  write QP=1E3,0,0",
    },
    Code {
        name: "unknown_word",
        summary: "a word that is none of those that may stand here",
        explanation: "\
The message lists them.

    UNITS/FORCE=NEWTONS, …      write FORCE=NEWTON",
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
        explanation: "\
Points have three coordinates, inertias six components, a spline as many values as places, a matrix rows times columns.

    QP=1,2                      write QP=1,2,0",
    },
    Code {
        name: "endless_calls",
        summary: "command files call each other too deeply",
        explanation: "\
A command file may run another one. One that comes back to itself would never end.

    a.acf: FILE/COMMAND=b.acf   and b.acf: FILE/COMMAND=a.acf",
    },
    Code {
        name: "defined_twice",
        summary: "two elements of a kind with the same number",
        explanation: "\
The message names the line of the first. Numbers are unique within a kind of element: MARKER/1 and PART/1 are different.

    MARKER/1, PART=1
    MARKER/1, PART=2            write MARKER/2, PART=2",
    },
    Code {
        name: "contradiction",
        summary: "arguments of a statement that do not go together",
        explanation: "\
The message says which; two different types of a joint, for example, or a function and a constant for the same thing.

    JOINT/1, REVOLUTE, TRANSLATIONAL, I=12, J=21      write one type",
    },
    Code {
        name: "missing_argument",
        summary: "an argument without which the element means nothing",
        explanation: "\
The message says which one is missing. Nothing is guessed.

    JOINT/1, REVOLUTE, I=12     write JOINT/1, REVOLUTE, I=12, J=21",
    },
    Code {
        name: "unfit_value",
        summary: "a value that this argument cannot have",
        explanation: "\
The message says why: negative where only positive numbers make sense, zero where it is divided by, infinite.

    SIMULATE/DYNAMIC, END=1, STEPS=0          write STEPS=100",
    },
    Code {
        name: "marker_without_part",
        summary: "a marker that does not say which part it belongs to",
        explanation: "\
It is taken to belong to the last PART before it. Write PART = to be safe when statements are moved.

    MARKER/21, QP=1,0,0         write MARKER/21, PART=2, QP=1,0,0",
    },
    Code {
        name: "no_ground",
        summary: "no part is the ground",
        explanation: "\
Every model has one part that does not move: PART/1, GROUND.

    PART/1, GROUND",
    },
    Code {
        name: "several_grounds",
        summary: "more than one part is the ground",
        explanation: "\
There is one ground. Put the markers of both on it.

    PART/1, GROUND
    PART/9, GROUND              leave it out, and write PART=1 in its markers",
    },
    Code {
        name: "mass_of_ground",
        summary: "the ground has a mass",
        explanation: "\
The ground never moves, so that its mass and inertia mean nothing. Perhaps GROUND stands at the wrong part.

    PART/1, GROUND, MASS=5      write PART/1, GROUND",
    },
    Code {
        name: "negative_mass",
        summary: "a mass below zero",
        explanation: "\
Masses are zero or positive.

    PART/2, MASS=-2, CM=20      write MASS=2",
    },
    Code {
        name: "mass_without_cm",
        summary: "a part with a mass but without a centre of mass",
        explanation: "\
CM = names the marker at the centre of mass.

    PART/2, MASS=2              write PART/2, MASS=2, CM=20 and MARKER/20, PART=2",
    },
    Code {
        name: "inertia_without_marker",
        summary: "moments of inertia about a point that is not given",
        explanation: "\
IP are the moments about the marker IM, or about CM where there is no IM.

    PART/2, IP=1,1,1            write PART/2, CM=20, IP=1,1,1",
    },
    Code {
        name: "negative_inertia",
        summary: "a moment of inertia below zero",
        explanation: "\
Moments of inertia are zero or positive; products may have either sign.

    IP=-1,1,1                   write IP=1,1,1",
    },
    Code {
        name: "impossible_inertia",
        summary: "moments of inertia that no distribution of mass has",
        explanation: "\
Each principal moment is at most the sum of the two others, and none is negative. IP is xx, yy, zz, xy, xz, yz, where
products are the integrals of x y dm with positive sign; a tensor with negated products fails here.

    IP=1,1,5                    5 is more than 1 + 1",
    },
    Code {
        name: "marker_of_another_part",
        summary: "CM or IM is a marker of another part",
        explanation: "\
The centre of mass and the inertia of a part are given by markers of that part.

    PART/2, MASS=1, CM=30
    MARKER/30, PART=3           write CM=20, with MARKER/20, PART=2",
    },
    Code {
        name: "floating_marker",
        summary: "a FLOATING marker where a fixed one is needed",
        explanation: "\
A floating marker has no place of its own: it is moved by the one force or curve that names it as JFLOAT or IFLOAT.

    JOINT/1, REVOLUTE, I=19, J=21, where MARKER/19 is FLOATING: take a marker with a place",
    },
    Code {
        name: "floating_marker_shared",
        summary: "a floating marker with two owners",
        explanation: "\
Each force or curve puts its floating marker somewhere else; every one needs its own.

    VFORCE/1, I=20, JFLOAT=19, …
    VFORCE/2, I=30, JFLOAT=19, …    write JFLOAT=29, with MARKER/29, PART=1, FLOATING",
    },
    Code {
        name: "not_floating",
        summary: "JFLOAT or IFLOAT names a marker that is not FLOATING",
        explanation: "\
Write MARKER/id, PART = …, FLOATING for it; its position is found by the solver.

    MARKER/19, PART=1, FLOATING",
    },
    Code {
        name: "unknown_marker",
        summary: "a marker that is not there, or has no place",
        explanation: "\
A marker must exist and belong to a part of the model.

    JOINT/1, REVOLUTE, I=44, J=11     write MARKER/44, PART=4 or another I",
    },
    Code {
        name: "no_direction",
        summary: "points that give no direction",
        explanation: "\
ZP and XP (ZG and XG) are points on the axes: different from the origin, from each other, and not in line with it.

    MARKER/1, PART=1, QP=1,0,0, ZP=1,0,0      ZP is the origin: write ZP=1,0,1",
    },
    Code {
        name: "same_part",
        summary: "both markers belong to the same part",
        explanation: "\
A joint between them would contradict or repeat what is rigid already; a spring between them never acts.

    JOINT/1, REVOLUTE, I=21, J=22, both on PART/2     one of them belongs to another part",
    },
    Code {
        name: "turns_point_mass",
        summary: "a point mass where something must be able to turn",
        explanation: "\
POINT_MASS has no orientation. It takes SPHERICAL joints, and the primitives ATPOINT, INLINE and INPLANE.

    JOINT/1, REVOLUTE, I=30, J=11, MARKER/30 on a POINT_MASS     write SPHERICAL, or make it a PART",
    },
    Code {
        name: "driven_twice",
        summary: "two motions for the same freedom of a joint",
        explanation: "\
One of them would contradict the other.

    MOTION/1, JOINT=1, FUNCTION=TIME
    MOTION/2, JOINT=1, FUNCTION=2*TIME        leave one out",
    },
    Code {
        name: "motion_on_wrong_joint",
        summary: "a motion at a joint that does not move this way",
        explanation: "\
Motions drive REVOLUTE (rotation), TRANSLATIONAL (translation) and CYLINDRICAL (either) joints.

    MOTION/1, JOINT=1 of a SPHERICAL joint    write MOTION/1, I=21, J=11, B3, FUNCTION=…",
    },
    Code {
        name: "wrong_joint",
        summary: "a joint that this element cannot use",
        explanation: "\
Couplers and gears take REVOLUTE, TRANSLATIONAL and CYLINDRICAL joints; FRICTION takes those that slide or turn.

    COUPLER/1, JOINTS=1,2, where JOINT/2 is SPHERICAL    a REVOLUTE joint has one angle",
    },
    Code {
        name: "no_common_carrier",
        summary: "the joints of a gear do not share a carrier",
        explanation: "\
The J markers of both joints and the marker CV must belong to the part that carries both wheels.

    GEAR/1, JOINTS=1,2, CV=14: J of JOINT/1, J of JOINT/2 and MARKER/14 on one part",
    },
    Code {
        name: "gear_carrier",
        summary: "the joints of a gear do not share a carrier",
        explanation: "\
The J markers of both joints and the marker CV must belong to the part that carries both wheels.

    GEAR/1, JOINTS=1,2, CV=14: J of JOINT/1, J of JOINT/2 and MARKER/14 on one part",
    },
    Code {
        name: "gear_line_of_action",
        summary: "the wheels of a gear cannot push each other where CV stands",
        explanation: "\
CV stands where the pitch circles touch, its z axis along the common velocity there.

    MARKER/14, PART=1, QP=30,0,0, REULER=180D,90D,0D     z along y, for wheels side by side along x",
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
oscillates faster than any step: the message says the number and what it means.

    UNITS/SYSTEM=MMKS and ACCGRAV/JGRAV=-9.81     write JGRAV=-9806.65",
    },
    Code {
        name: "negative_stiffness",
        summary: "a spring that pushes away from its free position",
        explanation: "\
K, KT, KMATRIX and STIFFNESS are positive: the force is against the displacement without a sign of theirs.

    SPRINGDAMPER/1, TRANSLATIONAL, I=30, J=20, K=-10     write K=10",
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
as thrown and not doubted.

    JOINT/4, REVOLUTE, I=40, J=13      between the part and what carries it",
    },
    Code {
        name: "forgotten_joint",
        summary: "two markers on each other that nothing uses",
        explanation: "\
Markers of two parts lie on each other, no element uses them, and nothing ties the two parts: what is left where a JOINT
was deleted, or is still to be written.

    JOINT/3, REVOLUTE, I=31, J=41      the markers that lie on each other",
    },
    Code {
        name: "name_twice",
        summary: "two elements of a kind have one name",
        explanation: "\
An element of a kind is called by its name at every door: in columns, by --only, in a sweep, in load cases. Two of one name are
told apart by their numbers alone. Results give the further ones a number (`rod`, `rod_2`), so that no column is lost; a model
that a program builds is refused, for there the name stands for the element. A notebook whose cell has run twice makes such
models: begin the builder in the same cell.

Markers may share a name on different parts, where `slider.tip` and `rod.tip` tell them apart.

    ! adams_view_name='rod'
    PART/2, MASS=1
    ! adams_view_name='rod'
    PART/3, MASS=1        name it otherwise",
    },
    Code {
        name: "stands_twice",
        summary: "two joints that are one",
        explanation: "\
They are of the same type, between the same parts, at the same place: the second holds nothing, and reactions are not unique.

    JOINT/1, REVOLUTE, I=21, J=11
    JOINT/2, REVOLUTE, I=22, J=12      leave it out, or CYLINDRICAL for the second bearing",
    },
    Code {
        name: "superseded",
        summary: "arguments of former releases that do nothing",
        explanation: "\
JOINT once took MU_STAT_ROT, MU_DYN_ROT and others. They are kept when the dataset is written, and not computed; FRICTION is.

    JOINT/1, REVOLUTE, I=21, J=11, MU_DYN_ROT=0.1     write FRICTION/1, JOINT=1, MU_DYNAMIC=0.1",
    },
    Code {
        name: "embedded",
        summary: "a contact whose solids begin deep within each other",
        explanation: "\
The force of a CONTACT grows with the depth, so that these solids are thrown apart at once, with an energy that nothing
brought in. Told beyond 2 % of the size of the mechanism. Usually a part or the marker of a shape stands elsewhere than
meant, or a PLANE looks the other way: its z points out of the solid.

    MARKER/3, PART=1, REULER=0,180D,0
    GRAPHICS/2, PLANE, RM=3            its z points down: the ball above it lies within",
    },
    Code {
        name: "default",
        summary: "a length that is not given, and that results depend on",
        explanation: "\
FRICTION takes 1, in the unit of length, for each radius and arm that is not given, as Adams does: one metre or one
millimetre. It is a note; give the length if it matters.

    FRICTION/1, JOINT=1, MU_DYNAMIC=0.1                    a pin of radius 1
    FRICTION/1, JOINT=1, MU_DYNAMIC=0.1, PIN_RADIUS=0.02   the pin as it is",
    },
    Code {
        name: "ignored",
        summary: "statements and arguments that are accepted and change nothing",
        explanation: "\
They belong to the methods, the prints and the files of other solvers: patterns of factorization, limits of iterations, what a
log shows. They are kept where a dataset is written again. What the file asks for is computed without them, so results may
differ from those of a program that obeys them.

    INTEGRATOR/HHT, ALPHA=-0.2     RADAU5 does the work of HHT, and has its own damping
    EQUILIBRIUM/DYNAMICS           equilibria are found by a damped descent and Newton's iteration
    MREQUEST/1, FORCE, JOINTS=ALL  the results have all forces where RESULTS/XRF asks for them
    INFO/JOINT, ID=3               `cognate explain` shows a model

These are told in a note: nothing is wrong. An argument that the kind of its element does not read is a warning:

    JOINT/1, REVOLUTE, PITCH=3     a screw has a pitch
    MOTION/1, ICDISP=1, …          a displacement needs no beginning; VELOCITY and ACCELERATION do
    CONTACT/1, POISSON, DMAX=1     penetration at full damping is for IMPACT",
    },
    Code {
        name: "few_points",
        summary: "fewer points than a cubic spline needs",
        explanation: "\
AKISPL, CUBSPL and CURVE need at least four.

    SPLINE/1, X=0,1, Y=0,2     write X=0,0.3,0.7,1, Y=0,0.6,1.4,2",
    },
    Code {
        name: "not_increasing",
        summary: "places of a spline that do not increase",
        explanation: "\
X, and Z of a family of curves, must grow from each to the next.

    SPLINE/1, X=0,2,1,3, Y=…   write X=0,1,2,3 with Y in the same order",
    },
    Code {
        name: "control_points",
        summary: "a CURVE that does not say what the rows of its MATRIX are",
        explanation: "\
Without CURVE_POINTS they are control points of a B-spline, which passes near them, not through them. Say CURVE_POINTS or
CONTROL_POINTS.

    CURVE/1, CLOSED, MATRIX=1  write CURVE/1, CLOSED, CURVE_POINTS, MATRIX=1",
    },
    Code {
        name: "axes_not_aligned",
        summary: "axes of two markers are not aligned as their element needs them",
        explanation: "\
Pins of a UNIVERSAL (z and z) and of a HOOKE (x of I, y of J) cross at 90 degrees. A RACKPIN has the pinion as I, turning about z,
and the rack as J, with x along that axis. A SCREW, a torsion spring and a rotational SFORCE have both z axes along the axis of
the rotation. CV of a GEAR has z along the common velocity of both bodies where they mesh. The message says how far off they are as
the dataset places the parts.

    JOINT/1, HOOKE, I=12, J=21: turn MARKER/12 about its z until x of I is square to y of J",
    },
    Code {
        name: "pinion_on_other_side",
        summary: "a RACKPIN whose pinion lies on the other side of the rack than PD says",
        explanation: "\
J is the rack: it moves along z of J, and x of J is the axis of the pinion. A positive PD puts the centre of the pinion on the +y side
of J, a negative one on the -y side. With the other sign the rack moves against the rim of its pinion. Nothing is said where the
origin of I is hardly off the rack's line.

    JOINT/5, RACKPIN, I=22, J=51, PD=-60      the pinion lies on the -y side of MARKER/51",
    },
    Code {
        name: "open_ends",
        summary: "a CLOSED curve whose ends differ",
        explanation: "\
The last point of a closed curve is its first one again.

    MATRIX/1, …, VALUES=1,0,0, 0,1,0, -1,0,0, 0,-1,0, 1,0,0       the first point once more",
    },
    Code {
        name: "wrong_array",
        summary: "an ARRAY of another kind than is needed here",
        explanation: "\
States take ARRAY X, outputs ARRAY Y, inputs ARRAY U, initial conditions ARRAY IC.

    TFSISO/1, X=1, U=2, Y=3, …  with ARRAY/1, X  ARRAY/2, U, VARIABLES=7  ARRAY/3, Y",
    },
    Code {
        name: "improper_transfer_function",
        summary: "a transfer function with more zeros than poles",
        explanation: "\
The degree of NUMERATOR must not be above that of DENOMINATOR; otherwise the output would need derivatives of the input.

    NUMERATOR=1,2,3, DENOMINATOR=1,2     write DENOMINATOR=1,2,0.001",
    },
    Code {
        name: "unused_initial_condition",
        summary: "an initial condition that nothing uses",
        explanation: "\
The joint does not have this freedom, or a motion prescribes it.

    JOINT/1, FIXED, I=12, J=21, IC=0,1   leave IC out",
    },
    Code {
        name: "no_effect",
        summary: "an element, or an argument of a command, that does nothing",
        explanation: "\
Usually a component or a component's marker was forgotten, or an argument belongs to another kind of simulation.

    VFORCE/1, I=20, JFLOAT=19, RM=20     write FX=…\\ FY=…\\ FZ=…
    SIMULATE/INITIAL_CONDITIONS, END=1   leave END out, or write SIMULATE/DYNAMIC, END=1",
    },
    Code {
        name: "nothing_acts",
        summary: "a force is asked between two markers between which nothing acts",
        explanation: "\
FX(i,j) and REQUEST/…, FORCE add up what acts between these two markers: the I and the J of one force or joint, in either order. Between
others they are zero for ever, whatever acts between the parts. Without J they are what acts without a reaction (SFORCE, ACTIONONLY).

    JOINT/1, REVOLUTE, I=21, J=10
    FX(21,11)                            another marker of the same part: FX(21,10)",
    },
    Code {
        name: "step_order",
        summary: "STEP, STEP5 or HAVSIN over TIME ends at a place in degrees (a warning)",
        explanation: "\
Places and heights stand in turns: HAVSIN(x, x0, h0, x1, h1) goes from h0 at x0 to h1 at x1. The dialog of Adams View asks
for them in the order begin, end, initial, final, and an angle in degrees then stands where the end is read.

    HAVSIN(TIME, 0, 0.5, 30D, 120D)      write HAVSIN(TIME, 0, 30D, 0.5, 120D)",
    },
    Code {
        name: "model",
        summary: "something in the model stands in the way of solving it",
        explanation: "\
The message says what.

    cognate verify model.adm             says more of what fits and what does not",
    },
    Code {
        name: "unsupported",
        summary: "something that is read but not solved yet",
        explanation: "\
Every statement of a dataset is read, checked and written. Those that cannot be solved stop a run, lest a result be wrong.
--skip-unsupported KEYWORD leaves out all of a kind, knowingly.

    cognate run model.acf --skip-unsupported TIRE",
    },
    Code {
        name: "skipped",
        summary: "an element left out because --skip-unsupported or --zero-user says so",
        explanation: "\
The result is that of the model without it, and without what hangs on it: what is attached to a body that is left out, what drives
or couples a joint. It exerts nothing, and functions read zero of it; each of these is named.

    cognate run model.acf --skip-unsupported CONTACT     leaves all contacts out",
    },
    Code {
        name: "not_a_state",
        summary: "RELOAD of a file that holds no state saved by cognate",
        explanation: "\
SAVE/SYSTEM=name writes name.state.json beside the results: the model as the commands have left it, what is switched off, and where
the last simulation ended, every number exactly. RELOAD/SYSTEM=name goes on from there. What Adams saves under the same command is an image of its
memory, which no other program can read: obey the commands that led there, and SAVE anew.

    SAVE/SYSTEM=before
    RELOAD/SYSTEM=before",
    },
    Code {
        name: "assembly",
        summary: "the constraints cannot all be satisfied",
        explanation: "\
Before a simulation the parts are moved so that every joint closes. The message names the equation that stays open and by how
much: parts may start too far away, or two constraints contradict each other.

    cognate verify model.adm             names the equations and what is off",
    },
    Code {
        name: "freedom",
        summary: "a kinematic simulation of a mechanism that is free to move",
        explanation: "\
KINEMATIC computes motion from constraints alone. Drive the remaining freedoms by MOTION, or simulate DYNAMIC.

    MOTION/1, JOINT=1, ROTATIONAL, FUNCTION=TIME
    SIMULATE/DYNAMIC, END=1              instead of KINEMATIC",
    },
    Code {
        name: "unavailable",
        summary: "something asked for that cannot be computed here",
        explanation: "\
The message names the function or column; the run goes on without it where that is possible.

    cognate run model.acf --column 'ACCX(20)'     in statics there is no acceleration",
    },
    Code {
        name: "bad_extension",
        summary: "a comment line of ours that means nothing",
        explanation: "\
Comments that begin with `cognate:` say what a dataset has no statement for; other programs skip them. The message says what is
wrong, the advice what an element has.

    ! cognate: IC JOINT/3, X=0.1, X_RATE=2, ANGLE=30D     initial values of a joint: its variables and their rates
    ! cognate: IC MARKER/20, X=1, VZ=-3                   of a marker, in ground
    ! cognate: RIGID arm = PART/2, PART/3                 parts that are one rigid body
    ! cognate: RIGID arm                                  those whose names begin with `arm.`
    ! cognate: JOINT/4 hinge = REVOLUTE, base, arm, AT=0,0,0, AXIS=0,0,1
    ! cognate: MARKER tip = arm, AT=0.3,0,0
    ! cognate: SPRINGDAMPER/1 return = hinge, KT=2/D, ANGLE=30D
    ! cognate: CURVE/9 cam = MATRIX/1, MATRIX/2           pieces that share end points",
    },
    Code {
        name: "rigid_body",
        summary: "a rigid body of several parts that cannot be one",
        explanation: "\
A part is in one rigid body at most, and a rigid body is not part of another. No motion moves its parts against each other. As a
note: a joint within a rigid body has nothing to hold and is switched off. An instance (`arm`, whose parts are `arm.rod` and
`arm.pin`) becomes a rigid body when a line makes a joint, marker or spring-damper on it: it must not lie in one, nor hold one.

    ! cognate: RIGID hand = PART/3, PART/4
    ! cognate: RIGID arm = PART/2, hand          not so: name PART/2, PART/3, PART/4 in one line",
    },
];
