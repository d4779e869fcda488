//! cognate: the ADAMS function language and the multibody solver that speaks it.
//!
//! ```
//! use cognate::expr::Expr;
//! let f = Expr::parse("STEP5(TIME, 0, 0, 1, 10) * SIN(2*PI*TIME)")?;
//! assert_eq!(f.eval(&[("TIME", 0.25)])?, 1.03515625);
//! # Ok::<(), cognate::Error>(())
//! ```
//!
//! It evaluates the functions that engineers write into their models, with derivatives; it reads
//! their models (`.adm`) and commands (`.acf`), or takes models that a program makes; it moves the
//! mechanisms, finds equilibria and modes; and it says what is wrong with all of these, by place
//! and name, with advice.
//!
//! # A map
//!
//! | to | begin with |
//! |---|---|
//! | read an expression, find its mistakes | [`expr::Expr`] |
//! | evaluate it often, with derivatives | [`expr::Evaluator`] |
//! | give it variables and functions of one's own | [`expr::Names`] |
//! | write a formula once, for values, derivatives, rates, batches | [`scalar::Scalar`] |
//! | read a model | [`Model::read`] |
//! | make a model | [`ModelBuilder`] |
//! | simulate it, read the results | [`Session`] |
//! | run it many times | [`analysis::sweep`] |
//! | count its freedoms, find its modes | [`analysis::verify`], [`analysis::linear`] |
//! | check a dataset, write it in a regular form | [`dataset`] |
//! | read and write results | [`results`] |
//! | integrate equations of your own | [`numeric`] |
//! | give files that are not on a disk | [`disk::give`] |
//! | tell a mistake to a user | [`Error`], [`diagnostic::Diagnostic`] |
//!
//! # Programs
//!
//! These, and longer ones in `examples/`, run as they stand.
//!
//! **Mistakes** come with a code, a place and advice:
//!
//! ```
//! use cognate::expr::Expr;
//! let error = Expr::parse("2*STPE(TIME, 1, 0, 2, 1)").unwrap_err();
//! assert_eq!((error.code(), error.first().column), ("unknown_name", 3));
//! assert_eq!(error.first().help, ["did you mean STEP?"]);
//! ```
//!
//! **Inputs** of a formula are known before it is evaluated, by the names of the language:
//!
//! ```
//! use cognate::expr::Expr;
//! let spring = Expr::parse("-25*(DM(10,20) - 10) - 2*VR(10,20)")?;
//! let names: Vec<String> = spring.inputs().iter().map(|input| input.to_string()).collect();
//! assert_eq!(names, ["DM(10, 20)", "VR(10, 20)"]);
//! # Ok::<(), cognate::Error>(())
//! ```
//!
//! **An evaluator** is compiled once and then fast: values, slopes, rates in time, columns.
//!
//! ```
//! use cognate::expr::Evaluator;
//! let mut f = Evaluator::parse("TIME**3")?;
//! assert_eq!(f.eval(&[2.0])?, 8.0);
//! assert_eq!(f.gradient(&[2.0])?, [12.0]);
//! assert_eq!(f.rates(&[[2.0, 1.0, 0.0]])?, [8.0, 12.0, 12.0]); // TIME runs with rate 1
//! assert_eq!(f.batch(&[&[1.0, 2.0, 3.0]])?, [1.0, 8.0, 27.0]);
//! # Ok::<(), cognate::Error>(())
//! ```
//!
//! **Names of one's own**: variables, constants, functions in the language or in Rust.
//!
//! ```
//! use cognate::expr::{Evaluator, Expr, Names};
//! let names = Names::new().variables(["x"]).define("hertz(x, k)", "k*MAX(x, 0)**1.5");
//! let mut f = Evaluator::new(Expr::parse_with("hertz(x, 100)", &names)?, &Default::default())?;
//! assert_eq!((f.eval(&[4.0])?, f.gradient(&[4.0])?), (800.0, vec![300.0]));
//! # Ok::<(), cognate::Error>(())
//! ```
//!
//! **A dataset** is read, simulated, and looked at by the names of columns:
//!
//! ```
//! # #[cfg(not(feature = "solver"))] fn main() {}
//! # #[cfg(feature = "solver")] fn main() -> Result<(), cognate::Error> {
//! use cognate::{Analysis, Model, Options, Session};
//! let model = Model::read("examples/slider_crank.adm")?;
//! let mut session = Session::new(model, "crank", Options::default());
//! session.add_column("DX(41,22)")?;
//! session.run_to(Analysis::Dynamic, 0.5, 100)?;
//! assert_eq!(session.run.column("DX(41,22)").map(<[f64]>::len), Some(101));
//! # Ok(()) }
//! ```
//!
//! **A model is made** by names; numbers are handed out, and written datasets keep the names:
//!
//! ```
//! # #[cfg(not(feature = "solver"))] fn main() {}
//! # #[cfg(feature = "solver")] fn main() -> Result<(), cognate::Error> {
//! use cognate::{Analysis, ModelBuilder, Options};
//! let model = ModelBuilder::new("pendulum");
//! model.units("MKS").gravity([0.0, -9.81, 0.0]);
//! let rod = model.part("rod").mass(2.0).inertia([0.0, 0.2, 0.2]).center([0.5, 0.0, 0.0]);
//! model.revolute("hinge", &rod.at([0.0; 3]), &model.ground());
//! assert!(model.build()?.to_text().contains("adams_view_name='hinge'"));
//!
//! let mut session = model.session(Options::default())?;
//! session.run_to(Analysis::Dynamic, 1.0, 10)?;
//! # Ok(()) }
//! ```
//!
//! **Laws are closures** where text is not enough:
//!
//! ```
//! # #[cfg(not(feature = "solver"))] fn main() {}
//! # #[cfg(feature = "solver")] fn main() -> Result<(), cognate::Error> {
//! use cognate::ModelBuilder;
//! let model = ModelBuilder::new("a mass on a spring");
//! let mass = model.part("mass").mass(1.0).inertia([1.0; 3]).center([0.0; 3]);
//! let (i, j) = (mass.at([0.0; 3]), model.ground().at([0.0, 0.0, -1.0]));
//! let spring = model.force("spring", &i, &j);
//! spring.law([format!("DM({i},{j})")], |_time, [length]| -100.0 * (length - 1.0).powi(3));
//! # model.build()?;
//! # Ok(()) }
//! ```
//!
//! **All mistakes of a model** are told at once, by the names of elements:
//!
//! ```
//! # #[cfg(not(feature = "solver"))] fn main() {}
//! # #[cfg(feature = "solver")] fn main() {
//! use cognate::ModelBuilder;
//! let model = ModelBuilder::new("two mistakes");
//! let wheel = model.part("wheel").mass(f64::NAN);
//! model.revolute("axle", &wheel, &model.ground());
//! let error = model.build().unwrap_err();
//! assert_eq!(error.diagnostics().len(), 2);
//! assert!(error.to_string().contains("PART/2 'wheel': error[unfit_value]: MASS is NaN"));
//! # }
//! ```
//!
//! **Rest and modes**: an equilibrium, and the eigenvalues about it:
//!
//! ```
//! # #[cfg(not(feature = "solver"))] fn main() {}
//! # #[cfg(feature = "solver")] fn main() -> Result<(), cognate::Error> {
//! use cognate::{Analysis, ModelBuilder, Options, analysis::linear::Wanted};
//! let model = ModelBuilder::new("a mass on a spring");
//! let mass = model.part("mass").mass(4.0).inertia([1.0; 3]).center([0.0; 3]);
//! let (i, j) = (mass.at([0.0, 0.0, 1.0]), model.ground().at([0.0; 3]));
//! model.translational("guide", &i, &model.ground());
//! model.spring("spring", &i, &j).set("K", 100).set("LENGTH", 1).set("C", 0);
//! let mut session = model.session(Options::default())?;
//! session.run_to(Analysis::Static, 0.0, 1)?;
//! let linear = session.linearize(&Wanted::default())?;
//! let frequency = linear.modes.first().map(|mode| mode.im.abs());
//! assert!(frequency.is_some_and(|w| (w - 5.0).abs() < 1e-6)); // √(k/m) in rad/s
//! # Ok(()) }
//! ```
//!
//! **Results** are a table with units, which any format writes and reads:
//!
//! ```
//! # #[cfg(not(feature = "solver"))] fn main() {}
//! # #[cfg(feature = "solver")] fn main() -> Result<(), cognate::Error> {
//! use cognate::{Analysis, Model, Options, Session, results};
//! let model = Model::read("examples/slider_crank.adm")?;
//! let mut session = Session::new(model, "crank", Options::default());
//! session.run_to(Analysis::Dynamic, 0.1, 10)?;
//! let text = results::csv::write(&session.run, true);
//! let read = results::csv::read(text.as_bytes())?;
//! assert_eq!((read.rows(), read.columns.len()), (11, session.run.table_columns().len()));
//! # Ok(()) }
//! ```
//!
//! # Errors
//!
//! Mistakes of a caller are an [`Error`]: all of them at once, each with a code (which
//! `cognate explain CODE` explains), place, element by name, and advice. It is a
//! [`std::error::Error`], prints completely, and works with `?`. What happens in numbers is no
//! error but a [`results::Status`] with the results so far: the time, the step and the
//! name of the worst row. Nothing that is passed to the library makes it panic.
//!
//! # Conventions
//!
//! Lengths, masses, forces and times are in the units of the model, angles in radians. Vectors are
//! named after their frames: `p_JI_K` is the position of I from J expressed in K, `R_GP` turns
//! vectors of P into vectors of G. The same input gives the same bits in every run.
//!
//! # Features
//!
//! | feature | brings |
//! |---|---|
//! | none | the evaluator: [`expr`], [`scalar`]; no linear algebra in its dependency tree |
//! | `native` | code of the processor for programs that run often (x86-64 under Linux) |
//! | `solver` | models, their simulation, results |
//! | `geometry` | contacts of convex solids, by parry |
//! | `parquet` | results as Parquet |
//! | `pages` | runs as pages that move, as `.glb` files and as drawings |
//! | `plots` | curves over time, as SVG and in the letters of a terminal |
//! | `png`, `pdf` | drawings and plots as PNG, as PDF |
//! | `serde` | expressions and models as texts, mistakes and rows of sweeps as data |
//! | `setup` | load cases, functions and set-ups beside a model (`MODEL.toml`) |
//!
//! `native`, `solver` and `geometry` are there by default. The command line is a crate of its own,
//! `cognate-cli`. Without `native` there is no unsafe Rust here.
//!
//! # Floors
//!
//! A module uses lower floors only. The model stands above physics because its joints are rows of
//! the table of joints; results stand beside the scene because they know nothing of it:
//!
//! ```text
//! 6  build  setup serialization models made by programs; load cases beside them; serde
//! 5  analysis   report          simulations of a scene; plots of results
//! 4  dataset  scene  results    files of models; equations; records and files of results
//! 3  model                      the elements as the user wrote them
//! 2  physics                    laws of single elements, and of measures
//! 1  expr  space  numeric       the language; frames; methods and linear algebra
//! 0  clock  scalar  diagnostic  time that passes; numbers; messages and places
//! ```
//!
// without `solver` there is nothing to link to but the feature
#![cfg_attr(
    feature = "solver",
    doc = "
