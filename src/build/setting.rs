//! Values of arguments as a program gives them, made into the kinds that the table of statements
//! takes.

use super::{Element, Key, ModelBuilder};
use crate::dataset::row::{Argument, Meaning, meaning};
use crate::dataset::value::{Kind, Number, Value};
use crate::diagnostic::{Diagnostic, near_names};
use crate::model::Formula;

/// A value of an argument.
///
/// Made of numbers, arrays, texts and handles of elements by `into()`; which of them an argument
/// takes, its row of the table of statements says.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Setting {
    /// the keyword stands alone
    Flag,
    /// a number
    Real(f64),
    /// several
    Reals(Vec<f64>),
    /// a whole number: a count, or the number of an element
    Whole(i64),
    /// several
    Wholes(Vec<i64>),
    /// a word, words between colons, a text, or an expression
    Text(String),
    /// several texts
    Texts(Vec<String>),
    /// FUNCTION = USER(…), which a closure or routine computes
    User(Vec<f64>),
    /// an element of the builder, with its number
    Handle(Key, u32),
    /// several
    Handles(Vec<(Key, u32)>),
}

macro_rules! settings {
    ($($from:ty => |$x:ident| $made:expr;)+) => { $(
        impl From<$from> for Setting {
            fn from($x: $from) -> Self {
                $made
            }
        }
    )+ };
}
settings! {
    f64 => |x| Setting::Real(x);
    i32 => |n| Setting::Whole(n.into());
    u32 => |n| Setting::Whole(n.into());
    Vec<f64> => |all| Setting::Reals(all);
    &[f64] => |all| Setting::Reals(all.to_vec());
    Vec<u32> => |all| Setting::Wholes(all.into_iter().map(i64::from).collect());
    &str => |text| Setting::Text(text.to_string());
    String => |text| Setting::Text(text);
    &String => |text| Setting::Text(text.clone());
    Vec<String> => |all| Setting::Texts(all);
}

impl<const N: usize> From<[f64; N]> for Setting {
    fn from(all: [f64; N]) -> Self {
        Setting::Reals(all.to_vec())
    }
}

impl<const N: usize> From<[i32; N]> for Setting {
    fn from(all: [i32; N]) -> Self {
        Setting::Wholes(all.into_iter().map(i64::from).collect())
    }
}

impl<const N: usize> From<[&str; N]> for Setting {
    fn from(all: [&str; N]) -> Self {
        Setting::Texts(all.map(str::to_string).to_vec())
    }
}

impl<Kind> From<&Element<'_, Kind>> for Setting {
    fn from(element: &Element<'_, Kind>) -> Self {
        Setting::Handle(element.key(), element.number())
    }
}

