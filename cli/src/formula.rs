//! An expression at the prompt: read, compiled, and evaluated with its rates in time from the
//! numbers that the user gave.
//!
//! The compiled program does the work. Where it yields no finite number the walker repeats the
//! evaluation and names the part of the text that has no value, and the reason.

use super::data::Data;
use cognate::diagnostic::{Cause, Diagnostic, Error, Span};
use cognate::expr::ast::{Callee, Dialect, Node};
use cognate::expr::interpolation::Interpolation;
use cognate::expr::measures::Family;
use cognate::expr::program::{Input, Program, Work};
use cognate::expr::signature::{Element, Kind};
use cognate::expr::{Expr, Profile, input_named, walk};
use cognate::scalar::{Jet, Scalar};
use std::collections::BTreeSet;

/// The settings for reading and evaluating expressions.
#[derive(Clone, Debug, Default)]
pub struct Setting {
    /// language
    pub dialect: Dialect,
    /// profile: habits and limits
    pub profile: Profile,
    /// inputs of expressions
    pub data: Data,
}

/// An expression, read and compiled.
pub struct Formula {
    /// the expression
    pub expr: Expr,
    /// its program, with one output
    pub program: Program,
    /// inputs that it names, and values of the past
    asked: Vec<Input>,
    /// scratch for values with rates
    jets: Work<Jet>,
    /// scratch for values
    plain: Work,
}

/// Value, first and second rate at a time; those that were not requested are 0.
pub type Sample = [f64; 3];

impl Formula {
    /// Reads and compiles an expression.
    ///
    /// # Errors
    /// The first mistake in it, with its place.
    pub fn new(text: &str, setting: &Setting) -> Result<Self, Diagnostic> {
        let expr = Expr::parse_profile(text, setting.dialect, setting.profile)
            .map_err(Error::into_first)?;
        let program = expr.compile(&setting.data.bindings).map_err(|error| {
            let d = error.into_first();
            let is_unknown = d.is(Cause::UnknownElement);
            match (is_unknown, asks_for_curve(&expr, &d)) {
                (true, true) => {
                    d.help("points come from `--curves FILE`; in the REPL from `:curves FILE`")
                }
                (true, false) => {
                    d.help("data come from `--splines FILE`; in the REPL from `:splines FILE`")
                }
                (false, _) => d,
            }
        })?;
        let asked = [&expr.inputs()[..], program.inputs()].concat();
        Ok(Self {
            expr,
            program,
            asked,
            jets: Work::default(),
            plain: Work::default(),
        })
    }

    /// Evaluates at a time, with derivatives in time up to `order`, which is at most 2.
    ///
    /// # Errors
    /// When there is no value: a part outside its domain, or an input that is not given. The place
    /// is that of the part.
    pub fn sample(
        &mut self,
        time: Option<f64>,
        order: usize,
        data: &Data,
    ) -> Result<Sample, Diagnostic> {
        let sample = if order == 0 {
            [self.value(time, data), 0.0, 0.0]
        } else {
            self.rates(time, data)
        };
        let wanted = &sample[..=order.min(2)];
        if wanted.iter().any(|x| !x.is_finite()) {
            return Err(self.trouble(time, data, &sample));
        }
        // a function such as IMPACT makes a number of an input that has none
        let given = |&input: &Input| {
            input_time(input, time)
                .and_then(|t| data.value(input, t))
                .is_some_and(f64::is_finite)
        };
        if !self.asked.iter().all(given) && self.expr.eval_with(&TimedData { data, time }).is_err()
        {
            return Err(self.trouble(time, data, &sample));
        }
        Ok(sample)
    }

    /// Returns whether all inputs but the time have a value.
    pub fn is_given(&self, data: &Data) -> bool {
        let mut asked = self.asked.iter();
        asked.all(|&input| input == Input::Time || data.value(input, 0.0).is_some())
    }

    /// Evaluates without rates.
    fn value(&mut self, time: Option<f64>, data: &Data) -> f64 {
        let given = |&input: &Input| {
            input_time(input, time)
                .and_then(|t| data.value(input, t))
                .unwrap_or(f64::NAN)
        };
        let inputs: Vec<f64> = self.program.inputs().iter().map(given).collect();
        let mut out = [f64::NAN];
        self.program.run(&inputs, &mut self.plain, &mut out);
        out[0]
    }

    /// Evaluates with rates.
    fn rates(&mut self, time: Option<f64>, data: &Data) -> Sample {
        let unknown = Jet::constant(f64::NAN);
        let given = |&input: &Input| {
            input_time(input, time)
                .and_then(|t| data.jet(input, t))
                .unwrap_or(unknown)
        };
        let inputs: Vec<Jet> = self.program.inputs().iter().map(given).collect();
        let mut out = [unknown];
        self.program.eval(&inputs, &mut self.jets, &mut out);
        [out[0].value, out[0].first, out[0].second]
    }