[`Model::read`]: crate::Model::read
[`ModelBuilder`]: crate::ModelBuilder
[`Session`]: crate::Session
[`analysis::sweep`]: crate::analysis::sweep
[`analysis::verify`]: crate::analysis::verify
[`analysis::linear`]: crate::analysis::linear
[`dataset`]: crate::dataset
[`results`]: crate::results
[`numeric`]: crate::numeric
[`disk::give`]: crate::disk::give
[`results::Status`]: crate::results::Status
"
)]
#![cfg_attr(
    not(feature = "solver"),
    doc = "
[`Model::read`]: #features
[`ModelBuilder`]: #features
[`Session`]: #features
[`analysis::sweep`]: #features
[`analysis::verify`]: #features
[`analysis::linear`]: #features
[`dataset`]: #features
[`results`]: #features
[`numeric`]: #features
[`disk::give`]: #features
[`results::Status`]: #features
"
)]
#![warn(missing_docs)]
// without generated code there is no unsafe Rust; with it, where it is allowed by name (see
// fuzz/README.md)
#![cfg_attr(not(feature = "native"), forbid(unsafe_code))]
#![deny(unsafe_code)]
// the same bits on every system: elementary functions are those of `scalar`
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]
// names follow the monogram notation: capitals are frames and only frames (`p_JI_K`, `R_GP`)
#![allow(non_snake_case)]

