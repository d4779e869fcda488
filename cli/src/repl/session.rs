//! The execution of a line at the prompt: an expression is evaluated, a command (`:name`) changes
//! or shows something.

use super::commands::{COMMANDS, unknown_command, usage};
use super::model::Loaded;
use super::names::Names;
use crate::eval::DialectName;
use crate::formula::{Formula, Setting, derivative_names, give, times};
use crate::writing::WritingArgs;
use crate::{Failure, anatomy};
use crate::{card, explain, plot, statements};
use cognate::diagnostic::{Cause, Diagnostic, counted};
use cognate::expr::ast::Dialect;
use cognate::expr::{Expansion, Profile, parse, symbol};
use cognate::internals::report::picture::{self, PictureFormat};
use cognate::internals::report::terminal::terminal;
use cognate::internals::report::{Curve, Plot, svg::svg};
use cognate::results::digits;
use std::path::Path;

/// The answer to a line.
pub enum Reply {
    /// text to print; may be empty
    Text(String),
    /// warnings, the text that their places refer to, and the text to print nevertheless
    Doubtful(Vec<Diagnostic>, String, String),
    /// a mistake, and the text that its place refers to
    Mistake(Box<Diagnostic>, String),
    /// a model that cannot be read or solved
    Failed(Box<Failure>),
    /// the end of the session
    Quit,
}

/// Number of samples of a plot.
const SAMPLES: f64 = 400.0;

/// The state that lines change.
pub struct Session {
    /// language and data
    pub setting: Setting,
    /// TIME, in s
    time: f64,
    /// highest derivative that is shown
    order: usize,
    /// names for parts of expressions: as defined, with earlier names replaced
    pub names: Names,
    /// the model that was loaded
    model: Option<Loaded>,
}

impl Session {
    /// Creates a session without any numbers, at time 0.
    pub fn new(dialect: Dialect) -> Self {
        let setting = Setting {
            dialect,
            profile: Profile::Adams,
            ..Setting::default()
        };
        Self {
            setting,
            time: 0.0,
            order: 0,
            names: Names::default(),
            model: None,
        }
    }

    /// Returns whether an expression ends too early, so that more lines should follow. A blank line
    /// ends it all the same.
    pub fn is_incomplete(&self, text: &str) -> bool {
        let empty = |line: &str| line.trim().is_empty() || line.trim_start().starts_with('!');
        // a line break that ends the text begins a line that is blank
        let last_is_blank = (text.rsplit('\n').next()).is_some_and(|l| l.trim().is_empty());
        let command = text.trim_start().starts_with(':');
        let ends = command || last_is_blank || text.lines().all(empty);
        let error = || {
            parse(
                &self.names.expand(text).text,
                self.setting.dialect,
                self.setting.profile,
            )
            .err()
        };
        !ends && error().is_some_and(|d| d.is(Cause::UnexpectedEnd))
    }