    /// Returns the reason why there is no finite number.
    fn trouble(&self, time: Option<f64>, data: &Data, sample: &Sample) -> Diagnostic {
        let walked = self.expr.eval_with(&TimedData { data, time });
        match walked.map_err(Error::into_first) {
            Err(d) if !d.is(Cause::MissingValue) => d,
            Err(d) if time.is_none() && self.program.inputs().contains(&Input::Time) => {
                d.help("give the time: `--time 1.5`; in the REPL `:time 1.5`")
            }
            Err(d) => {
                let advice = self.what_is_missing(&d, data);
                d.help(advice)
            }
            Ok(_) => {
                let which = if sample[1].is_finite() {
                    "second derivative"
                } else {
                    "first derivative"
                };
                let at = time.map_or(String::new(), |t| {
                    format!(" at time {}", cognate::results::digits(t))
                });
                Diagnostic::error(
                    Cause::Domain,
                    format!("the {which} has no finite value{at}"),
                )
                .at(self.expr.text(), Span::new(0, self.expr.text().len()))
            }
        }
    }
}

impl Formula {
    /// Returns advice: the command or option that gives the input of a mistake.
    fn what_is_missing(&self, d: &Diagnostic, data: &Data) -> String {
        match d.span.and_then(|span| self.expr.input_at(span)) {
            Some(input @ Input::Measure(measure, arguments)) => {
                let row = measure.row();
                // a marker is named once, however often it is read
                let missing: BTreeSet<_> = row
                    .arguments
                    .iter()
                    .zip(&arguments)
                    .filter(|(a, id)| {
                        matches!(
                            a.kind,
                            Kind::Identifier {
                                element: Element::Marker,
                                ..
                            }
                        ) && **id > 0
                            && !data.markers.contains_key(id)
                    })
                    .map(|(_, id)| *id)
                    .collect();
                let missing: Vec<String> = missing.iter().map(ToString::to_string).collect();
                match row.family {
                    Family::Displacement | Family::Velocity | Family::Acceleration
                        if !missing.is_empty() =>
                    {
                        let [s, state] = match missing.len() {
                            1 => ["", "its state"],
                            _ => ["s", "their states"],
                        };
                        format!(
                            "nothing is known of marker{s} {}: give {state} (`--markers FILE`; in the REPL `:marker {} X Y Z`)",
                            missing.join(" and "),
                            missing[0]
                        )
                    }
                    _ => {
                        let call = input.to_string().replace(' ', "");
                        format!(
                            "the model would know: give it a value (`--set '{call}=2.5'`; in the REPL `:let {call} = 2.5`)"
                        )
                    }
                }
            }
            _ => "give it a value: `--set`; in the REPL `:let`".into(),
        }
    }
}

/// Returns whether a mistake is about a call of CURVE.
fn asks_for_curve(expr: &Expr, said: &Diagnostic) -> bool {
    let ast = expr.ast();
    let places = ast.spans.iter().map(|&span| Some(span));
    ast.nodes.iter().zip(places).any(|(node, place)| {
        let callee = Callee::Interpolation(Interpolation::Curve);
        place == said.span && matches!(node, Node::Call { callee: c, .. } if *c == callee)
    })
}

/// Returns the time at which an input is read: the expression's own, or any where it does not read
/// the time.
fn input_time(input: Input, time: Option<f64>) -> Option<f64> {
    if input == Input::Time {
        time
    } else {
        Some(time.unwrap_or(0.0))
    }
}

/// The user's numbers at a time, as a host for the walker.
pub struct TimedData<'a> {
    /// inputs other than time
    pub data: &'a Data,
    /// time, if it is given, in s
    pub time: Option<f64>,
}

impl walk::Host for TimedData<'_> {
    fn input(&self, input: Input) -> Option<f64> {
        self.data.value(input, input_time(input, self.time)?)
    }
    fn bindings(&self) -> Option<&cognate::expr::interpolation::Bindings> {
        Some(&self.data.bindings)
    }
}

/// Gives a value to a function of the model, such as VARVAL(3), or to MODE.
///
/// # Errors
/// When the text is not one of these.
pub fn give(setting: &mut Setting, call: &str, value: f64) -> Result<(), Diagnostic> {
    match input_named(call, Dialect::Function)? {
        Input::Mode => setting.data.mode = value,
        input @ Input::Measure(..) => {
            setting.data.values.insert(input, value);
        }
        Input::Time | Input::Delayed(_) | Input::Slot(_) => {
            return Err(Diagnostic::error(
                Cause::MissingValue,
                format!("`{call}` cannot be given a value this way"),
            )
            .help("the time is given by `--time`; in the REPL by `:time`"));
        }
    }
    Ok(())
}

/// Returns the names of a value and its derivatives over time.
pub fn derivative_names(text: &str) -> [String; 3] {
    let name = text.split_whitespace().collect::<Vec<_>>().join(" ");
    [
        name.clone(),
        format!("d/dt {name}"),
        format!("d2/dt2 {name}"),
    ]
}