/// Programs of the README, as doc tests.
#[cfg(all(doctest, feature = "solver"))]
#[doc = include_str!("../README.md")]
struct Readme;

// floor 0
mod arrange;
mod clock;
pub mod diagnostic;
#[cfg(feature = "solver")]
pub mod disk;
#[cfg(feature = "solver")]
mod encoding;
mod random;
pub mod scalar;

pub use diagnostic::Error;
// floor 1
pub mod expr;
#[cfg(feature = "solver")]
pub mod numeric;
mod space;
// floor 2
mod physics;
// floor 3
#[cfg(feature = "solver")]
pub mod model;
#[cfg(feature = "solver")]
pub use model::Model;
// floor 4
#[cfg(feature = "solver")]
pub mod dataset;
#[cfg(feature = "solver")]
pub mod results;
#[cfg(feature = "solver")]
mod scene;
// floor 5
#[cfg(feature = "solver")]
pub mod analysis;
#[cfg(feature = "pages")]
#[allow(clippy::disallowed_methods, reason = "pictures have few digits")]
mod report;
// floor 6
#[cfg(feature = "solver")]
pub mod build;
#[doc(hidden)]
pub mod internals;
#[cfg(feature = "serde")]
mod serialization;
#[cfg(feature = "setup")]
pub mod setup;
#[cfg(feature = "solver")]
pub use analysis::session::{Analysis, Options, Session};
#[cfg(feature = "solver")]
pub use build::ModelBuilder;
