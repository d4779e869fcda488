//! The dataset as data, as the user wrote it. Numbers are the user's, in the user's units; angles
//! are radians.
//!
//! Elements refer to each other by their numbers, unresolved, so that a model can be built, changed
//! and printed in any order. All fields are public; `check` and the scene compiler say what does
//! not fit together. Nothing here knows how anything is computed.

mod apart;
mod beginning;
mod body;
mod called;
pub mod check;
mod constraint;
mod element;
mod force;
pub(crate) mod geometry;
mod labels;
mod loads;
mod many_requests;
mod numbered;
mod output;
pub mod reference;
mod settings;
mod system;
mod text;
pub mod units;

pub use beginning::{BALL, Beginning, InitialQuantity};
pub use body::*;
pub use constraint::*;
pub use element::{Element, ElementId, ElementKind, Family, Named};
pub use force::*;
pub use labels::Labels;
pub use output::*;
pub use settings::*;
pub use system::*;
pub use text::Text;

use std::collections::{BTreeMap, BTreeSet};

/// Elements of one kind by their numbers.
pub type ById<T> = BTreeMap<u32, T>;

/// Where an element was written, its name, and what of it carries no mechanics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place {
    /// 1-based line of the statement's first character; 0 when built by a program
    pub line: usize,
    /// the name given by `adams_view_name='…'`
    pub name: Option<String>,
    /// arguments that are kept but not used: full keyword and text of the value, empty for a bare
    /// keyword
    pub extra: Vec<(String, String)>,
}

/// A FUNCTION as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// an expression of the function language
    Expression {
        /// the text, continuation commas removed
        text: Text,
        /// line of its first character in the file; 0 when built by a program
        line: usize,
        /// column of its first character in that line
        column: usize,
        /// where the text went on, on later lines
        breaks: Vec<Break>,
    },
    /// `USER(r1, …)`, computed by a routine of the user's
    User {
        /// r1, …
        constants: Vec<f64>,
        /// `ROUTINE=library::entry`
        routine: Option<String>,
    },
}

/// From this byte of an expression on, the text stands at this line and column of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Break {
    /// byte of the expression
    pub offset: usize,
    /// 1-based line of the file
    pub line: usize,
    /// 1-based column in that line
    pub column: usize,
}

impl Formula {
    /// An expression built by a program.
    pub fn text(text: impl Into<String>) -> Self {
        Self::unplaced(Text::from(text.into()))
    }

    /// The numbers of `USER(…)`; none of an expression.
    pub(crate) fn user_numbers(&self) -> &[f64] {
        match self {
            Formula::User { constants, .. } => constants,
            Formula::Expression { .. } => &[],
        }
    }

    fn unplaced(text: Text) -> Self {
        Formula::Expression {
            text,
            line: 0,
            column: 0,
            breaks: Vec::new(),
        }
    }

    /// The number that an expression without variables is.
    pub fn constant(&self) -> Option<f64> {
        let Formula::Expression { text, .. } = self else {
            return None;
        };
        // most of them are plain, and asked for often
        let plain = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
        plain.or_else(|| {
            if text.ast().ok()?.certainly_reads() {
                return None;
            }
            text.expression().ok()?.eval(&[]).ok()
        })
    }

    /// Line and column in the file of a byte of the expression; `None` when it was not read from a
    /// file.
    pub fn file_place(&self, offset: usize) -> Option<(usize, usize)> {
        let Formula::Expression {
            text,
            line,
            column,
            breaks,
        } = self
        else {
            return None;
        };
        if *line == 0 {
            return None;
        }
        let last = breaks.iter().rev().find(|b| b.offset <= offset);
        let (from, line, column) = match last {
            Some(b) => (b.offset, b.line, b.column),
            None => (0, *line, *column),
        };
        let walked = text.get(from..offset.min(text.len()))?;
        Some((line, column + walked.chars().count()))
    }
}

impl Default for Formula {
    fn default() -> Self {
        Formula::unplaced(Text::default())
    }
}

macro_rules! model {
    (
        solved { $($(#[$doc:meta])* $kind:ident $keyword:literal $family:ident $list:ident: $type:ident;)* }
        kept { $($kept:tt)* }
    ) => {
        /// The dataset as data: a list for every kind of element, and the settings of the whole
        /// model.
        ///
        /// The lists are those of the table of elements (`element.rs`).
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Model {
            /// the first line of the dataset
            pub title: String,
            /// UNITS; `None` when the dataset names none
            pub units: Option<Units>,
            /// ACCGRAV: acceleration of gravity along ground x, y, z [length/time²]
            pub gravity: [f64; 3],
            $(
                $(#[$doc])*
                #[doc = concat!("(", $keyword, ")")]
                pub $list: ById<$type>,
            )*
            /// elements that are kept as text (MATERIAL, SECTION, FE_PART …)
            pub others: BTreeMap<ElementId, OtherElement>,
            /// INTEGRATOR
            pub integrator: IntegratorSettings,
            /// EQUILIBRIUM
            pub equilibrium: EquilibriumSettings,
            /// KINEMATICS
            pub kinematics: Settings,
            /// IC
            pub initial_conditions: Settings,
            /// OUTPUT, RESULTS, PREFERENCES, DEBUG, LSOLVER …
            pub settings: BTreeMap<SettingsStatement, Settings>,
            /// initial values of joints and markers that no statement has
            pub beginnings: BTreeMap<ElementId, Beginning>,
            /// rigid bodies of several parts, by their names: user's numbers of the PARTs, which
            /// FIXED joints named after the body hold together
            pub rigid_bodies: BTreeMap<String, Vec<u32>>,
            /// elements switched off by DEACTIVATE
            pub inactive: BTreeSet<ElementId>,
        }
    };
}
element::elements!(model);