/// Returns times from `first` to `last`, `step` apart; the last one is included when it is reached
/// up to rounding.
///
/// # Errors
/// When the step does not lead from the first to the last, or there are too many.
pub fn times(first: f64, last: f64, step: f64) -> Result<Vec<f64>, Diagnostic> {
    const MOST: f64 = 1e7;
    let n = ((last - first) / step * (1.0 + 1e-12) + 1e-9).floor();
    if !n.is_finite() || n < 0.0 {
        let message = format!("no steps of {step} lead from {first} to {last}");
        return Err(Diagnostic::error("bad_range", message)
            .help("a range is first:last:step, such as 0:2:0.01"));
    }
    if n > MOST {
        return Err(Diagnostic::error(
            "bad_range",
            format!("{n} samples are more than {MOST}"),
        ));
    }
    // multiples of the step; the last is taken as it was given when only rounding keeps them apart
    let mut times: Vec<f64> = (0..=n as usize).map(|k| first + k as f64 * step).collect();
    if let Some(end) = times
        .last_mut()
        .filter(|end| (**end - last).abs() <= 1e-9 * step.abs())
    {
        *end = last;
    }
    Ok(times)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_ends_where_it_was_said_to_end() {
        assert_eq!(times(0.0, 0.3, 0.1).unwrap(), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(times(0.0, 0.35, 0.1).unwrap().len(), 4);
        assert_eq!(times(1.0, -1.0, -1.0).unwrap(), [1.0, 0.0, -1.0]);
        assert_eq!(times(2.0, 2.0, 0.5).unwrap(), [2.0]);
        for (first, last, step) in [
            (0.0, 1.0, 0.0),
            (0.0, 1.0, -1.0),
            (0.0, f64::NAN, 1.0),
            (0.0, 1e9, 1e-3),
        ] {
            assert_eq!(times(first, last, step).unwrap_err().code, "bad_range");
        }
    }

    #[test]
    fn rates_follow_from_the_motion_of_markers() {
        let mut setting = Setting::default();
        setting
            .data
            .add_marker(
                1,
                r#"{"r": [3, 4, 0], "v": [1, 0, 0], "w": [0, 0, 2], "a": [0, 5, 0]}"#,
            )
            .unwrap();
        setting.data.add_marker(2, r#"{"w": [0, 0, 1]}"#).unwrap();
        let sample = |text: &str| {
            Formula::new(text, &setting)
                .unwrap()
                .sample(None, 2, &setting.data)
                .unwrap()
        };
        assert_eq!(sample("DX(1)"), [3.0, 1.0, 0.0]);
        assert_eq!(sample("DY(1)"), [4.0, 0.0, 5.0]);
        let [distance, rate, _] = sample("DM(1)");
        assert_eq!(distance, 5.0);
        approx::assert_relative_eq!(rate, 3.0 / 5.0, epsilon = 1e-15);
        assert_eq!(sample("AZ(1)")[..2], [0.0, 2.0]);
        // in the axes of a turning marker the rate is the velocity seen from it
        let seen = sample("VX(1,0,2,2)")[0];
        assert_eq!(sample("DX(1,0,2)")[1], seen);
    }

    #[test]
    fn what_is_not_given_is_named_and_what_is_given_counts() {
        let mut setting = Setting::default();
        let mut formula = Formula::new("2*VARVAL(3)+TIME", &setting).unwrap();
        assert_eq!(
            formula
                .sample(Some(1.0), 0, &setting.data)
                .unwrap_err()
                .code,
            "missing_value"
        );
        give(&mut setting, "VARVAL(3)", 4.0).unwrap();
        assert_eq!(
            formula.sample(Some(1.0), 1, &setting.data),
            Ok([9.0, 1.0, 0.0])
        );
        assert_eq!(
            formula.sample(None, 0, &setting.data).unwrap_err().code,
            "missing_value"
        );
        assert_eq!(
            give(&mut setting, "2*VARVAL(3)", 4.0).unwrap_err().code,
            "missing_value"
        );
    }

    #[test]
    fn what_is_not_given_is_never_a_silent_number() {
        let setting = Setting::default();
        for text in [
            "IMPACT(VARVAL(3),0,1,100,1.5,25,0.1)",
            "POLY(VARVAL(3),0,7)",
            "VARVAL(3)**0",
            "STEP(VARVAL(3),0,1,1,2)",
            "IF(1: 2, 3, POLY(VARVAL(3),0,7))",
        ] {
            let mut formula = Formula::new(text, &setting).unwrap();
            for order in [0, 1] {
                let said = formula.sample(Some(0.5), order, &setting.data).unwrap_err();
                assert_eq!(said.code, "missing_value", "{text}");
            }
        }
    }

    #[test]
    fn a_part_that_is_not_reached_needs_no_value() {
        let setting = Setting::default();
        let mut formula = Formula::new("IF(TIME-1: 5, 6, VARVAL(3))", &setting).unwrap();
        assert_eq!(
            formula.sample(Some(0.5), 0, &setting.data).map(|s| s[0]),
            Ok(5.0)
        );
    }
}