    /// Executes a line.
    pub fn execute(&mut self, line: &str) -> Reply {
        let line = line.trim();
        if line.is_empty() || line.starts_with('!') {
            return Reply::Text(String::new());
        }
        let line = match bare_command(line) {
            Some((command, rest)) => &format!(":{command} {rest}"),
            None if line.starts_with(':') => line,
            None => return self.evaluate(line),
        };
        let (command, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        let done = match command {
            ":help" | ":h" | ":?" => self.help(rest),
            ":statements" => statements::about(rest),
            ":functions" => Ok(card::all()
                .iter()
                .map(|c| format!("{}\n", c.signature))
                .collect()),
            ":let" => return self.define(rest),
            ":time" => return self.set_time(rest),
            ":derivative" => self.set_order(rest),
            ":marker" => self.marker(rest),
            ":markers" => self
                .setting
                .data
                .read_markers(Path::new(rest))
                .map(|()| format!("{}\n", counted(self.setting.data.markers.len(), "marker"))),
            ":splines" => self.setting.data.read_splines(Path::new(rest)).map(|()| {
                format!(
                    "{}\n",
                    counted(self.setting.data.bindings.splines.len(), "spline")
                )
            }),
            ":curves" => self.setting.data.read_curves(Path::new(rest)).map(|()| {
                format!(
                    "{}\n",
                    counted(self.setting.data.bindings.curves.len(), "curve")
                )
            }),
            ":plot" => return self.plot(rest),
            ":explain" => return self.explain(rest),
            ":load" | ":info" | ":list" | ":show" | ":rename" | ":delete" | ":save" | ":verify"
            | ":run" | ":draw" => {
                let done = self.about_model(command, rest);
                return done.map_or_else(|f| Reply::Failed(Box::new(f)), Reply::Text);
            }
            ":dialect" => self.set_dialect(rest),
            ":quit" | ":q" | ":exit" => return Reply::Quit,
            unknown => Err(unknown_command(unknown)),
        };
        match done {
            Ok(text) => Reply::Text(text),
            Err(d) => Reply::Mistake(Box::new(d), line.to_owned()),
        }
    }

    /// Evaluates an expression at the time of the session.
    fn evaluate(&mut self, text: &str) -> Reply {
        let expansion = self.names.expand(text);
        if self.is_of_model(&expansion.text) {
            return self.value_in_model(&expansion);
        }
        let done = Formula::new(&expansion.text, &self.setting).and_then(|mut f| {
            let sample = f.sample(Some(self.time), self.order, &self.setting.data)?;
            Ok((f.expr.warnings(), sample))
        });
        let (doubts, sample) = match done {
            Ok(done) => done,
            Err(d) => return mistake(with_let(d, &expansion), &expansion),
        };
        let text = if self.order == 0 {
            digits(sample[0]) + "\n"
        } else {
            let lines = ["value", "d/dt", "d2/dt2"].iter().zip(sample);
            lines
                .take(self.order + 1)
                .map(|(name, x)| format!("{name:6}  {}\n", digits(x)))
                .collect()
        };
        if doubts.is_empty() {
            Reply::Text(text)
        } else {
            let doubts = doubts.into_iter().map(|d| expansion.as_typed(d));
            Reply::Doubtful(doubts.collect(), expansion.typed, text)
        }
    }

    /// Returns whether the model has to be asked for the value of an expression: it names what
    /// nobody has given here.
    fn is_of_model(&self, text: &str) -> bool {
        if self.model.is_none() || self.setting.dialect != Dialect::Function {
            return false;
        }
        match Formula::new(text, &self.setting) {
            Ok(formula) => !formula.is_given(&self.setting.data),
            Err(d) => {
                let model = self.model.as_ref();
                d.is(Cause::UnknownElement) || model.is_some_and(|model| model.knows(text))
            }
        }
    }

    /// Evaluates an expression in the model, at the time of the session.
    fn value_in_model(&mut self, expansion: &Expansion) -> Reply {
        let Some(model) = self.model.as_mut().filter(|_| self.order == 0) else {
            let what = "rates of functions of the model are not computed at the prompt";
            let d = Diagnostic::error("unavailable", what);
            let advice = "VX, WZ, ACCX and their like are rates; `:derivative 0` shows values";
            return mistake(d.help(advice), expansion);
        };
        match model.value(&expansion.text, self.time) {
            Ok(value) => Reply::Text(digits(value) + "\n"),
            Err(failure) => failed(Box::new(failure), expansion),
        }
    }

    /// Executes a command about the model.
    ///
    /// # Errors
    /// When none is loaded, it has mistakes, or the command cannot be done.
    fn about_model(&mut self, command: &str, rest: &str) -> Result<String, Failure> {
        let wrong = || Failure::from(usage(command));
        if command == ":load" {
            let file = Some(rest).filter(|file| !file.is_empty());
            let model = Loaded::read(Path::new(file.ok_or_else(wrong)?))?;
            let said = model.info();
            (self.model, self.time) = (Some(model), 0.0);
            return Ok(said);
        }
        let Some(model) = &mut self.model else {
            return Err(Failure::usage("there is no model: `:load FILE` reads one"));
        };
        let words: Vec<&str> = rest.split_whitespace().collect();
        let silent = |()| String::new();
        match (command, words.as_slice()) {
            (":info", []) => Ok(model.info()),
            (":list", []) => Ok(model.list(None)),
            (":list", [kind]) => {
                let kind = kind.parse().map_err(|e: String| Failure::usage(e))?;
                Ok(model.list(Some(kind)))
            }
            (":show" | ":info", [element]) => Ok(model.show(element)?),
            (":rename", [element, ..]) if words.len() > 1 => {
                let name = rest[element.len()..].trim().trim_matches('\'');
                Ok(model.rename(element, name).map(silent)?)
            }
            (":delete", [element]) => Ok(model.delete(element).map(silent)?),
            (":save", [_, ..]) => Ok(model.save(Path::new(rest)).map(silent)?),
            (":verify", []) => model.verify(),
            (":draw", [_, ..]) => model.draw(self.time, Path::new(rest)).map(silent),
            (":run", []) => model.solve(None, None),
            (":run", [end]) => model.solve(Some(end.parse().map_err(|_| wrong())?), None),
            (":run", [end, steps]) => {
                let end = end.parse().map_err(|_| wrong())?;
                model.solve(Some(end), Some(steps.parse().map_err(|_| wrong())?))
            }
            _ => Err(wrong()),
        }
    }

    /// Shows the card of a name, or the list of commands.
    fn help(&self, name: &str) -> Result<String, Diagnostic> {
        let line = |(name, arguments, what): &(&str, &str, &str)| {
            format!("  {:52}  {what}\n", format!("{name} {arguments}"))
        };
        let command =
            |c: &&(&str, &str, &str)| c.0.trim_start_matches(':') == name.trim_start_matches(':');
        match name {
            "" => {
                let commands: String = COMMANDS.iter().map(line).collect();
                Ok(format!(
                    "An expression is evaluated; it may go on over several lines until it is complete.\n{commands}"
                ))
            }
            _ if name.starts_with(':') => COMMANDS
                .iter()
                .find(command)
                .map(line)
                .ok_or_else(|| unknown_command(name)),
            name => explain::explained(name),
        }
    }

    /// `NAME = EXPRESSION` or `VARVAL(3) = VALUE`; without arguments lists what is defined.
    fn define(&mut self, text: &str) -> Reply {
        if text.is_empty() {
            let names = self
                .names
                .0
                .iter()
                .map(|(name, body)| format!("{name} = {body}\n"));
            let values = self
                .setting
                .data
                .values
                .iter()
                .map(|(input, value)| format!("{input} = {}\n", digits(*value)));
            return Reply::Text(names.chain(values).collect());
        }
        let about = |d: Diagnostic, text: &str| Reply::Mistake(Box::new(d), text.to_owned());
        let Some((name, body)) = text.split_once('=').map(|(n, b)| (n.trim(), b.trim())) else {
            return about(usage(":let"), text);
        };
        let expansion = self.names.expand(body);
        let formula = Formula::new(&expansion.text, &self.setting);
        if !name.contains('(') {
            return match (self.may_define(name), formula) {
                (Err(d), _) => about(d, name),
                (_, Err(d)) => mistake(d, &expansion),
                (Ok(()), Ok(_)) => {
                    self.names
                        .0
                        .insert(name.to_ascii_uppercase(), expansion.text);
                    Reply::Text(String::new())
                }
            };
        }
        match formula.and_then(|mut f| f.sample(Some(self.time), 0, &self.setting.data)) {
            Err(d) => mistake(d, &expansion),
            Ok([value, ..]) => give(&mut self.setting, name, value)
                .map_or_else(|d| about(d, name), |()| Reply::Text(String::new())),
        }
    }

    /// Checks that a name is free to be defined.
    fn may_define(&self, name: &str) -> Result<(), Diagnostic> {
        let known = |dialect| symbol(name, dialect, Profile::Ideas).is_some();
        let letters = name.starts_with(|c: char| c.is_ascii_alphabetic())
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        match letters {
            false => Err(Diagnostic::error(
                "bad_definition",
                format!("`{name}` is no name: letters, digits and _ are"),
            )),
            true if known(Dialect::Function) || known(Dialect::Expression) => {
                Err(Diagnostic::error(
                    "bad_definition",
                    format!("`{name}` has a meaning in the language already"),
                ))
            }
            true => Ok(()),
        }
    }

    /// Sets the time.
    fn set_time(&mut self, text: &str) -> Reply {
        if text.is_empty() {
            return Reply::Text(format!("{}\n", digits(self.time)));
        }
        let expansion = self.names.expand(text);
        let time = Formula::new(&expansion.text, &self.setting)
            .and_then(|mut f| f.sample(None, 0, &self.setting.data));
        match time {
            Ok([time, ..]) => {
                self.time = time;
                Reply::Text(String::new())
            }
            Err(d) => mistake(d, &expansion),
        }
    }

    /// Sets the highest derivative.
    fn set_order(&mut self, text: &str) -> Result<String, Diagnostic> {
        match text {
            "" => return Ok(format!("{}\n", self.order)),
            "0" => self.order = 0,
            "1" => self.order = 1,
            "2" => self.order = 2,
            _ => return Err(usage(":derivative")),
        }
        Ok(String::new())
    }

    /// Sets the language.
    fn set_dialect(&mut self, text: &str) -> Result<String, Diagnostic> {
        let name = match text {
            "" => {
                let name = if self.setting.dialect == Dialect::Function {
                    "function"
                } else {
                    "expression"
                };
                return Ok(format!("{name}\n"));
            }
            "function" => DialectName::Function,
            "expression" => DialectName::Expression,
            _ => return Err(usage(":dialect")),
        };
        self.setting.dialect = name.into();
        Ok(String::new())
    }

    /// Sets the state of a marker.
    fn marker(&mut self, text: &str) -> Result<String, Diagnostic> {
        if text.is_empty() {
            let place = |(id, m): (&u32, &cognate::internals::space::MarkerState<f64>)| {
                format!("{id}: {}\n", m.p_GM.0.map(digits).join(" "))
            };
            return Ok(self.setting.data.markers.iter().map(place).collect());
        }
        let (id, rest) = text
            .split_once(char::is_whitespace)
            .ok_or_else(|| usage(":marker"))?;
        let id = id
            .parse()
            .ok()
            .filter(|&id: &u32| id > 0)
            .ok_or_else(|| usage(":marker"))?;
        let state = if rest.trim_start().starts_with('{') {
            rest.to_owned()
        } else {
            format!(
                "{{\"r\": [{}]}}",
                rest.split([' ', ','])
                    .filter(|w| !w.is_empty())
                    .collect::<Vec<_>>()
                    .join(",")
            )
        };
        self.setting.data.add_marker(id, &state)?;
        Ok(String::new())
    }

    /// `EXPRESSION [FIRST LAST] [FILE]`
    fn plot(&mut self, text: &str) -> Reply {
        let (text, file) = match text.rsplit_once(char::is_whitespace) {
            Some((rest, file)) if PictureFormat::of(Path::new(file)).is_some() => {
                (rest.trim_end(), Some(file))
            }
            _ => (text, None),
        };
        let ranged = range_at_the_end(text);
        let expression = ranged.map_or(text, |(expression, ..)| expression);
        let span = ranged.map(|(_, first, last)| (first, last));
        let expansion = self.names.expand(expression);
        let of_model = self.is_of_model(&expansion.text);
        let drawn = match (span, &mut self.model) {
            _ if expression.is_empty() => Err(Box::new(usage(":plot").into())),
            (None, None) => Err(Box::new(usage(":plot").into())),
            (span, Some(model)) if of_model || span.is_none() => {
                model.plot(&expansion.text, span).map_err(Box::new)
            }
            (None, Some(_)) => Err(Box::new(usage(":plot").into())),
            (Some((first, last)), _) => {
                match self.picture(&expansion.text, expression, first, last) {
                    Ok(picture) => Ok(picture),
                    Err(d) => return mistake(d, &expansion),
                }
            }
        };
        let picture = match drawn {
            Ok(picture) => picture,
            Err(failure) => return failed(failure, &expansion),
        };
        let shown = match file {
            Some(file) => svg(&picture)
                .and_then(|text| picture::bytes(&text, Path::new(file)))
                .and_then(|bytes| WritingArgs::default().bytes(Path::new(file), &bytes))
                .map(|()| format!("plot in {file}\n")),
            None => terminal(&picture, plot::terminal_style()),
        };
        shown.map_or_else(|d| mistake(d, &expansion), Reply::Text)
    }

    /// Draws an expression over a range of times.
    fn picture(
        &self,
        expanded: &str,
        name: &str,
        first: f64,
        last: f64,
    ) -> Result<Plot, Diagnostic> {
        let mut formula = Formula::new(expanded, &self.setting)?;
        let mut curves: Vec<Curve> = derivative_names(name)
            .into_iter()
            .take(self.order + 1)
            .map(|name| Curve {
                name,
                ..Curve::default()
            })
            .collect();
        for t in times(first, last, (last - first) / SAMPLES)? {
            let sample = formula.sample(Some(t), self.order, &self.setting.data)?;
            curves
                .iter_mut()
                .zip(sample)
                .for_each(|(curve, y)| curve.points.push((t, y)));
        }
        let x_label = cognate::expr::ast::Constant::Time
            .name(self.setting.dialect)
            .to_owned();
        Ok(Plot {
            x_label,
            curves,
            ..Plot::default()
        })
    }

    /// `EXPRESSION [FIRST LAST]`
    fn explain(&self, text: &str) -> Reply {
        if text.is_empty() {
            return Reply::Mistake(Box::new(usage(":explain")), text.to_owned());
        }
        let (text, interval) = match range_at_the_end(text) {
            Some((rest, first, last)) => (rest, first..=last),
            None => (text, anatomy::BREAKPOINT_INTERVAL),
        };
        let expansion = self.names.expand(text);
        match Formula::new(&expansion.text, &self.setting) {
            Ok(formula) => Reply::Text(anatomy::explain(
                &formula,
                Some(self.time),
                interval,
                &self.setting.data,
            )),
            Err(d) => mistake(d, &expansion),
        }
    }
}

/// Splits off the two numbers behind an expression.
fn range_at_the_end(text: &str) -> Option<(&str, f64, f64)> {
    let last_word = |text: &'_ str| -> Option<(usize, f64)> {
        let (rest, word) = text.rsplit_once(char::is_whitespace)?;
        Some((rest.trim_end().len(), word.parse().ok()?))
    };
    let (end, last) = last_word(text)?;
    let (end, first) = last_word(&text[..end])?;
    Some((&text[..end], first, last))
}

