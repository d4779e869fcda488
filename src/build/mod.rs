//! Models made by a program: parts, joints, forces and motions by their names, without a number
//! that the caller has to invent.
//!
//! ```text
//! ModelBuilder ── drafts of statements ── build ──▶ Model ──▶ Session
//!                 (names, arguments, closures)      what a dataset would have given
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `statements.rs` | the words of the builder: parts, joints, forces, motions, settings |
//! | `element.rs` | the handle of a statement, to give it arguments |
//! | `setting.rs` | values of arguments, from what a program has |
//! | `draft.rs` | statements on their way into the model |
//! | `pose.rs` | markers that stand at places in ground |
//! | `law.rs` | closures of numbers, typed |
//! | `words.rs` | the words by which Python and C add elements, from the table of statements |
//!
//! Arguments are those of the table of statements, by their keywords: whatever a dataset can say, a
//! builder can. The same rules check both.

mod draft;
mod element;
mod law;
mod pose;
mod setting;
mod statements;
mod words;

pub use element::{Body, Element, Frame, Key, Other};
pub use law::Results;
pub use pose::End;
pub use setting::Setting;
pub use words::Word;

use crate::analysis::session::{Options, Session};
use crate::analysis::system::closures::Hook;
use crate::diagnostic::{Diagnostic, Error};
use crate::model::{ElementKind, Model};
use draft::Draft;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

/// A model that a program makes, a statement after the other in any order.
///
/// Elements get numbers as they are made ([`Element::number`]) and keep their names in written
/// datasets. Handles print as these numbers, so that expressions name them:
/// `format!("DX({a},{b})")`.
/// Lengths, masses, forces and times are in one system of units, which [`units`](Self::units)
/// tells; angles are radians. Places are in ground coordinates, in the position in which the model
/// is drawn.
///
/// Mistakes are collected, and told all at once by [`build`](Self::build).
///
/// A pendulum of one metre, held by a damper that is a closure:
///
/// ```
/// use cognate::analysis::session::Options;
/// use cognate::{Analysis, ModelBuilder};
///
/// let model = ModelBuilder::new("pendulum");
/// model.units("MKS").gravity([0.0, -9.81, 0.0]);
/// let ground = model.ground();
/// let rod = model.part("rod").mass(2.0).inertia([0.0, 0.2, 0.2]).center([0.5, 0.0, 0.0]);
/// let (pivot, tip) = (rod.at([0.0; 3]), rod.at([1.0, 0.0, 0.0]));
/// let hinge = model.revolute("hinge", &pivot, &ground);
/// let damper = model.torque("damper", &pivot, &ground);
/// damper.law([format!("WZ({pivot})")], |_time, [speed]| -0.1 * speed);
///
/// let height = format!("DY({tip})");
/// let mut session = model.session(Options::default())?;
/// session.add_column(&height)?;
/// session.run_to(Analysis::Dynamic, 1.0, 100)?;
/// assert!(session.run.column(&height).is_some_and(|y| y[0] == 0.0 && y[50] < -0.5));
/// assert_eq!(hinge.number(), 1);
/// # Ok::<(), cognate::Error>(())
/// ```
pub struct ModelBuilder {
    inner: RefCell<Inner>,
    /// tells whose statement a [`Key`] stands for
    id: u64,
}

/// Contents of a builder.
#[derive(Default)]
struct Inner {
    title: String,
    drafts: Vec<Draft>,
    /// the last number that was handed out, by kind
    last: BTreeMap<ElementKind, u32>,
    hooks: Vec<Hook>,
    /// mistakes that belong to no draft
    wrong: Vec<Diagnostic>,
}

impl ModelBuilder {
    /// Begins a model of ground alone; `title` is the first line of its dataset.
    pub fn new(title: &str) -> Self {
        let inner = RefCell::new(Inner {
            title: title.to_string(),
            ..Inner::default()
        });
        static LAST: AtomicU64 = AtomicU64::new(0);
        let id = LAST.fetch_add(1, Ordering::Relaxed);
        let this = Self { inner, id };
        this.element(ElementKind::Part, "ground").flag("GROUND");
        this
    }

    /// Makes the model. Closures are not part of it; [`session`](Self::session) brings them along.
    ///
    /// # Errors
    /// Everything that is wrong, by the names of elements: arguments that a statement does not have
    /// or that are missing, values that do not fit, and what [`Model::check`] finds.
    pub fn build(&self) -> Result<Model, Error> {
        self.inner.borrow().model()
    }

    /// Makes the model, and a session of it with the closures that were given.
    ///
    /// # Errors
    /// Those of [`build`](Self::build).
    pub fn session(&self, options: Options) -> Result<Session, Error> {
        let inner = self.inner.borrow();
        let mut session = Session::new(inner.model()?, "run", options);
        for hook in &inner.hooks {
            session.register_hook(hook.clone());
        }
        Ok(session)
    }
}