impl<Kind, const N: usize> From<[&Element<'_, Kind>; N]> for Setting {
    fn from(all: [&Element<'_, Kind>; N]) -> Self {
        Setting::Handles(all.map(|e| (e.key(), e.number())).to_vec())
    }
}

impl Setting {
    /// Returns the numbers of elements in place of their handles.
    ///
    /// # Errors
    /// A handle of another builder, whose number means something else here.
    pub(super) fn numbered(self, keyword: &str, of: &ModelBuilder) -> Result<Self, Diagnostic> {
        let foreign = |key: &Key| of.statement(*key).is_none();
        let told = || {
            let what = format!("{keyword} is an element of another builder");
            Diagnostic::error("unfit_value", what)
        };
        match self {
            Setting::Handle(key, _) if foreign(&key) => Err(told()),
            Setting::Handles(all) if all.iter().any(|(key, _)| foreign(key)) => Err(told()),
            Setting::Handle(_, number) => Ok(Setting::Whole(number.into())),
            Setting::Handles(all) => {
                let numbers = all.into_iter().map(|(_, number)| number.into());
                Ok(Setting::Wholes(numbers.collect()))
            }
            other => Ok(other),
        }
    }

    /// Returns the value as an argument takes it.
    ///
    /// # Errors
    /// A value of another kind, a number that is not finite or out of range, a wrong count, or a
    /// word that is none of the argument's.
    pub(super) fn fitted(&self, argument: &Argument) -> Result<Value, Diagnostic> {
        let kind = argument.kind;
        let misfit = || {
            let (keyword, takes) = (argument.keyword(), kind.describe());
            let what = format!("{keyword} takes {takes}, not {}", self.described());
            Diagnostic::error("unfit_value", what)
        };
        let count = |n: usize, min: usize, max: usize| match (min..=max).contains(&n) {
            true => Ok(()),
            false => {
                let (keyword, takes) = (argument.keyword(), kind.describe());
                let what = format!("{keyword} takes {takes}, not {n}");
                Err(Diagnostic::error("wrong_count", what))
            }
        };
        let value = match (kind, self) {
            (Kind::Flag, Setting::Flag) => Value::Flag,
            (Kind::Real { .. }, _) => match self.reals().as_deref() {
                Some(&[x]) => Value::Real(Number::plain(finite(argument, x)?)),
                _ => return Err(misfit()),
            },
            (Kind::Reals { min, max, .. }, _) => {
                let all = self.reals().ok_or_else(misfit)?;
                count(all.len(), min, max)?;
                let all = all.into_iter().map(|x| finite(argument, x));
                Value::Reals(
                    all.map(|x| x.map(Number::plain))
                        .collect::<Result<_, _>>()?,
                )
            }
            (Kind::Id, Setting::Whole(n)) => Value::Id(whole(argument, *n)?),
            (Kind::Ids { min, max }, Setting::Wholes(_) | Setting::Whole(_)) => {
                let all = self.wholes();
                count(all.len(), min, max)?;
                let all = all.into_iter().map(|n| whole(argument, n));
                Value::Ids(all.collect::<Result<_, _>>()?)
            }
            (Kind::Word(of), Setting::Text(word)) => Value::Word(chosen(argument, word, of)?),
            (Kind::Words(of), Setting::Text(words)) => {
                let all = words
                    .split(':')
                    .map(|word| chosen(argument, word.trim(), of));
                Value::Words(all.collect::<Result<_, _>>()?)
            }
            (Kind::Text, Setting::Text(text)) => Value::Text(text.clone()),
            (Kind::Texts, Setting::Text(text)) => Value::Texts(vec![text.clone()]),
            (Kind::Texts, Setting::Texts(all)) => Value::Texts(all.clone()),
            (Kind::Formula, Setting::Text(text)) => Value::Formula(Formula::text(text.clone())),
            (Kind::Formula, Setting::Real(x)) => {
                let number = Number::plain(finite(argument, *x)?);
                Value::Formula(Formula::text(number.to_string()))
            }
            (Kind::Formula, Setting::Whole(n)) => Value::Formula(Formula::text(n.to_string())),
            (Kind::Formula, Setting::User(constants)) => Value::Formula(Formula::User {
                constants: constants.clone(),
                routine: None,
            }),
            (Kind::Raw, Setting::Text(text)) => Value::Raw(text.clone()),
            _ => return Err(misfit()),
        };
        let out_of_range = |what| Diagnostic::error("unfit_value", what);
        argument.admits(&value).map_err(out_of_range)?;
        Ok(value)
    }

    /// Returns the numbers, where there are some.
    fn reals(&self) -> Option<Vec<f64>> {
        match self {
            Setting::Real(x) => Some(vec![*x]),
            Setting::Reals(all) => Some(all.clone()),
            Setting::Whole(n) => Some(vec![*n as f64]),
            Setting::Wholes(all) => Some(all.iter().map(|&n| n as f64).collect()),
            Setting::Flag | Setting::Text(_) | Setting::Texts(_) | Setting::User(_) => None,
            Setting::Handle(..) | Setting::Handles(_) => None,
        }
    }

    fn wholes(&self) -> Vec<i64> {
        match self {
            Setting::Whole(n) => vec![*n],
            Setting::Wholes(all) => all.clone(),
            _ => Vec::new(),
        }
    }

    fn described(&self) -> String {
        match self {
            Setting::Flag => "nothing".into(),
            Setting::Real(x) => format!("{x}"),
            Setting::Whole(n) => format!("{n}"),
            Setting::Reals(_) | Setting::Wholes(_) => "a list of numbers".into(),
            Setting::Text(text) => format!("`{text}`"),
            Setting::Texts(_) => "a list of texts".into(),
            Setting::User(_) => "USER(…)".into(),
            Setting::Handle(..) => "an element".into(),
            Setting::Handles(_) => "a list of elements".into(),
        }
    }
}

fn finite(argument: &Argument, x: f64) -> Result<f64, Diagnostic> {
    match x.is_finite() {
        true => Ok(x),
        false => {
            let what = format!("{} is {x}", argument.keyword());
            Err(Diagnostic::error("unfit_value", what))
        }
    }
}

fn whole(argument: &Argument, n: i64) -> Result<u32, Diagnostic> {
    let found = u32::try_from(n).ok().filter(|&n| n <= i32::MAX as u32);
    found.ok_or_else(|| {
        let what = format!(
            "{} is {n}, which is not a whole number from 0 to 2147483647",
            argument.keyword()
        );
        Diagnostic::error("not_a_whole_number", what)
    })
}

fn chosen(argument: &Argument, word: &str, of: &[&'static str]) -> Result<String, Diagnostic> {
    if of.is_empty() {
        return Ok(word.to_ascii_uppercase());
    }
    if let Meaning::One(k) = meaning(word, of.iter().copied()) {
        return Ok(of[k].to_owned());
    }
    let what = format!(
        "{} is `{word}`, which is none of {}",
        argument.keyword(),
        of.join(", ")
    );
    let said = Diagnostic::error("unknown_word", what);
    let near = near_names(word, of.iter().copied());
    Err(match near.is_empty() {
        true => said,
        false => said.help(format!("did you mean {}?", near.join(" or "))),
    })
}
