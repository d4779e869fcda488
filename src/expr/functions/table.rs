//! The TABLE of functions of numbers. A row is name, arguments, continuity, equation, body generic
//! over the scalar, examples.
//!
//! `forbid` names arguments for which there is no value although the body would yield one: the
//! value becomes NaN. `domain` names arguments for which the body yields NaN or infinity by itself;
//! its text is for people.

use super::step::{cubic, haversine, quintic, step, sweep_turns};
use super::{
    Continuity, Example, Family, Further, Row,
    contact::{AnyExponent, bistop, impact},
    series,
};
use crate::expr::ast::Dialect;
use crate::expr::signature::{Argument, Element};
use crate::scalar::{Mask, Scalar};
use std::f64::consts::{LN_10, PI};

/// A degree, in rad.
const DEGREE: f64 = PI / 180.0;
/// Number of further arguments without a limit.
const UNLIMITED: usize = usize::MAX - 2;

/// Describes a parameter: an expression, or the kind that the row gives in parentheses.
macro_rules! parameter {
    ($name:ident $meaning:literal) => {
        Argument::number(stringify!($name)).meaning($meaning)
    };
    ($name:ident $meaning:literal id) => {
        Argument::identifier(stringify!($name), Element::Array)
            .or("none")
            .meaning($meaning)
    };
}

