//! The TABLE of codes: every kind of mistake, explained at length for `cognate explain CODE`.
//!
//! A code never changes its meaning. Rows stand in the order in which a text is read; then those
//! about files and commands.

mod files;
mod model;
mod run;
mod view;

pub use files::FILE_CODES;
pub use model::MODEL_CODES;
pub use run::RUN_CODES;
pub use view::VIEW_CODES;

/// A code of a diagnostic, with its explanation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Code {
    /// stable short name
    pub name: &'static str,
    /// one line
    pub summary: &'static str,
    /// when it is given, its cause, and the remedy; then an example with its remedy, indented
    pub explanation: &'static str,
}

/// Finds the row of a code.
pub fn code(name: &str) -> Option<&'static Code> {
    all().find(|code| code.name.eq_ignore_ascii_case(name))
}

/// Iterates over all codes: those of the language and of files, of models, of runs, of command
/// files of Adams View.
pub fn all() -> impl Iterator<Item = &'static Code> {
    CODES
        .iter()
        .chain(FILE_CODES)
        .chain(MODEL_CODES)
        .chain(RUN_CODES)
        .chain(VIEW_CODES)
}

/// The codes of the language, in the order in which a text is read; then those of files and
/// commands.
pub static CODES: &[Code] = &[
    Code {
        name: "bad_char",
        summary: "a character that begins no word of the language",
        explanation: "\
The language consists of numbers, names, the operators + - * / **, parentheses, commas, and the colon of IF. Everything
else is refused where it stands.

    2^3            write 2**3
    TIME > 2       there are no comparisons: IF(TIME-2: a, b, c) is a, b or c as TIME is below, at or above 2
    TIME.GT.2      the same
    5 * & 3        an ampersand continues a line when it is the last character of the line
    TIME\\          the backslash that ends a function in a dataset is not part of the expression

Text from word processors brings dashes instead of minus signs, special blanks and quotation marks; type them anew.",
    },
    Code {
        name: "bad_number",
        summary: "something that begins like a number but is none",
        explanation: "\
A number is digits with an optional decimal point, an optional exponent, and in direct-entry functions an optional suffix D
for degrees: 2, 2., .5, 1.5E-3, 30D, 1.8E2D. Neither a letter, a digit, an underscore nor a point may follow.

    1D3            D is the suffix for degrees and ends the number: write 1E3 for a thousand
    2TIME          multiplication is written: 2*TIME
    1.5E           the exponent has no digits
    1.2.3          a number has one decimal point
    1E400          numbers end at 1.8E308

A sign after D is an operator: 30D-5 is thirty degrees minus five. In expression functions angles are degrees already, and
numbers have no suffix.",
    },
    Code {
        name: "unexpected_token",
        summary: "a word or sign that cannot stand here",
        explanation: "\
Read from the left, the text is an expression up to this place but cannot go on like this.

    2 TIME         two values without an operator: 2*TIME
    2*/3           an operator where a value is needed
    1+2)           a parenthesis is closed that was not opened
    2***3          a power has two stars
    IF(TIME,1,2,3) IF takes a colon after its first part: IF(TIME: 1, 2, 3)
    MAX(1:2)       a colon stands in IF only
    3,5            a decimal point is a point",
    },
    Code {
        name: "unexpected_end",
        summary: "the text ends before the expression does",
        explanation: "\
An operand or a closing parenthesis is missing at the end. The column is one past the last character that is not blank.

    2+             the second operand is missing
    SIN(TIME       the closing parenthesis is missing
                   an empty text is no expression",
    },
    Code {
        name: "unknown_name",
        summary: "a name that is no constant and no function of the language",
        explanation: "\
Names are those of the language alone: constants (TIME, PI, DTOR, RTOD, MODE), IF, functions, and measures of the model.
`cognate functions` lists them. A dataset has no variables of one's own: it reads a VARIABLE of the model by VARVAL(id).
Programs and the prompt can name some: `Names` in Rust, `variables=` in Python, `:let` at the prompt.

Upper and lower case are the same. Names of other languages are answered with what to write: LN is LOG, INT is AINT. The two
languages keep their names apart: time is TIME in direct-entry functions and t in expression functions.

    LN(TIME)       write LOG(TIME)
    omega*TIME     write VARVAL(7)*TIME, with VARIABLE/7, FUNCTION=12.5",
    },
    Code {
        name: "bad_registration",
        summary: "a name of one's own that cannot be registered",
        explanation: "\
A program registers variables, constants and functions for its expressions. A name is a letter, then letters, digits and
underscores; it is registered once, in upper or lower case, and hides none of the language. A constant is finite. A function
takes 1 to 64 arguments; the head of a formula is written f(x, y).

    Names::new().variables([\"TIME\"])          hides TIME of the language: take another name
    Names::new().define(\"hertz\", \"k*x\")      write \"hertz(x, k)\"",
    },
    Code {
        name: "no_derivative",
        summary: "a function of one's own is known by its values only",
        explanation: "\
A derivative was asked for along what a registered closure depends on. Of a closure only values are known, or values and
first derivatives; formulas and laws have all.

    Names::new().function(\"f\", |[x]| x * x)                           has no gradient
    Names::new().function_with_slopes(\"f\", |[x]| (x * x, [2.0 * x]))  has one, but no rates
    Names::new().law(\"f\", |[x]| x * x)                                has both
    Names::new().define(\"f(x)\", \"x**2\")                              the same, in the language",
    },
    Code {
        name: "not_callable",
        summary: "a constant is followed by a parenthesis",
        explanation: "\
TIME, PI, DTOR, RTOD, MODE and t are numbers. A parenthesis after a number means nothing; multiplication is written.

    TIME(1)        write TIME*1, or just TIME",
    },
    Code {
        name: "missing_arguments",
        summary: "a function without its arguments",
        explanation: "\
A function stands before its arguments in parentheses; blanks between them do not matter.

    SIN TIME       write SIN(TIME)
    IF TIME        write IF(TIME: a, b, c)",
    },
    Code {
        name: "empty_argument",
        summary: "nothing stands between two separators",
        explanation: "\
Arguments that may be left out are left out at the end; in the middle a 0 holds their place.

    DX(1,,3)       write DX(1, 0, 3)
    MAX(1,2,)      the last comma is one too many

A dataset continues a line by a comma at the beginning of the next one. That comma belongs to the dataset and not to the
expression: joined carelessly, the text contains two commas in a row. It is not read as 0, which would change the model.",
    },
    Code {
        name: "arity",
        summary: "a function has too many or too few arguments",
        explanation: "\
The message says how many the function takes, and how it is written. Optional arguments stand in brackets there.

    STEP(TIME,0,0,1)     STEP(x, x0, h0, x1, h1) takes five
    POLY(TIME,0)         POLY takes at least one coefficient, and at most 31",
    },
    Code {
        name: "integer_required",
        summary: "an identifier or selector is not a plain integer",
        explanation: "\
Markers, elements, components and orders are chosen when the model is built, not while it runs. So they are written as
integers without sign, and nothing else will do: no expression, no decimal point, no suffix, no parentheses.

    DX(TIME,2)     a marker cannot depend on time
    DX(1,-2)       identifiers have no sign
    VARVAL(1E2)    write VARVAL(100)",
    },
    Code {
        name: "out_of_range",
        summary: "an integer is not one of those that may stand here",
        explanation: "\
Selectors have few values, and identifiers begin at 1, except where 0 stands for ground.

    JOINT(1,2,2,0)       jflag is 0 for the I marker or 1 for the J marker
    JOINT(1,0,9,0)       comp is 1 to 8: magnitude, x, y, z of the force, then of the torque
    AKISPL(TIME,0,1,3)   the order of the derivative is 0, 1 or 2; a family of curves has order 0 only
    DX(0,2)              the first marker is needed",
    },
    Code {
        name: "domain",
        summary: "an operation has no value for these numbers",
        explanation: "\
Division by zero, the logarithm of a negative number, a step without width, a result too large for a number: these are
errors, not values. Found before any evaluation where only constants are involved, and else when it happens; the message
names the operation and the numbers it was given, and the time.

    1/0, 0**-1, (-8)**0.5
    SQRT(-1), LOG(0), ACOS(1.5), ATAN2(0,0)
    STEP(TIME,1,0,1,1)   x0 must be less than x1
    IMPACT(x,v,1,-100,1.5,25,.1)   stiffness is not negative

Only the branch of an IF that is taken is looked at: IF(TIME-1: SQRT(1-TIME), 0, SQRT(TIME-1)) has a value everywhere. To
avoid a domain, guard it so: SQRT(MAX(x, 0)), x/MAX(ABS(y), 1E-9).",
    },
    Code {
        name: "limit_nesting",
        summary: "functions and parentheses lie too deep inside one another",
        explanation: "\
A level is a function call, an IF, or a group in parentheses. The reader takes 256 levels, so that no text can exhaust it;
I-DEAS took 10, which the profile `ideas` enforces. Divide the expression among VARIABLEs, read by VARVAL(id).

    VARIABLE/1, FUNCTION=the inner part
    VARIABLE/2, FUNCTION=ABS(VARVAL(1))     reads it",
    },
    Code {
        name: "limit_symbols",
        summary: "more than 1000 operators, brackets, functions and numbers (profile ideas)",
        explanation: "\
I-DEAS refused longer expressions. The limit is enforced in the profile `ideas` only. Divide the expression among VARIABLEs,
read by VARVAL(id).

    VARIABLE/1, FUNCTION=the first terms
    VARIABLE/2, FUNCTION=VARVAL(1) + the others",
    },
    Code {
        name: "limit_elements",
        summary: "more than 25 different elements of one kind (profile ideas)",
        explanation: "\
I-DEAS took at most 25 different markers, 25 different joints, and so on in one expression. The limit is enforced in the
profile `ideas` only. Divide the expression among VARIABLEs, read by VARVAL(id).

    VARIABLE/1, FUNCTION=what reads the first 25 markers
    VARIABLE/2, FUNCTION=VARVAL(1) + the rest",
    },
    Code {
        name: "limit_length",
        summary: "the text has too many characters",
        explanation: "\
The reader takes a million characters; I-DEAS took 500, which the profile `ideas` enforces. The column is that of the first
character too many.

    cognate eval '1+1' --profile ideas     with the limits of I-DEAS
    cognate eval '1+1'                     without them",
    },
    Code {
        name: "limit_lines",
        summary: "the text has more than 20 lines (profile ideas)",
        explanation: "\
I-DEAS took 20 lines. The limit is enforced in the profile `ideas` only. The column is that of the first character of line
21, counted from the beginning of the text.

    VARIABLE/1, FUNCTION=the first twenty lines
    VARIABLE/2, FUNCTION=VARVAL(1) + the others",
    },
    Code {
        name: "missing_value",
        summary: "an input of the expression was not given a value",
        explanation: "\
TIME, MODE and the measures of a model come from outside. At a prompt they are given: --time for TIME, marker states for DX
and its relatives, or by name.

    cognate eval 'SIN(TIME)' --time 0.5
    cognate eval 'DX(1,2)' --markers m.json      m.json: {\"1\": {\"r\": [3,0,0]}, \"2\": {}}",
    },
    Code {
        name: "needs_history",
        summary: "the value depends on the past, which is not known here",
        explanation: "\
DELAY reads values of earlier times, and AX, AY, AZ and INCANG count turns. In a simulation the solver keeps that history. A
single evaluation has none: DELAY is refused, and the angles are principal values between -PI and PI.

    cognate run model.acf --column 'DELAY(DX(1,2), 0.1, 0)'      in a run there is a past",
    },
    Code {
        name: "unknown_element",
        summary: "a spline or curve is named that does not exist",
        explanation: "\
AKISPL, CUBSPL, INTERP, CURVE and INVPSD read data by identifier. The data must be there: a SPLINE or CURVE of the model, or
the file given with --splines.

    AKISPL(TIME, 0, 7, 0)     needs SPLINE/7, X=0,1,2,3, Y=0,1,4,9",
    },
    Code {
        name: "spline_data",
        summary: "the data of a spline make no curve",
        explanation: "\
A spline has at least four points, x increases from point to point, and so does z from curve to curve; every curve has as
many values as there are x.

    SPLINE/1, X=0,1,1,2, Y=0,1,2,3     x must grow: 0,1,1.001,2
    SPLINE/1, X=0,1,2, Y=0,1,2         four points at least",
    },
    Code {
        name: "degrees_or_radians",
        summary: "an angle looks like degrees where radians are meant, or the other way round (a warning)",
        explanation: "\
Direct-entry functions take and give radians; a literal with the suffix D is degrees: SIN(30D). Expression functions take and
give degrees: sin(30). SIN(30) is a legal direct-entry function, but thirty radians are rarely meant. The same holds for
REULER, IC and ANGLE of a dataset and for the FUNCTION of a MOTION that turns: 90D is a quarter of a turn, 90 are 14.3 turns.

    SIN(30)                    write SIN(30D)
    MARKER/1, REULER=90,0,0    write REULER=90D,0,0",
    },
    Code {
        name: "doubtful_precedence",
        summary: "operators bind otherwise than the writing suggests (a warning)",
        explanation: "\
** binds tighter than a sign before it and than / after it, and groups from the right:

    -2**2          is -(2**2) = -4
    x**1/2         is (x**1)/2; a square root is x**(1/2) or SQRT(x)
    2**3**2        is 2**(3**2) = 512
    2**-1          is 2**(-1) = 0.5; FORTRAN 77 refuses two operators side by side",
    },
    Code {
        name: "doubtful_number",
        summary: "the suffix for degrees stands where an exponent may be meant (a warning)",
        explanation: "\
D ends a number and makes degrees of it; a sign behind it is an operator. FORTRAN writes exponents of double precision
with D, the function language does not:

    1.0D-3         is one degree minus three, -2.98; a thousandth is 1.0E-3",
    },
    Code {
        name: "doubtful_comment",
        summary: "an exclamation mark cuts off what may be meant as a part of the expression (a warning)",
        explanation: "\
! begins a comment that runs to the end of the line. There is no factorial.

    5!*2           is 5
    5 ! *2         is 5 with a comment, and nothing is said",
    },
    Code {
        name: "rate_of_another",
        summary: "IMPACT or BISTOP is damped by a rate that is not that of its distance (a warning)",
        explanation: "\
The second argument of IMPACT and BISTOP is the rate of the first. With the velocity of another marker, or along another
axis, the contact damps what does not touch, and may feed energy into what does.

    IMPACT(DZ(20,10), VZ(30,10), …)      the rate of DZ(20,10) is VZ(20,10)
    IMPACT(DM(2,1), VX(2,1), …)          the rate of DM(2,1) is VR(2,1)

Nothing is said where one of the two is a sum of several measures, or comes from a VARIABLE.",
    },
    Code {
        name: "constant_step",
        summary: "STEP, STEP5 or HAVSIN runs over a number, and TIME stands elsewhere (a warning)",
        explanation: "\
The first argument is what runs: the step is done where it passes the second and the fourth. A number there passes nothing.

    STEP(0, 0, TIME, 1, 10)              write STEP(TIME, 0, 0, 1, 10)",
    },
    Code {
        name: "angles_of_several_axes",
        summary: "AX, AY or AZ of the same markers stand in one expression (a warning)",
        explanation: "\
AX, AY and AZ are angles of projections: each is the angle of turning if the markers turn about that axis alone. Two of
them together describe an orientation only while both are small. YAW, PITCH and ROLL, or PSI, THETA and PHI, are the
angles of one sequence of turns.

    AX(1,2) + AY(1,2)          write PITCH(1,2), ROLL(1,2)",
    },
    Code {
        name: "no_model",
        summary: "a command file names no dataset",
        explanation: "\
A command file begins with FILE/MODEL=name, after blank lines or comments; or, as answers to the old prompts, with the
name of the dataset on its first line and that of the results on its second.

    FILE/MODEL=slider_crank
    SIMULATE/DYNAMIC, END=1",
    },
    Code {
        name: "no_end",
        summary: "a simulation has no end, or one that is over",
        explanation: "\
The clock goes on from one simulation to the next. END is a time of that clock, DURATION a time from now on:

    SIMULATE/DYNAMIC, END=2, STEPS=100
    SIMULATE/DYNAMIC, END=3, STEPS=100        one more second
    SIMULATE/DYNAMIC, DURATION=1, STEPS=100   one more second",
    },
    Code {
        name: "file_unreadable",
        summary: "a file cannot be read",
        explanation: "\
It does not exist, is a folder, or may not be read by this user; the message has the system's own words. Names of
files are taken from where the command runs.

    cognate run modell.acf     is it called model.acf? ls shows the files",
    },
    Code {
        name: "file_unwritable",
        summary: "a file cannot be written",
        explanation: "\
The folder does not exist, or this user may not write there, or the disk is full; the message has the system's own
words. A file is written beside its place and then moved there, so that a failure leaves the old one as it was.

    cognate run model.acf --out /tmp/results",
    },
    Code {
        name: "file_exists",
        summary: "a file that is to be written is there already, and this program has not written it",
        explanation: "\
No command replaces what it, or another command of this program, has not written as it stands there: name another file or
folder, or let --overwrite replace it. What is replaced is kept once, with a ~ behind its name. The files of a run are known
by its record, all others by .cognate.json beside them; a file that was changed or copied elsewhere is nobody's of this
program.

    cognate draw model.adm -o picture.svg --overwrite",
    },
    Code {
        name: "is_input",
        summary: "a file that is to be written is one that the same command reads",
        explanation: "\
The model, its commands and whatever they name (datasets, meshes, points of splines and curves, saved states, the set-up
beside a model) are never replaced by the command that reads them, under whatever name and through whatever link, also not
with --overwrite. Name another file.

    cognate fmt model.adm -o tidy.adm",
    },
    Code {
        name: "outside_folder",
        summary: "a name in a command file leads out of the folder of the results",
        explanation: "\
OUTPUT_PREFIX and LINEAR, FILE= name files of results. Command files come from others: names with a path of their own
machine, or with .. in them, are taken without their folders, so that nothing lands where it was not sent. --trust-paths
takes them as they stand.

    OUTPUT_PREFIX=../../runs/first        files are called first.csv, first.res …",
    },
    Code {
        name: "cut_off",
        summary: "a file of results ends too early; its whole rows are read",
        explanation: "\
The program that wrote it was ended, the disk was full, or a copy broke off. A row whose end is missing is left out, since
its last number may lack digits; so is a last line of a .csv without a line break. An end between two rows does not show.

    cognate convert results/model.csv.part1 rows.csv",
    },
    Code {
        name: "result_format",
        summary: "the name of a file tells no format of results that is known",
        explanation: "\
The ending of a file's name tells its format. Read are .res (XML and the old text form), .gra and .csv; written are .csv,
.json, .res and .msg.

    cognate convert run.res run.csv",
    },
    Code {
        name: "result_syntax",
        summary: "a file of results is damaged or of another format than its name says",
        explanation: "\
The message has the line, where there is one. In .csv files every row has as many cells as the first, which holds the
names; a second row may hold units; all else are numbers. In .res files every component has a number of its own, and
every step has as many values as there are components. A file that ends too early is read up to its last whole row
(cut_off), if it has one.

    time,x
    0,1
    0.1           a cell is missing: 0.1,2",
    },
    Code {
        name: "unknown_column",
        summary: "the results have no column of this name",
        explanation: "\
Columns are called by the text of their expression, or ENTITY.COMPONENT as in PART_2_XFORM.X. Blanks and upper or
lower case do not matter. The advice names columns that are spelled alike, or the first of all.

    cognate plot run.csv --y slider.x       cognate plot run.csv --list prints the names",
    },
    Code {
        name: "no_motion_set",
        summary: "the results lack functions from which the motion of a marker follows",
        explanation: "\
The motion of a marker relative to another follows from the motions of their parts: sets of six functions, three of
translation and three of rotation, for displacements, for velocities and for accelerations. Velocities need the set of
displacements too, accelerations all three. A table that has requests alone has none of them.

    RESULTS/XRF                                   the dataset asks for all sets
    cognate run model.acf --format res,csv        so does the format
    RESULTS/XRF, NOACCELERATIONS                  then there are no accelerations of markers",
    },
    Code {
        name: "other_model",
        summary: "a model is not the one that the results are of",
        explanation: "\
Results do not hold the places of markers in their parts: these are read from the model that the record of the run
names. Where its markers are not those of the run, what follows would be wrong, and it is refused.

    cognate motion out/run.res --of MARKER/20 --relative-to MARKER/10 --model kept/model.acf",
    },
    Code {
        name: "unknown_run",
        summary: "there is no run of this name",
        explanation: "\
A run is named as its files are, with their folder: results/crank stands for results/crank.json, the record, and all
files that the record claims. One of these files names it, too.

    cognate runs results                          lists the runs of a folder
    cognate runs delete results/crank",
    },
    Code {
        name: "run_exists",
        summary: "a file of the new name of a run is there already",
        explanation: "\
Renaming a run renames its record and its files. None of them replaces a file that is there, whoever made it.

    cognate runs rename results/crank stiff       refused while results/stiff.csv is there",
    },
    Code {
        name: "run_in_use",
        summary: "a run that a program is writing is to be renamed or deleted",
        explanation: "\
While a run is being written its record and its parts belong to the program that writes them. `cognate runs` says which runs
are being written; one whose program was ended from outside is cut off, and may be deleted.

    cognate runs delete results/crank       refused while results/crank is being written",
    },
    Code {
        name: "no_shared_time",
        summary: "two runs have no output time in common",
        explanation: "\
Runs are compared at the output times that both have, where nothing has to be estimated. Where there are none, the
second can be taken as straight between its outputs, which adds the error of that.

    cognate runs compare a b --interpolate",
    },
    Code {
        name: "unknown_sequence",
        summary: "the results have no sequence of this name",
        explanation: "\
A sequence holds the rows of one simulation: modelInput_001, initialConditions_001, static_001, kinematic_001,
dynamic_001 and so on. The advice names those that are there.

    cognate convert run.res run.csv --sequence dynamic_001",
    },
    Code {
        name: "empty_plot",
        summary: "there is nothing to plot",
        explanation: "\
The columns have no rows, or no value in them is finite.

    SQRT(DX(1,2))     has no value while DX is negative: SQRT(MAX(0, DX(1,2)))",
    },
    Code {
        name: "no_positions",
        summary: "results that do not say where the bodies are",
        explanation: "\
A picture needs the position and the angles of every body: the sets NAME_XFORM with X, Y, Z, PSI, THETA, PHI. Tables of
requests (.csv) do not have them.

    cognate animate run.csv --model m.adm       only what was asked for: no positions
    cognate run m.acf --format res              writes every part
    cognate animate run.res --model m.adm       shows that run
    cognate animate m.acf                       solves and shows at once",
    },
    Code {
        name: "picture_format",
        summary: "the name of a file tells no format of pictures that is known",
        explanation: "\
Pictures are written as .svg, .png and .pdf, which the ending of a file's name tells. PNG and PDF are features of the
program: one that was built without them says so, and writes .svg.

    cognate plot run.csv --y slider.X --out x.txt      is it a picture? --out x.png
    cognate convert run.csv run.json                   results in other formats",
    },
    Code {
        name: "plot_failed",
        summary: "a plot could not be drawn",
        explanation: "\
The drawing library refused; the message has its words. Please report it with the data.

    cognate plot run.csv --y slider.X        in the terminal works without the library",
    },
    Code {
        name: "bad_data",
        summary: "a JSON file of markers or splines is not of the form that is expected",
        explanation: "\
Markers, all vectors in ground, what is left out is zero; e313 are the 3-1-3 angles in radians, A the rows of the
matrix whose columns are the axes of the marker:

    {\"12\": {\"r\": [0.1, 0, 0], \"v\": [1, 0, 0], \"w\": [0, 0, 2], \"e313\": [0.5, 0, 0]}}

Splines; with z, y is a list of curves; end is natural, not-a-knot or periodic, extrap is parabolic or linear:

    {\"1\": {\"x\": [1, 2, 3, 4], \"y\": [0, 2, 1, 3], \"end\": \"natural\", \"extrap\": \"linear\"}}",
    },
    Code {
        name: "approximate",
        summary: "something is solved by a simpler law than the dataset asks for",
        explanation: "\
The run goes on, and its results are those of the simpler law, which the message names.

    BEAM, FORMULATION=STRING or NONLINEAR    the linear beam, which tension does not stiffen
    FRICTION, FORMULATION=LUGRE              the law of sticking and sliding, which does not lag behind the velocity
    CONTACT, POISSON                         the impulses of restitution as a damper that works while bodies overlap",
    },
    Code {
        name: "bad_range",
        summary: "a range of times that has no samples, or too many",
        explanation: "\
A range is first:last:step, as in 0:2:0.01. The step leads from the first to the last time: it is negative when time runs
backwards, and never zero. There are at most ten million samples.

    0:2:-0.01         write 0:2:0.01
    2:0:0.01          write 2:0:-0.01",
    },
    Code {
        name: "motion_reads",
        summary: "the function of a MOTION reads something that is no function of time",
        explanation: "\
A MOTION prescribes what a joint or a marker does, whatever force that takes. Its rate and acceleration are those of its
function, so the function may read TIME, MODE, numbers of an ARRAY, splines of these, VARIABLEs of these, and states
(DIF, ARYVAL) whose rates read nothing else; nothing that moves.

    MOTION/1, JOINT=1, FUNCTION=0.5*DX(4,5)      write a COUPLER, or GCON/1, FUNCTION=AZ(2,3)-0.5*DX(4,5)
    MOTION/1, JOINT=1, FUNCTION=DIF(3)           where DIFF/3 reads places: write an SFORCE that follows DIF(3)",
    },
    Code {
        name: "gcon_reads",
        summary: "the function of a GCON reads something that is neither place nor velocity",
        explanation: "\
A GCON says that an expression is zero, always: it may read displacements, angles and velocities of markers, TIME, MODE,
numbers of an ARRAY, splines of these, and VARIABLEs of these. Accelerations, forces, and states with equations of their
own are refused.

    GCON/1, FUNCTION=VX(2,1)-0.3*WY(2,1)    rolls: an equation of velocities, which holds no position
    GCON/1, FUNCTION=DM(2,1)-0.5            a rod of length 0.5",
    },
    Code {
        name: "coincident",
        summary: "a force acts along the line between two markers that coincide",
        explanation: "\
SPRINGDAMPER and SFORCE with TRANSLATION act along the line from J to I. Where the markers coincide as the model begins
there is no such line. A force that is zero there (a spring without free length and preload) is told and goes on; any other
has no direction.

    SPRINGDAMPER/1, TRANSLATION, I=21, J=11, K=100, LENGTH=0.5     which way should it push?
    MARKER/21, PART=2, QP=0,0,0.5                                  up",
    },
    Code {
        name: "curve_data",
        summary: "the data of a CURVE make no curve that can be followed",
        explanation: "\
A CURVE needs a MATRIX in the dataset with one row x, y, z for each point: at least four, neighbours apart, the last like the
first where it is CLOSED. Through points the order is 4 (cubic) or 2 (straight lines); for control points it is 2 to 10.
FUNCTION=USER needs a routine that is not part of the dataset: load it (--routines), or tabulate the curve in a MATRIX.

    CURVE/1, CLOSED, ORDER=4, MATRIX=1, CURVE_POINTS",
    },
    Code {
        name: "curve_left",
        summary: "a contact lies beyond an end of an open curve",
        explanation: "\
PTCV and CVCV hold the contact on the curve; an open curve ends. The message says at which end and by how much it is missed.
Extend the curve well past the expected contact (about 20% on each side), or make it CLOSED where it returns to itself.
In a run the same stops the simulation; results up to the end of the curve are kept.

    CURVE/1, OPEN, CURVE_POINTS, MATRIX=1        add points at both ends, or CLOSED",
    },
    Code {
        name: "no_common_tangent",
        summary: "two curves of a CVCV have no common tangent near where they should touch",
        explanation: "\
A CVCV makes two curves touch: in one point, with one tangent there. Where no pair of places has parallel tangents square to
the line between them, there is nothing to hold. Bring the parts nearer to where they touch, or name the places of the first
contact with IDISP and JDISP. Two straight lines touch everywhere and nowhere: one of the curves has to be curved.

    CVCV/1, ICURVE=1, IRM=11, JCURVE=2, JRM=21, IDISP=0,20,0, JDISP=0,0,0",
    },
    Code {
        name: "curves_not_coplanar",
        summary: "two curves of a CVCV or CONTACT do not lie in one plane",
        explanation: "\
The curves of a CVCV lie in the x-y planes of IRM and JRM, z = 0, those of a CONTACT in the planes of the markers of their
GRAPHICS (CRM, CM), and these planes must be one and the same all the time.
Neither turns parts to make them so: that is up to joints, such as PLANAR, or REVOLUTE with parallel axes.

    MARKER/21, PART=2, QP=0,0,5      the plane z = 0 of this marker is 5 off: QP=0,0,0",
    },
    Code {
        name: "motion_jumps",
        summary: "what a MOTION prescribes, or its velocity, jumps within the run",
        explanation: "\
A displacement that jumps takes an infinite velocity, a velocity that jumps an infinite force: there is no motion
between. The message names the times. Join the pieces by a function that is smooth, such as STEP5.

    IF(TIME-1: 0, 0, 1)                 jumps: STEP5(TIME, 1, 0, 1.1, 1)
    MAX(0, TIME-1)                      its velocity jumps: POLY(STEP5(TIME,1,0,1.2,0.1), 0, 1)+MAX(0, TIME-1.2), or the like
    MOTION/1, VELOCITY, FUNCTION=STEP(TIME,0,0,1,2)      a velocity may bend, it must not jump

`--piecewise` runs it all the same, from piece to piece; the record of the run then lists the jumps. Where the acceleration
jumps it runs, with a warning, and forces jump.",
    },
    Code {
        name: "method",
        summary: "the method of integration is not known",
        explanation: "\
`--method` and INTEGRATOR/… name a method: AUTO (the program chooses), DOP853, RADAU5. The names of Adams are understood
too: GSTIFF, WSTIFF, HASTIFF, CONSTANT_BDF, HHT and NEWMARK are done by RADAU5, ABAM and RKF45 by DOP853.

    cognate run model.acf --method DOPRI     write --method DOP853",
    },
    Code {
        name: "user_routine",
        summary: "USER stands for a routine that is not part of the dataset",
        explanation: "\
FUNCTION=USER(...) calls a compiled routine that is no part of the dataset. There are four ways on:

    --routines forces.so                     the library that has it (docs/routines.md); its code is run, with your rights
    --zero-user                              what it would compute is zero: structure, weights and stiffness can be looked at
    session.register(\"SFORCE/3\", ...)       a closure of yours computes it, in a program that uses cognate as a library
    DEACTIVATE/SFORCE, ID=3                  in the command file: without the element

A closure is found by the element's name, by the text of its ROUTINE, or by the first number of USER. A REQUEST that nobody
computes moves nothing: the model is solved, and the columns that are missing are told.",
    },
    Code {
        name: "loop",
        summary: "a function depends on itself and no value solves that",
        explanation: "\
VARIABLEs that read each other, forces that read accelerations or reactions, and inputs that a system feeds through are
solved together. That needs a solution, and one near where the search begins: the IC of a VARIABLE, else its last value.

    VARIABLE/1, FUNCTION=VARVAL(1)+1         has no solution
    VARIABLE/1, FUNCTION=VARVAL(1)**2-2      has two: IC=3 leads to 2, IC=-3 to -1",
    },
    Code {
        name: "linear",
        summary: "the model cannot be linearized in this state",
        explanation: "\
LINEAR needs finite derivatives of everything that moves: a force along the line between two markers has none where they
coincide, a square root none at zero. Settle the model first (SIMULATE/STATIC, `cognate linear --static`), or move it.

    SIMULATE/STATIC
    LINEAR/EIGENSOL",
    },
    Code {
        name: "usage",
        summary: "a command is not used as it can be used",
        explanation: "\
`cognate --help` lists the commands, `cognate COMMAND --help` shows one with examples; in the REPL `:help`.

    cognate run --help",
    },
    Code {
        name: "terminal",
        summary: "the terminal cannot be used for the REPL",
        explanation: "\
The message has the system's own words. Lines can be piped in instead: `cognate repl < session.txt`.

    echo 'SIN(TIME)' | cognate repl",
    },
    Code {
        name: "bug",
        summary: "the program found a mistake of its own",
        explanation: "\
Something happened that its authors held to be impossible. Please report the command, its input, and what was printed.

    cognate run model.acf 2> report.txt     and report.txt with model.acf and model.adm",
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_explained() {
        for (k, row) in CODES.iter().enumerate() {
            assert_eq!(code(row.name), Some(row));
            assert!(
                CODES[..k].iter().all(|earlier| earlier.name != row.name),
                "{}",
                row.name
            );
            assert!(
                !row.summary.ends_with('.')
                    && row.explanation.ends_with(|c: char| !c.is_whitespace())
            );
            assert!(
                row.explanation
                    .lines()
                    .all(|line| line.chars().count() <= 125),
                "{}",
                row.name
            );
        }
    }
}
