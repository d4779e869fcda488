//! The TABLE of codes of runs: reasons to end early, and warnings.

use super::Code;

/// Codes of runs: reasons to stop, then warnings.
pub static RUN_CODES: &[Code] = &[
    Code {
        name: "bad_definition",
        summary: "a name that cannot be defined with :let",
        explanation: "\
A name begins with a letter and goes on with letters, digits and underscores. Names of the language cannot be given another
meaning. What is defined stands for its whole expression: after `:let w = 1+1`, w*3 is 6.

    :let 2x = 1       write :let x2 = 1
    :let sin = 1      SIN is a name of the language",
    },
    Code {
        name: "nothing_turns",
        summary: "an angle is asked about an axis about which the joint of the two parts does not turn (a warning)",
        explanation: "\
A REVOLUTE or CYLINDRICAL joint turns about the z axes of its markers. WX, WY and WZ are components along the axes of their third
marker, without one along those of ground; AX, AY and AZ are angles about the axes of J. Square to the joint's axis the velocity is zero for
ever and the angle none of turning. Nothing is said where the component along that axis is asked, too.

    JOINT/1, REVOLUTE, I=21, J=11        of a shaft along x of ground
    WZ(21,11)                            write WX(21,11), or WZ(21,11,11)",
    },
    Code {
        name: "interrupted",
        summary: "the user stopped the run",
        explanation: "\
Ctrl-C, or the caller of the library, asked to stop. All rows up to that time are written.

    cognate plot run.csv                 shows what there is",
    },
    Code {
        name: "work_limit",
        summary: "the permitted processor time was used",
        explanation: "\
--limit (Options::limit in the library) permits so much processor time. The message says where the run was then: which phase of
setting up, or at which time, with which method and step, and what kept the steps short. All rows up to that time are written.
A larger --error, or the method that the message names, may come further in the same time.

    cognate run MODEL.acf --limit 60s
    cognate run MODEL.acf --limit 60s --error 1e-4     the same run, with a larger permitted error",
    },
    Code {
        name: "sensor",
        summary: "a SENSOR stopped the simulation",
        explanation: "\
A SENSOR with HALT or RETURN was triggered. That is no failure: the model asked for it.

    SENSOR/1, FUNCTION=DZ(20,11)\\, VALUE=100, GE, HALT",
    },
    Code {
        name: "no_finite_value",
        summary: "a function has no finite value",
        explanation: "\
The message names the function, and the operation with the numbers it met, where one is to blame: SQRT of a negative number,
LOG of zero, a quotient whose divisor goes to zero. A column of results that has no value at some time is NaN or inf there.

    SQRT(DX(1,2))          where DX may be negative: SQRT(MAX(0, DX(1,2)))
    1/DM(1,2)              grows without bound where the markers meet",
    },
    Code {
        name: "locked",
        summary: "the mechanism is locked: its constraints cannot all be kept any longer",
        explanation: "\
At the named position a row of the constraints has become dependent on others, and what drives the mechanism asks for more than
that permits: a crank that pushes a rod beyond its length, a linkage in its dead centre. Prescribe less, or change the lengths.

    JOINT/1 is driven by MOTION/1, FUNCTION=TIME, in a four-bar that cannot turn: FUNCTION=0.5*SIN(TIME)",
    },
    Code {
        name: "error_test",
        summary: "the error of an unknown stays above its tolerance however short the step",
        explanation: "\
The named unknown is not smooth: a function of it jumps, or is noisy. Look at the functions that read it, or ask for a larger
ERROR to see what it does.

    FUNCTION=IF(TIME-1: 0, 0, 10)        write STEP(TIME, 1, 0, 1.01, 10)",
    },
    Code {
        name: "no_convergence",
        summary: "Newton's iteration does not converge however short the step",
        explanation: "\
The equations of an implicit method have no solution near the last state, or their derivatives are wrong there. The named row is
worst. Functions that jump are the usual cause; --method DOP853 does without the iteration.

    cognate run model.acf --method DOP853",
    },
    Code {
        name: "singular",
        summary: "no equation determines an unknown",
        explanation: "\
The matrix of Newton's iteration has no inverse: nothing that moves along the named unknown has mass, and no force depends on it.
`cognate verify` names directions without mass.

    PART/2, MASS=1, CM=20                a part that turns freely needs IP=1,1,1",
    },
    Code {
        name: "endless_switching",
        summary: "a function changes its branch again and again in hardly any time",
        explanation: "\
IF, SIGN, ABS and their like change branch where their argument passes zero. A relay that drives its own argument back across zero
does so without end. Let the function change over a short way: STEP instead of IF.

    IF(VZ(20,11): 1, 0, -1)              write STEP(VZ(20,11), -0.01, 1, 0.01, -1)",
    },
    Code {
        name: "stalled",
        summary: "thousands of steps got hardly any further",
        explanation: "\
The named unknown changes so fast that the run would take for ever: a stiffness too large by orders of magnitude, a mass
nearly zero, or an explicit method for a stiff model. RADAU5 is for stiff models.

    cognate run model.acf --method RADAU5",
    },
    Code {
        name: "too_many_steps",
        summary: "the largest permitted number of steps was taken",
        explanation: "\
The results so far are kept. Permit more steps, or ask for a larger ERROR.

    cognate run model.acf --max-steps 1000000 --error 1e-4",
    },
    Code {
        name: "no_equilibrium",
        summary: "no equilibrium was found",
        explanation: "\
The message names the load that nothing balances, its direction in ground axes, and the part it acts on. A part that nothing holds
falls for ever; a spring or a stop in that direction gives it a place to rest.

    SPRINGDAMPER/1, TRANSLATIONAL, I=20, J=11, K=10, LENGTH=50     gives it a place to rest",
    },
    Code {
        name: "not_at_rest",
        summary: "a model is linearized about a state that moves or is no equilibrium",
        explanation: "\
Eigenvalues say what becomes of a push where nothing else happens. Where a part moves or is about to, they are those of the
equations as they stand at that instant: right for a steady motion of something that is alike all round, such as a rotor, else
only for times in which little changes. The message names the part, or the state, that is farthest from rest.

    cognate linear model.adm --static      about the equilibrium next to the initial configuration
    SIMULATE/STATIC                        likewise in a command file, before LINEAR/EIGENSOL",
    },
    Code {
        name: "unstable_equilibrium",
        summary: "the equilibrium that was found would be left after the smallest push",
        explanation: "\
All loads balance, but in some directions a push is not answered by a force back: a pendulum on its head.
Or it is, and grows all the same: a load that follows what it pushes, a damper whose sign is turned, a control whose
state acts back feed a swing. Then the eigenvalues of `cognate linear --static` decide, and the fastest growth is told.

    PART/2, QG=0,-100,0, …               start on the other side of the hinge
    SFORCE/1, …, FUNCTION=-2*VZ(3,4)     a damper that takes energy",
    },
    Code {
        name: "misaligned",
        summary: "the parts do not fit together as the dataset places them",
        explanation: "\
The markers of a joint are apart, or turned against each other, by the amounts in the message. Assembly moves the parts until they fit.
Typed numbers are off by little; much means a wrong QP, REULER or marker.

    MARKER/31, PART=3, QP=299,200,0      the other marker of the joint is at 300,200,0",
    },
    Code {
        name: "initial_condition",
        summary: "an initial condition that cannot be met, or that is read in another way than documented",
        explanation: "\
The constraints leave no room for what an IC or EXACT asks, initial values contradict each other, which are then met halfway, or the
two numbers of a joint's IC fit the parts better when they are
exchanged: Adams View writes velocity, displacement. An angle begins within half a turn: of more, whole turns do not count.

    JOINT/1, REVOLUTE, I=21, J=11, IC=90D,0        displacement, velocity",
    },
    Code {
        name: "turned",
        summary: "assembly turns parts by more than a degree against the dataset",
        explanation: "\
Joints, primitives and motions hold only where these parts are turned by the angles in the message. Position equations may have
several solutions: a linkage closes on either side. If it is not the one that is meant, place the parts nearer to where they should
be, or give EXACT coordinates.

    PART/3, QG=50,0,0, EXACT=X:Y:PSI, …",
    },
    Code {
        name: "leap",
        summary: "a part is not where the simulation before has left it, or moves otherwise",
        explanation: "\
A command has switched a constraint on, or given a motion another function, that does not hold where the parts are. It holds at once:
parts are put onto it, and velocities change as by a blow, whose force and work no result shows. Let functions begin where the motion
is, and switch joints on where their markers meet.

    MOTION/3, VELOCITY, FUNCTION=…        goes on from where its joint is, if there is no ICDISP",
    },
    Code {
        name: "held_sum",
        summary: "the displacements of a COUPLER or GEAR do not sum up to zero where they are assembled",
        explanation: "\
The sum that the assembled position shows is held from there on. Initial conditions of its joints change it.

    MARKER/22, PART=2, REULER=-90D,0D,0D  turn the marker until the sum begins at zero",
    },
    Code {
        name: "driven_start",
        summary: "a motion begins elsewhere than where its joint is drawn",
        explanation: "\
Before a run the mechanism is driven from where it is drawn to where the motion begins, as by a motor, so that it stays on its
branch; parts stand elsewhere than in the drawing. Where that is not meant, let the function begin at the angle or the length that is
drawn, or draw the parts where the motion has them.

    MOTION/1, JOINT=1, ROTATION, FUNCTION=90D+TIME      where the crank is drawn at 90 deg",
    },
    Code {
        name: "open_reaction",
        summary: "a force or friction reads a reaction that redundant equations leave open",
        explanation: "\
Several joints hold the same direction, and no equation says how they share the load: of all reactions that balance it the smallest
are taken, by least squares. Where only results read them the motion is the same, however it is shared. Here a force or friction
reads one, so that the motion depends on the share. Weaken joints until none is redundant, as `cognate verify` advises, or let bushings
share the load by their stiffness.

    JOINT/2, CYLINDRICAL, I=3, J=10      in place of a second REVOLUTE",
    },
    Code {
        name: "rank_change",
        summary: "the rank of the constraints changes during the run",
        explanation: "\
At the named position a row follows from others, or no longer does: a linkage passes its dead centre, or joints that were redundant
begin to hold. The run goes on; reactions may jump there.

    a parallelogram when all of its links are in one line",
    },
    Code {
        name: "outside_data",
        summary: "a spline is read outside its data",
        explanation: "\
Beyond its first and last X a spline is extrapolated: by a parabola, which grows fast, or by a straight line with
LINEAR_EXTRAPOLATE. Neither was measured. Give data as far as the mechanism goes.

    SPLINE/1, X=0,1,2,3, Y=…, LINEAR_EXTRAPOLATE",
    },
    Code {
        name: "large_angles",
        summary: "the angles of a BUSHING, FIELD or BEAM are too large for its law",
        explanation: "\
The three angles between the markers are taken for rotations about the axes of J. That holds where two of the three are small
(Adams asks for less than 10 degrees); about one axis the markers may turn as far as they like. Beyond, the torque depends on the
order of the axes and does not come from any stored energy: the results are those of a law that nobody meant. Let a joint
carry the large turns, or write the torque as a GFORCE of what is meant.

    BUSHING/1, I=21, J=11, KT=10,10,0      about z it may turn: z of both markers along that axis",
    },
    Code {
        name: "below_rounding",
        summary: "the error that is asked for is smaller than what rounding leaves",
        explanation: "\
The steps so far are as exact as rounding permits. A larger ERROR takes fewer steps for the same digits. Where only few steps are
meant, rates may also change without a slope there: a force that grows as a root of a depth (EXPONENT below 1) is endlessly stiff at the touch.

    cognate run model.acf --error 1e-10  instead of 1e-15",
    },
    Code {
        name: "accuracy_unknown",
        summary: "bars of error hold for a part of the run",
        explanation: "\
Bars of error come from the difference to a further run at another request (--accuracy). That run stopped earlier or later, or for another
reason: the end itself depends on the request. Ask for a smaller ERROR and see which of the two stays.

    cognate run model.acf --accuracy --error 1e-8",
    },
    Code {
        name: "energy_grows",
        summary: "the motion grows without bound",
        explanation: "\
Its kinetic energy grows exponentially from quarter to quarter of the run, beyond all energy that there was. The named force does the
most work in the end: a damper or a controller whose force has the direction of the velocity it reads, or a spring that
pushes away from where it is at rest. A run whose steps thereby get so
short that more than a million would be left is stopped; its results so far are kept.

    FUNCTION=0.5*VZ(20,11,11)            a damper pulls back: -0.5*VZ(20,11,11)",
    },
    Code {
        name: "energy_unsure",
        summary: "the balance of energy does not close",
        explanation: "\
Kinetic and potential energy and all that forces, motions and damping took or gave should balance. What is missing was taken or given by
the steps of the method: large ones damp what swings, or drive it. The numbers are no better than that. Ask for a smaller ERROR.

    cognate run model.acf --error 1e-4  instead of 1e-1",
    },
    Code {
        name: "errors_add_up",
        summary: "errors have added up to many times the request",
        explanation: "\
ERROR is permitted in each step. Where nothing slows the motion down, what each step or swing is off by stays and adds to those before,
along an orbit even as the square of time; where a small push decides what happens, it grows. A further integration at another request
has measured it: the column is off by about as much as the sentence says. Ask for a smaller ERROR; where a number is wanted that depends
on such a motion, take one that does not: a mean, an amplitude, a number of turns.

    cognate run model.acf --error 1e-9   instead of 1e-6",
    },
    Code {
        name: "stiff",
        summary: "stability, not accuracy, sets the steps of an explicit method",
        explanation: "\
A fast motion that has died away still keeps the steps of an explicit method short. The results are as exact as was asked for.
RADAU5 takes steps as long as the slow motion permits; AUTO changes to RADAU5 where that pays.

    cognate run model.acf --method RADAU5",
    },
    Code {
        name: "unknown_constraint",
        summary: "a constraint that a routine computes, or whose curve is not in the dataset",
        explanation: "\
`cognate verify` counts its equations, but cannot tell which motions it forbids: the freedom from the rank is without it.

    GCON/1, FUNCTION=USER(1)             write the equation as an expression",
    },
    Code {
        name: "redundant",
        summary: "an equation of a joint would follow from others if the axes of the model were aligned exactly",
        explanation: "\
Four parallel axes make a four-bar that moves; tilted by any angle, however small, they make a structure. Axes in files are rounded, so an
equation that depends on others but for IC/ERROR (in rad, and as a part of the size of its loop; 1e-4 when nobody says) is left out, and
told with how far it is off. One that is off by more and locks its loop is refused by name. Give the axes all their digits to be rid of it.
Where a structure is meant that is close to one that moves, take every equation as it is.

    IC/ERROR=1E-6
    IC/ERROR=1E-12                       every equation counts as it is",
    },
    Code {
        name: "wrong_way_round",
        summary: "a joint is assembled with axes that point against each other, or a motion at an opposite angle",
        explanation: "\
Its equations hold either way. Turn one of its markers by 180 degrees, or the parts, if the other way is meant.

    MARKER/31, PART=3, REULER=0D,180D,0D",
    },
    Code {
        name: "nothing_to_simulate",
        summary: "a SIMULATE command ends before it begins",
        explanation: "\
The clock shows its end already: END = is a time, DURATION = counts from now.

    SIMULATE/DYNAMIC, END=1
    SIMULATE/DYNAMIC, END=1              write DURATION=1",
    },
    Code {
        name: "reads_zero",
        summary: "a function reads something of what is left out",
        explanation: "\
Left-out elements exert nothing and have no place: functions read zero of them. The message names the function and what it reads.

    FUNCTION=CONTACT(1,0,2,0) + 10       is 10 where CONTACT/1 is left out",
    },
    Code {
        name: "frictionless_statics",
        summary: "statics without the friction of a joint",
        explanation: "\
In statics nothing has crept, so FRICTION holds nothing and loads move its part. To see it hold, let a dynamic simulation come to rest.

    SIMULATE/DYNAMIC, DURATION=5         instead of SIMULATE/STATIC",
    },
    Code {
        name: "gcon_at_rest",
        summary: "a GCON asks for velocities, and the simulation is one at rest",
        explanation: "\
A GCON that reads velocities exerts nothing at rest where it is zero without velocities, as rolling is: statics leaves it out,
so that a sledge slides off its slope. One that is not zero there asks for motion, and nothing can rest: that is an error.

    GCON/1, FUNCTION=WZ(2,1)-5           drives: DEACTIVATE/GCON, ID=1 before SIMULATE/STATIC
    GCON/1, FUNCTION=VX(2,1)-0.3*WY(2,1) rolls, and rests",
    },
    Code {
        name: "convex_hull",
        summary: "a contact takes the convex hull of a shell",
        explanation: "\
Solids of contacts are convex. Hollows of the shell are filled; the message says how far it stands out of the hull.

    GRAPHICS/3, SHELL, RM=20, FILE=half.stl     a hollow body as two convex ones, both in IGEOM",
    },
    Code {
        name: "late_column",
        summary: "a column cannot be computed for rows that are there already",
        explanation: "\
A program named a column after a simulation. Its values in the rows so far follow from their states, where these were kept
(`Options::keep_states`), the model is as it was, and the expression has no past (DELAY, angles that count turns).

    session.add_column(\"DX(41,22)\")?;     before the first simulation it always can be",
    },
    Code {
        name: "bad_sweep",
        summary: "a parameter, value, design or measure of a sweep that means nothing",
        explanation: "\
Nothing has been run. A parameter is a number of the model by its name: an argument of a statement, one number of a list, or
the FUNCTION of an element. Values are A:B:N or a list. A measure is one number made of an expression.

    --set 'PART/2.MASS=1,2,5'            three values
    --set 'VARIABLE/3=0.1:0.5:9'         the FUNCTION of VARIABLE/3 becomes each of nine numbers
    --set 'MARKER/21.QP(1)=10:20:3'      the first number of QP
    --measure 'max(ABS(FX(10,20)))'      max, min, mean, rms, first, last, time_of_max, time_of_min

What a command of the runs changes cannot be a parameter: the command would undo what the sweep sets.",
    },
    Code {
        name: "other_sweep",
        summary: "a table is there already, and is not that of this sweep",
        explanation: "\
A sweep goes on with the table that is there, where model, commands, options, parameters and measures are the same and every
row of it is a point of the design. Otherwise nothing is run and the table is kept.

    cognate sweep crank.acf --set 'PART/2.MASS=1:5:9' --measure 'max(slider.X)' --out mass.csv

To begin anew, name another file, or remove the table and the .sweep.json beside it.",
    },
    Code {
        name: "bad_setup",
        summary: "the file beside a model says something that means nothing",
        explanation: "\
MODEL.toml beside a dataset holds load cases, functions, groups and the set-up of runs. The message says at which line and column
it is mistaken, and what may stand there. Nothing is run before it is mended.

    [cases]
    lift = [\"gravity\", \"MOTION/1\"]      a load case: a list of loads
    [functions.slow]
    expression = \"30*sin(90*t)\"         a function has one of expression, direct, file, points
    [solve]
    end = 2                             a number, without quotation marks

`cognate loads` and `cognate group` write it, and say nothing that it would not understand.",
    },
    Code {
        name: "input_table",
        summary: "a table of inputs that does not fit the plants of the model",
        explanation: "\
`--input plant.csv` gives inputs of plants (PINPUT) over time. Its first row has the names, a second one may have units, all others
are samples: TIME, which increases, and a number for each input. The message says at which line it is mistaken.

    TIME,torque,IN2           a VARIABLE of a PINPUT by its name, and the second one of the PINPUTs
    0,0,12.5
    0.01,0.4,12.5

A column that is no input is refused, not skipped: with its name misspelt the run would be another. Two inputs cannot share a
column, nor two columns an input. Times that do not increase are mistakes, also where a value jumps: two samples close together, or
`--input-hold`, say that.",
    },
    Code {
        name: "plant_inputs",
        summary: "a note that says where the inputs of plants come from",
        explanation: "\
A plant is a mechanism whose inputs (PINPUT) another program gives while it runs. Its VARIABLEs have FUNCTION=0, or USER, until then:
alone it runs with these. `--input` gives them from a table.

    cognate run plant.adm --end 5                                     the inputs stay as their functions say
    cognate run plant.adm --end 5 --input plant.csv                   straight lines between samples
    cognate run plant.adm --end 5 --input plant.csv --input-hold      each sample until the next, as a controller holds it",
    },
    Code {
        name: "unknown_load",
        summary: "a name that is neither a load case nor a load of the model",
        explanation: "\
Loads are gravity, motions, forces, contacts and initial conditions: gravity, MOTION/1, SFORCE/3, IC:PART/2, or the name that the
dataset gives an element. A load that is switched off, or gravity of zero, is none. The advice lists what there is.

    cognate loads MODEL.adm             loads and load cases
    cognate run MODEL.adm --loads all   all loads",
    },
    Code {
        name: "no_load",
        summary: "a choice of loads that leaves none",
        explanation: "\
At least one load must act, otherwise there is nothing to solve for. The load case is empty, or it holds loads that the model no
longer has.

    cognate loads create MODEL.adm lift gravity MOTION/1",
    },
    Code {
        name: "unknown_function",
        summary: "a function that the file beside the model does not have",
        explanation: "\
Functions of yours stand in MODEL.toml. Results of a run are functions too, but they are in the group of their run and cannot give
a load.

    cognate group MODEL.adm                                              groups and functions
    cognate group function MODEL.adm slow --expression '30*sin(90*t)'    makes one",
    },
    Code {
        name: "unknown_group",
        summary: "a group of functions that is not there",
        explanation: "\
Groups stand in MODEL.toml. USER_DEFINED is always there; in plots a run is a group by its name, and so is each set of results.

    cognate group create MODEL.adm Drives slow slider.X
    cognate plot results/MODEL.csv --group Drives",
    },
    Code {
        name: "circular_group",
        summary: "a group that holds itself",
        explanation: "\
A group of groups may hold groups of groups, but none that leads back to itself.

    [groups.All]
    groups = [\"Drives\", \"USER_DEFINED\"]     not \"All\"",
    },
];