/// A mistake in an expression, in terms of the text that was typed.
fn mistake(said: Diagnostic, expansion: &Expansion) -> Reply {
    Reply::Mistake(Box::new(expansion.as_typed(said)), expansion.typed.clone())
}

/// Returns the reply for a model that fails: its mistake at the place in the expression that was
/// typed, where it is about that.
fn failed(failure: Box<Failure>, expansion: &Expansion) -> Reply {
    let about_expression = |d: &Diagnostic| d.file.is_none() && d.span.is_some();
    match failure.diagnostics.as_slice() {
        [only] if about_expression(only) => mistake(only.clone(), expansion),
        _ => Reply::Failed(failure),
    }
}

/// A mistake about a name that the language does not know, with the command that defines it, where
/// the name could be a number: `k*2`, `k = 3`.
fn with_let(said: Diagnostic, expansion: &Expansion) -> Diagnostic {
    let Some(span) = said.span.filter(|_| said.is(Cause::UnknownName)) else {
        return said;
    };
    let name = expansion.text.get(span.start..span.end).unwrap_or_default();
    let rest = expansion
        .text
        .get(span.end..)
        .unwrap_or_default()
        .trim_start();
    match rest.strip_prefix('=') {
        Some(value) if span.start == 0 => said.help(format!(
            "here a name is defined by `:let {name} = {}`",
            value.trim()
        )),
        None if !rest.starts_with('(') && said.help.len() == 1 && name.len() <= 2 => {
            said.help(format!("here a name is defined by `:let {name} = …`"))
        }
        _ => said,
    }
}

