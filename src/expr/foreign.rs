//! TABLES of what people bring along from other languages and programs, with the replacement here:
//! characters, names, units behind numbers.

/// Characters of other languages, with their replacement here.
pub(super) const CHARACTERS: &[(&str, &str)] = &[
    ("^", "the power operator is **, as in 2**3"),
    (
        "<>=",
        "there are no comparisons; IF(a-b: x, y, z) is x where a < b, y where a = b, z where a > b",
    ),
    (
        "&",
        "an ampersand continues a line when it is its last character; there are no logical operators",
    ),
    (
        "|",
        "there are no logical operators; products of IF(...) with values 0 and 1 serve",
    ),
    ("%", "the remainder of a division is MOD(a, b)"),
    (
        "[]{}",
        "parentheses are round; vectors are not part of this language",
    ),
    (";", "arguments are separated by commas"),
    (
        "\"'`“”‘’",
        "there are no strings; elements of the model are named by their numbers",
    ),
    ("?", "a choice is written IF(e1: e2, e3, e4)"),
    (
        "\\",
        "a backslash ends a function in a dataset and does not belong to the expression",
    ),
    ("_@#~", "a name begins with a letter"),
    ("−–—", "this is a dash; the minus sign is -"),
    ("×·∙⋅", "multiplication is written *"),
    ("÷", "division is written /"),
    ("²", "a square is written **2"),
    ("³", "a cube is written **3"),
    ("√", "a square root is written SQRT(x)"),
    ("π", "the number is called PI"),
    ("°", "degrees are written with the suffix D, as in 30D"),
    ("，", "this is a wide comma; write an ordinary one"),
    ("（）", "these are wide parentheses; write ordinary ones"),
    (
        "\u{a0}\u{2009}\u{202f}\u{3000}\u{feff}",
        "this is a special blank; write an ordinary one",
    ),
];

/// Names of other languages, with their replacement in direct-entry functions.
pub(super) const NAMES: &[(&str, &str)] = &[
    (
        "LN",
        "LOG(x) is the natural logarithm, LOG10(x) the decimal one",
    ),
    ("INT", "AINT(x) cuts off, NINT(x) rounds"),
    ("FIX", "AINT(x) cuts off, NINT(x) rounds"),
    ("TRUNC", "AINT(x) cuts off, NINT(x) rounds"),
    (
        "FLOOR",
        "AINT(x) cuts off toward zero, which is the floor where x is not negative",
    ),
    ("CEIL", "AINT(x) cuts off toward zero; AINT(x)+1 is above"),
    ("ROUND", "NINT(x) rounds to the nearest whole number"),
    ("T", "time is TIME here; t belongs to expression functions"),
    ("POW", "powers are written a**b"),
    ("POWER", "powers are written a**b"),
    ("SQR", "a square is written x**2, a square root SQRT(x)"),
    ("CBRT", "a cube root is written x**(1/3) for positive x"),
    (
        "ARCSIN",
        "the inverse functions are ASIN, ACOS, ATAN and ATAN2",
    ),
    (
        "ARCCOS",
        "the inverse functions are ASIN, ACOS, ATAN and ATAN2",
    ),
    (
        "ARCTAN",
        "the inverse functions are ASIN, ACOS, ATAN and ATAN2",
    ),
    (
        "SIND",
        "angles are radians; write SIN(30D) for a literal, SIN(x*DTOR) for a value",
    ),
    (
        "COSD",
        "angles are radians; write COS(30D) for a literal, COS(x*DTOR) for a value",
    ),
    (
        "TAND",
        "angles are radians; write TAN(30D) for a literal, TAN(x*DTOR) for a value",
    ),
    ("DEGREES", "x*RTOD turns radians into degrees"),
    ("RADIANS", "x*DTOR turns degrees into radians"),
    (
        "DEG",
        "x*RTOD turns radians into degrees; a literal takes the suffix D, as in 30D",
    ),
    ("RAD", "x*DTOR turns degrees into radians"),
    ("E", "the base of natural logarithms is EXP(1)"),
    ("FRAC", "the fraction is x-AINT(x)"),
    (
        "ENT",
        "ENT belongs to expression functions; AINT(x) cuts off toward zero",
    ),
    ("ALOG", "LOG(x) is the natural logarithm"),
    ("SGN", "the sign of x is SIGN(1, x)"),
    (
        "HEAVISIDE",
        "STEP(x, x0, h0, x1, h1) rises smoothly; IF(x: 0, 0, 1) jumps",
    ),
    ("STEP3", "the cubic step is STEP, the quintic one STEP5"),
    (
        "AND",
        "there are no logical operators; decide by IF(e1: e2, e3, e4)",
    ),
    (
        "OR",
        "there are no logical operators; decide by IF(e1: e2, e3, e4)",
    ),
    (
        "NOT",
        "there are no logical operators; decide by IF(e1: e2, e3, e4)",
    ),
    (
        "AKIMA",
        "the Akima spline is AKISPL(x, z, id); AKIMA is its name in the I-DEAS profile",
    ),
    (
        "USER",
        "USER(...) calls a compiled subroutine and replaces a whole expression; it cannot be part of one",
    ),
    ("AXU", "AX counts turns by itself"),
    ("AYU", "AY counts turns by itself"),
    ("AZU", "AZ counts turns by itself"),
];

/// Units that are written behind a number.
pub(super) const UNITS: &[&str] = &[
    "um", "mm", "cm", "m", "km", "in", "inch", "ft", "mg", "g", "kg", "tonne", "lb", "lbm", "slug",
    "n", "mn", "kn", "lbf", "kgf", "ms", "s", "sec", "min", "h", "hz", "rpm", "pa", "mpa", "nm",
    "nmm",
];
/// Words for degrees behind a number.
pub(super) const DEGREES: &[&str] = &["d", "deg", "degs", "degree", "degrees"];
/// Words for radians behind a number.
pub(super) const RADIANS: &[&str] = &["rad", "rads", "radian", "radians"];

/// Names that belong to an assignment around an expression, not to the expression.
pub(super) const ASSIGNED: &[&str] = &["FUNCTION", "FUNC", "FUN"];

/// Names of other languages, with their replacement in expression functions.
pub(super) const EXPRESSION_NAMES: &[(&str, &str)] = &[
    ("TIME", "time is t here"),
    ("PI", "the number is radians(180)"),
    (
        "LOG10",
        "log(x) is the decimal logarithm, ln(x) the natural one",
    ),
    ("FLOOR", "ent(x) rounds down"),
    ("AINT", "int(x) cuts off, ent(x) rounds down"),
    (
        "IF",
        "expression functions have no IF; direct-entry functions have",
    ),
    (
        "DTOR",
        "radians(x) turns degrees into radians; sin, cos and tan take degrees",
    ),
    (
        "RTOD",
        "degrees(x) turns radians into degrees; asin, acos and atan give degrees",
    ),
];