/// Generates the enum, the rows and the evaluation from the table.
macro_rules! functions {
    ($(
        [$family:ident $dialect:ident]
        $(
            $(#[doc = $doc:literal])+
            $variant:ident $name:literal (
                $($arg:ident: $meaning:literal),+
                $(; $optional:ident: $optional_meaning:literal)?
                $(| $further:ident: $further_meaning:literal, $least:literal..=$most:expr)?
            )
            $continuity:ident $equation:literal
            $body:block
            $(forbid $forbidden:expr => $reason:literal,)*
            $(domain $outside:expr => $remark:literal,)*
            $(example $source:literal => $value:expr,)*
        )+
    )+) => {
        /// A function of numbers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        pub enum Function {
            $($($(#[doc = $doc])+ $variant,)+)+
        }

        impl Function {
            /// All functions, in the order of the table.
            pub const ALL: &'static [Function] = &[$($(Function::$variant,)+)+];

            /// Returns the row of this function in the table.
            pub fn row(self) -> &'static Row {
                static ROWS: &[Row] = &[$($(Row {
                    function: Function::$variant,
                    name: $name,
                    dialect: Dialect::$dialect,
                    family: Family::$family,
                    parameters: &[
                        $(parameter!($arg $meaning),)+
                        $(parameter!($optional $optional_meaning id))?
                    ],
                    further: functions!(@further $($further $further_meaning $least $most)?),
                    continuity: Continuity::$continuity,
                    doc: concat!($($doc, "\n"),+),
                    equation: $equation,
                    examples: &[$(Example { source: $source, value: $value },)*],
                },)+)+];
                &ROWS[self as usize]
            }

            /// Evaluates the function over any number. A wrong number of arguments gives NaN.
            #[inline]
            pub fn eval<S: Scalar>(self, args: &[S]) -> S {
                match self {
                    $($(Function::$variant => {
                        functions!(@bind args, $($arg)+, $($further)?);
                        #[allow(unused_mut)]
                        let mut value = $body;
                        $(value = guard($forbidden, value);)*
                        value
                    })+)+
                }
            }

            /// Returns the reason why these arguments have no value, as far as they are known. An
            /// unknown one is NaN.
            pub fn violation(self, args: &[f64]) -> Option<&'static str> {
                type S = f64;
                match self {
                    $($(Function::$variant => {
                        functions!(@bind_known args, $($arg)+, $($further)?);
                        $(if $forbidden { return Some($reason); })*
                        $(if $outside { return Some($remark); })*
                        None
                    })+)+
                }
            }
        }
    };
    (@further) => { None };
    (@further $name:ident $meaning:literal $least:literal $most:expr) => {
        Some(Further { name: stringify!($name), meaning: $meaning, least: $least, most: $most })
    };
    (@bind $args:ident, $($arg:ident)+, $($further:ident)?) => {
        let Some((&[$($arg,)+], others)) = $args.split_first_chunk() else {
            return S::constant(f64::NAN);
        };
        let _ = (others, $($arg,)+);
        $(let $further: &[S] = others;)?
    };
    (@bind_known $args:ident, $($arg:ident)+, $($further:ident)?) => {
        let (&[$($arg,)+], others) = $args.split_first_chunk()?;
        let _ = (others, $($arg,)+);
        $(let $further: &[S] = others; let _ = $further;)?
    };
}

/// Returns NaN where the mask is true.
#[inline(always)]
fn guard<S: Scalar>(forbidden: S::Mask, value: S) -> S {
    match forbidden.known() {
        Some(false) => value,
        Some(true) => S::constant(f64::NAN),
        None => S::select(forbidden, S::constant(f64::NAN), value),
    }
}

/// Returns the larger; the first on a tie; NaN if either is.
#[inline(always)]
fn larger<S: Scalar>(a: S, b: S) -> S {
    S::choose(a.lt(b), || b, || S::choose(b.le(a), || a, || a + b))
}

/// Returns the smaller; the first on a tie; NaN if either is.
#[inline(always)]
fn smaller<S: Scalar>(a: S, b: S) -> S {
    S::choose(b.lt(a), || b, || S::choose(a.le(b), || a, || a + b))
}

functions! {
    [Intrinsic Function]

    /// Absolute value.
    Abs "ABS" (x: "any number") C0 "|x|" { x.abs() }
    example "ABS(-2.5)" => 2.5,

    /// Arc cosine, between 0 and π.
    Acos "ACOS" (x: "cosine, between -1 and 1") Smooth "arccos x" { x.acos() }
    domain S::one().lt(x.abs()) => "ACOS takes numbers between -1 and 1",
    example "ACOS(0.5)" => PI / 3.0,
    example "ACOS(-1)" => PI,

    /// Whole part, toward zero.
    Aint "AINT" (x: "any number") Jump "trunc x" { x.trunc() }
    example "AINT(4.6)" => 4.0,
    example "AINT(-6.5)" => -6.0,

    /// Nearest whole number, halves away from zero.
    Anint "ANINT" (x: "any number") Jump "round x" { x.round() }
    example "ANINT(2.5)" => 3.0,
    example "ANINT(-2.5)" => -3.0,

    /// Arc sine, between -π/2 and π/2.
    Asin "ASIN" (x: "sine, between -1 and 1") Smooth "arcsin x" { x.asin() }
    domain S::one().lt(x.abs()) => "ASIN takes numbers between -1 and 1",
    example "ASIN(-0.5)" => -PI / 6.0,

    /// Arc tangent, between -π/2 and π/2.
    Atan "ATAN" (x: "tangent") Smooth "arctan x" { x.atan() }
    example "ATAN(1)" => PI / 4.0,

    /// Angle of the point (x, y), above -π up to π.
    ///
    /// A zero y, also -0, counts as positive, so that ATAN2(0, -1) is +π.
    Atan2 "ATAN2" (y: "second coordinate of the point: the sine's side", x: "first coordinate of the point: the cosine's side") Jump "arg(x + i y)" { (y + S::zero()).atan2(x) }
    forbid x.same(S::zero()).and(y.same(S::zero())) => "the point (0, 0) has no angle",
    example "ATAN2(1,-1)" => 2.356194490192345,
    example "ATAN2(0,-1)" => PI,

    /// Cosine, of radians.
    Cos "COS" (x: "angle in radians; 30D is 30 degrees") Smooth "cos x" { x.cos() }
    example "COS(PI)" => -1.0,

    /// Hyperbolic cosine.
    Cosh "COSH" (x: "any number") Smooth "(exp x + exp(-x))/2" { x.cosh() }
    example "COSH(0)" => 1.0,

    /// Positive difference.
    Dim "DIM" (a: "number to take from", b: "number that is taken away") C0 "max(a - b, 0)" { S::choose(a.le(b), S::zero, || a - b) }
    example "DIM(20,5)" => 15.0,
    example "DIM(3,7)" => 0.0,

    /// Exponential.
    Exp "EXP" (x: "exponent, up to 709") Smooth "exp x" { x.exp() }
    example "EXP(0)" => 1.0,

    /// Natural logarithm.
    Log "LOG" (x: "positive number") Smooth "ln x" { x.ln() }
    domain x.le(S::zero()) => "LOG takes positive numbers",
    example "LOG(10)" => LN_10,

    /// Decimal logarithm.
    Log10 "LOG10" (x: "positive number") Smooth "log10 x" { x.log10() }
    domain x.le(S::zero()) => "LOG10 takes positive numbers",
    example "LOG10(1000)" => 3.0,

    /// The largest of two or more numbers.
    Max "MAX" (a: "number", b: "number" | c: "further numbers", 0..=UNLIMITED) C0 "max(a, b, ...)" {
        let mut largest = larger(a, b);
        for &x in c {
            largest = larger(largest, x);
        }
        largest
    }
    example "MAX(1,3,2)" => 3.0,

    /// The smallest of two or more numbers.
    Min "MIN" (a: "number", b: "number" | c: "further numbers", 0..=UNLIMITED) C0 "min(a, b, ...)" {
        let mut smallest = smaller(a, b);
        for &x in c {
            smallest = smaller(smallest, x);
        }
        smallest
    }
    example "MIN(1,3,2)" => 1.0,

    /// Remainder with the sign of the first argument.
    Mod "MOD" (a: "number that is divided; gives the sign", b: "divisor; not 0") Jump "a - trunc(a/b) b" { a.rem(b) }
    domain b.same(S::zero()) => "the remainder of a division by zero",
    example "MOD(-7,3)" => -1.0,
    example "MOD(7,-3)" => 1.0,

    /// Nearest whole number, halves away from zero (the same as ANINT).
    Nint "NINT" (x: "any number") Jump "round x" { x.round() }
    example "NINT(4.78)" => 5.0,

    /// Magnitude of the first argument with the sign of the second; zero counts as positive.
    Sign "SIGN" (a: "number that gives the magnitude", b: "number that gives the sign") Jump "|a| if b >= 0, else -|a|" {
        S::choose(b.lt(S::zero()), || -a.abs(), || S::choose(b.same(b), || a.abs(), || b))
    }
    example "SIGN(3,-2)" => -3.0,
    example "SIGN(-3,0)" => 3.0,

    /// Sine, of radians.
    Sin "SIN" (x: "angle in radians; 30D is 30 degrees") Smooth "sin x" { x.sin() }
    example "SIN(30D)" => 0.5,

    /// Hyperbolic sine.
    Sinh "SINH" (x: "any number") Smooth "(exp x - exp(-x))/2" { x.sinh() }
    example "SINH(1)" => 1.1752011936438014,

    /// Square root.
    Sqrt "SQRT" (x: "number from 0") Smooth "sqrt x" { x.sqrt() }
    domain x.lt(S::zero()) => "SQRT takes no negative numbers",
    example "SQRT(6.25)" => 2.5,

    /// Tangent, of radians.
    Tan "TAN" (x: "angle in radians; 30D is 30 degrees") Smooth "tan x" { x.tan() }
    example "TAN(45D)" => 1.0,

    /// Hyperbolic tangent.
    Tanh "TANH" (x: "any number") Smooth "sinh x/cosh x" { x.tanh() }
    example "TANH(0.5)" => 0.46211715726000974,

    [Utility Function]

    /// Force of a gap element: zero between two stops, the force of IMPACT at either.
    ///
    /// Positive at the lower stop x1, negative at the upper stop x2; never attractive. The damping
    /// grows from 0 at contact to cmax at penetration d.
    Bistop "BISTOP" (x: "position between the stops, as DX(i, j)", x_dot: "rate of x, as VX(i, j)", x1: "lower stop: below it the force is positive", x2: "upper stop: above it the force is negative", k: "stiffness of the stops, not negative", e: "exponent of the penetration, positive; above 1 for a smooth beginning", cmax: "largest damping, not negative", d: "penetration at which the damping is cmax, positive") C0
    "x < x1: max(k (x1-x)^e - step(x, x1-d, cmax, x1, 0) x_dot, 0);  x > x2: min(-k (x-x2)^e - step(x, x2, 0, x2+d, cmax) x_dot, 0);  else 0"
    {
        bistop(x, x_dot, x1, x2, k, cmax, d, d.recip(), AnyExponent(e))
    }
    forbid x2.le(x1) => "x1 must be less than x2",
    forbid k.lt(S::zero()) => "the stiffness k must not be negative",
    forbid e.le(S::zero()) => "the exponent e must be positive",
    forbid cmax.lt(S::zero()) => "the damping cmax must not be negative",
    forbid d.le(S::zero()) => "the depth d must be positive",
    example "BISTOP(-1.05,-0.5,-1,1,100,1.5,20,0.1)" => 6.11803398874990,
    example "BISTOP(1.3,0.5,-1,1,100,1.5,20,0.1)" => -26.431676725154986,

    /// Sum of Chebyshev polynomials of the first kind.
    Cheby "CHEBY" (x: "argument, often TIME", x0: "value of x that is 0 of the polynomials" | a: "coefficients of T_0, T_1, …", 1..=31) Smooth "sum a_j T_j(x - x0),  T_0 = 1, T_1 = y, T_j = 2 y T_(j-1) - T_(j-2)" {
        series::chebyshev(x - x0, a, |a| a)
    }
    example "CHEBY(0.5,1,1,0,-1)" => 1.5,
    example "CHEBY(2,0,0,0,0,0,1)" => 97.0,

    /// Value that an expression had some time ago; before the start of the simulation the history.
    ///
    /// It needs a host that keeps the past: a program asks for it as an input.
    Delay "DELAY" (e: "expression whose value some time ago is wanted", delay: "time by which it lies back; less than 0 counts as 0", history: "value before the simulation began"; id: "number of an ARRAY with settings of the interpolation") Jump "e(TIME - delay)" {
        S::constant(f64::NAN)
    }

    /// Sum of cosines: a bias and up to thirty harmonics.
    Forcos "FORCOS" (x: "argument, often TIME", x0: "value of x where all cosines are 1", w: "angular frequency of the first harmonic, radians for each unit of x; 360D is one cycle" | a: "bias, then the amplitudes of the harmonics", 1..=31) Smooth "a_0 + sum a_j cos(j w (x - x0))" {
        series::cosines(w * (x - x0), a, |a| a)
    }
    example "FORCOS(0.25,0,360D,2,1,0.5)" => 1.5,

    /// Sum of sines: a bias and up to thirty harmonics.
    Forsin "FORSIN" (x: "argument, often TIME", x0: "value of x where all sines are 0", w: "angular frequency of the first harmonic, radians for each unit of x; 360D is one cycle" | a: "bias, then the amplitudes of the harmonics", 1..=31) Smooth "a_0 + sum a_j sin(j w (x - x0))" {
        series::sines(w * (x - x0), a, |a| a)
    }
    example "FORSIN(0.1,-0.25,360D,0,1)" => 0.8090169943749475,
    example "FORSIN(0.3,0,2,5,1,2,3)" => 10.350263537964073,

    /// Haversine step from h0 at x0 to h1 at x1; the slope is continuous.
    Havsin "HAVSIN" (x: "what runs through the step, often TIME", x0: "place where the step begins; less than x1", h0: "value up to x0", x1: "place where the step ends", h1: "value from x1 on") C1
    "(h0 + h1)/2 + (h1 - h0)/2 sin(pi u - pi/2),  u = (x - x0)/(x1 - x0) between 0 and 1"
    { step(x, x0, h0, x1, h1, haversine) }
    forbid x1.le(x0) => "x0 must be less than x1",
    example "HAVSIN(1.25,1,0,2,1)" => 0.14644660940672624,

    /// Force of a one-sided contact: a stiff spring with exponent and a damper that fades in.
    ///
    /// Zero unless x < x1; never attractive. The damping grows from 0 at contact to cmax at
    /// penetration d.
    Impact "IMPACT" (x: "distance, as DX(i, j)", x_dot: "rate of x, as VX(i, j)", x1: "free length: below it the force acts", k: "stiffness, not negative", e: "exponent of the penetration, positive; above 1 for a smooth beginning", cmax: "largest damping, not negative", d: "penetration at which the damping is cmax, positive") C0
    "x < x1: max(0, k (x1-x)^e - step(x, x1-d, cmax, x1, 0) x_dot);  else 0"
    { impact(x, x_dot, x1, k, cmax, d, d.recip(), AnyExponent(e)) }
    forbid k.lt(S::zero()) => "the stiffness k must not be negative",
    forbid e.le(S::zero()) => "the exponent e must be positive",
    forbid cmax.lt(S::zero()) => "the damping cmax must not be negative",
    forbid d.le(S::zero()) => "the depth d must be positive",
    example "IMPACT(0.96,-1,1.0,100,1.5,25,0.1)" => 9.6,
    example "IMPACT(0.5,-1,1.0,100,1.5,25,0.1)" => 60.35533905932738,

    /// Polynomial in x - x0.
    Poly "POLY" (x: "argument, often TIME", x0: "shift: value of x where the polynomial is a0" | a: "coefficients, the constant first", 1..=31) Smooth "sum a_j (x - x0)^j" { series::powers(x - x0, a, |a| a) }
    example "POLY(6.5,5,0,10)" => 15.0,
    example "POLY(12,10,0,25,0,75)" => 650.0,

    /// Simple harmonic function. The phase is subtracted.
    Shf "SHF" (x: "argument, often TIME", x0: "shift of x", a: "amplitude", w: "angular frequency, radians for each unit of x; 360D is one cycle", phi: "phase in radians, which is subtracted", b: "value about which it swings") Smooth "a sin(w (x - x0) - phi) + b" { a * (w * (x - x0) - phi).sin() + b }
    example "SHF(0,0,2,PI,90D,1)" => -1.0,

    /// Cubic step from h0 at x0 to h1 at x1; the slope is continuous.
    Step "STEP" (x: "what runs through the step, often TIME", x0: "place where the step begins; less than x1", h0: "value up to x0", x1: "place where the step ends", h1: "value from x1 on") C1 "h0 + (h1 - h0) u^2 (3 - 2 u),  u = (x - x0)/(x1 - x0) between 0 and 1" {
        step(x, x0, h0, x1, h1, cubic)
    }
    forbid x1.le(x0) => "x0 must be less than x1",
    example "STEP(1.25,1,0,2,1)" => 0.15625,
    example "STEP(1,0,5,4,-3)" => 3.75,

    /// Quintic step from h0 at x0 to h1 at x1; slope and curvature are continuous.
    Step5 "STEP5" (x: "what runs through the step, often TIME", x0: "place where the step begins; less than x1", h0: "value up to x0", x1: "place where the step ends", h1: "value from x1 on") C2 "h0 + (h1 - h0) u^3 (10 - 15 u + 6 u^2),  u = (x - x0)/(x1 - x0) between 0 and 1" {
        step(x, x0, h0, x1, h1, quintic)
    }
    forbid x1.le(x0) => "x0 must be less than x1",
    example "STEP5(1.25,1,0,2,1)" => 0.103515625,

    /// Sine of constant amplitude a whose frequency rises from f0 at x0 to f1 at x1, in cycles per
    /// unit of x.
    ///
    /// It fades in between 0 and dx.
    Sweep "SWEEP" (x: "argument, often TIME", a: "amplitude", x0: "x where the frequency begins to rise; less than x1", f0: "frequency up to x0, cycles for each unit of x", x1: "x where the frequency has risen", f1: "frequency from x1 on, cycles for each unit of x", dx: "interval of x, from 0, in which the amplitude fades in; positive") C1
    "step5(x, 0, 0, dx, 1) a sin(2 pi P),  P = f0 x + (f1 - f0)/(2 (x1 - x0)) (x - x0)^2 between x0 and x1, of constant slope outside"
    {
        let fade = step(x, S::zero(), S::zero(), dx, S::one(), quintic);
        // whole turns are left out exactly, before 2 pi rounds them
        let turns = sweep_turns(x, x0, f0, x1, f1);
        fade * a * (turns - turns.round()).scale(2.0 * PI).sin()
    }
    forbid x1.le(x0) => "x0 must be less than x1",
    forbid dx.le(S::zero()) => "dx must be positive",
    example "SWEEP(1.3,1.0,0.0,2.0,5.0,6.0,0.01)" => 0.9866859442078679,

    [Expression Expression]

    /// Sine, of degrees.
    SinDegrees "sin" (x: "angle in degrees") Smooth "sin(x pi/180)" { x.scale(DEGREE).sin() }
    example "sin(30)" => 0.5,

    /// Cosine, of degrees.
    CosDegrees "cos" (x: "angle in degrees") Smooth "cos(x pi/180)" { x.scale(DEGREE).cos() }
    example "cos(60)" => 0.5,

    /// Tangent, of degrees.
    TanDegrees "tan" (x: "angle in degrees") Smooth "tan(x pi/180)" { x.scale(DEGREE).tan() }
    example "tan(45)" => 1.0,

    /// Arc sine, in degrees.
    AsinDegrees "asin" (x: "sine, between -1 and 1") Smooth "arcsin(x) 180/pi" { x.asin().scale(1.0 / DEGREE) }
    domain S::one().lt(x.abs()) => "asin takes numbers between -1 and 1",
    example "asin(0.5)" => 30.0,

    /// Arc cosine, in degrees.
    AcosDegrees "acos" (x: "cosine, between -1 and 1") Smooth "arccos(x) 180/pi" { x.acos().scale(1.0 / DEGREE) }
    domain S::one().lt(x.abs()) => "acos takes numbers between -1 and 1",
    example "acos(-1)" => 180.0,

    /// Arc tangent, in degrees.
    AtanDegrees "atan" (x: "tangent") Smooth "arctan(x) 180/pi" { x.atan().scale(1.0 / DEGREE) }
    example "atan(1)" => 45.0,

    /// Radians to degrees.
    Degrees "degrees" (x: "angle in radians") Smooth "x 180/pi" { x.scale(1.0 / DEGREE) }
    example "degrees(1)" => 57.29577951308232,

    /// Degrees to radians.
    Radians "radians" (x: "angle in degrees") Smooth "x pi/180" { x.scale(DEGREE) }
    example "radians(180)" => PI,

    /// Common logarithm.
    CommonLog "log" (x: "positive number") Smooth "log10 x" { x.log10() }
    domain x.le(S::zero()) => "log takes positive numbers",
    example "log(1000)" => 3.0,

    /// Antilogarithm.
    Antilog "alog" (x: "exponent, up to 308") Smooth "10^x" { S::constant(10.0).powf(x) }
    example "alog(3)" => 1000.0,

    /// Natural logarithm.
    Ln "ln" (x: "positive number") Smooth "ln x" { x.ln() }
    domain x.le(S::zero()) => "ln takes positive numbers",
    example "ln(10)" => LN_10,

    /// Exponential.
    ExpressionExp "exp" (x: "exponent, up to 709") Smooth "exp x" { x.exp() }
    example "exp(0)" => 1.0,

    /// Square root.
    ExpressionSqrt "sqrt" (x: "number from 0") Smooth "sqrt x" { x.sqrt() }
    domain x.lt(S::zero()) => "sqrt takes no negative numbers",
    example "sqrt(6.25)" => 2.5,

    /// Absolute value.
    ExpressionAbs "abs" (x: "any number") C0 "|x|" { x.abs() }
    example "abs(-3.5)" => 3.5,

    /// Integer part, toward zero.
    Int "int" (x: "any number") Jump "trunc x" { x.trunc() }
    example "int(-2.7)" => -2.0,

    /// Fraction: what the integer part leaves, with the sign of x.
    Frac "frac" (x: "any number") Jump "x - trunc x" { x - x.trunc() }
    example "frac(-2.75)" => -0.75,

    /// Sign: -1, 0 or 1.
    SignOf "sign" (x: "any number") Jump "x/|x|, 0 at 0" {
        let (zero, one) = (S::zero(), S::one());
        S::choose(x.lt(zero), || -one, || S::choose(zero.lt(x), || one, || S::choose(x.same(zero), || zero, || x)))
    }
    example "sign(-4.2)" => -1.0,
    example "sign(0)" => 0.0,

    /// Downward to a whole number.
    Ent "ent" (x: "any number") Jump "floor x" { x.floor() }
    example "ent(-2.7)" => -3.0,
}