/// `quit`, `exit` and `help NAME`, which are commands with and without their colon: the language
/// has no such names.
fn bare_command(line: &str) -> Option<(&'static str, &str)> {
    let line = line.trim_end_matches(';').trim_end_matches("()");
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let command = ["help", "quit", "exit"]
        .into_iter()
        .find(|c| c.eq_ignore_ascii_case(word))?;
    let one_name = rest
        .trim()
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == ':');
    (one_name && (command == "help" || rest.trim().is_empty())).then_some((command, rest.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answers(lines: &[&str]) -> Vec<String> {
        let mut session = Session::new(Dialect::Function);
        let answer = |reply| match reply {
            Reply::Text(text) => text,
            Reply::Doubtful(doubts, _, text) => format!("{} {text}", doubts[0].code),
            Reply::Mistake(d, _) => d.code.to_owned(),
            Reply::Failed(failure) => failure.diagnostics[0].code.to_owned(),
            Reply::Quit => "bye".into(),
        };
        lines
            .iter()
            .map(|line| answer(session.execute(line)))
            .collect()
    }

    #[test]
    fn what_is_hardly_meant_is_said_beside_the_answer() {
        let said = answers(&["SIN(30)", "SIN(30D)"]);
        assert!(said[0].starts_with("degrees_or_radians -0.98"), "{said:?}");
        assert!(said[1].starts_with("0.49999"), "{said:?}");
    }

    #[test]
    fn names_stand_for_their_expressions_whole() {
        let said = answers(&[
            ":let w = 1+1",
            ":let v = 2*w",
            "v**2",
            "W*3",
            ":let sin = 1",
            ":let 2x = 1",
            ":let w = LOG(",
            ":let",
            "2E0*w",
        ]);
        assert_eq!(said[2..4], ["16\n", "6\n"]);
        assert_eq!(
            said[4..7],
            ["bad_definition", "bad_definition", "unexpected_end"]
        );
        assert_eq!(said[7], "V = 2*(1+1)\nW = 1+1\n");
        assert_eq!(said[8], "4\n");
    }

    #[test]
    fn time_derivatives_markers_and_values_are_remembered() {
        let said = answers(&[
            "TIME**2",
            ":time 3",
            "TIME**2",
            ":derivative 2",
            "TIME**2",
            ":derivative 0",
            ":marker 1 3 4 12",
            "DM(1)",
            "VARVAL(2)",
            ":let VARVAL(2) = 2*TIME",
            "VARVAL(2)",
        ]);
        assert_eq!((said[0].as_str(), said[2].as_str()), ("0\n", "9\n"));
        assert_eq!(said[4], "value   9\nd/dt    6\nd2/dt2  2\n");
        assert_eq!(said[7..], ["13\n", "missing_value", "", "6\n"]);
    }

    #[test]
    fn expressions_go_on_until_they_are_complete() {
        let session = Session::new(Dialect::Function);
        assert!(session.is_incomplete("STEP(TIME, 0, 0,") && session.is_incomplete("2 +\n3 *"));
        assert!(
            !session.is_incomplete("2 +\n3")
                && !session.is_incomplete("2 +\n")
                && !session.is_incomplete("2 +\n  ")
                && !session.is_incomplete("2 +\n\n")
                && !session.is_incomplete(":let x = (")
                && !session.is_incomplete("2 ^ 3")
        );
    }

    #[test]
    fn a_name_that_could_be_a_number_is_told_the_command_that_defines_it() {
        let mut session = Session::new(Dialect::Function);
        let mut help = |line: &str| match session.execute(line) {
            Reply::Mistake(d, _) => d.help.join("\n"),
            _ => String::new(),
        };
        assert!(help("k*3").contains(":let k = …"));
        assert!(help("k = 2*PI").contains(":let k = 2*PI"));
        assert!(!help("K(3)").contains(":let") && !help("SINE(3)").contains(":let"));
    }

    #[test]
    fn quit_and_help_need_no_colon() {
        for end in ["quit", "QUIT", "exit", "quit()", "quit;"] {
            assert_eq!(answers(&[end]), ["bye"], "{end}");
        }
        let said = answers(&["help", ":help", "help STEP5", ":help STEP5", "help :let"]);
        assert_eq!((&said[0], &said[2]), (&said[1], &said[3]));
        assert!(said[4].contains(":let"), "{}", said[4]);
        // what goes on is an expression
        assert_eq!(answers(&["quit + 1", "help(1)*2"]), ["unknown_name"; 2]);
    }

    #[test]
    fn every_command_is_known_to_help_and_to_the_session() {
        for (name, ..) in COMMANDS {
            let said = answers(&[&format!(":help {name}"), name]);
            assert!(said[0].contains(name), "{name}");
            assert!(!said[1].contains("there is no command"), "{name}");
        }
        assert_eq!(answers(&[":plott SIN(TIME) 0 1", ":q"]), ["usage", "bye"]);
    }

    #[test]
    fn a_plot_is_drawn_over_the_range_it_is_given() {
        let said = answers(&[
            ":plot SIN(2*PI*TIME) 0 2",
            ":plot SIN(TIME) 0",
            ":plot LOG(TIME) -1 1",
        ]);
        assert!(said[0].contains("SIN(2*PI*TIME)") && said[0].lines().count() > 10);
        assert_eq!(said[1..], ["usage", "domain"]);
    }
}
