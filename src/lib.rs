//! cognate: the ADAMS function language and the multibody solver that speaks it.
//!
//! # A guide
//!
//! | to | begin with |
//! |---|---|
//! | evaluate an expression, differentiate it, find its mistakes | [`expr::Expr`] |
//! | write a formula once, for values, derivatives, rates, batches | [`scalar::Scalar`] |
//! | read a model, simulate it, read the results | `model::Model`, `analysis::session::Session` |
//! | check a dataset, or convert results | `dataset`, `results` |
//! | integrate equations of your own | `numeric` |
//!
//! An expression is read, checked and evaluated in two lines:
//!
//! ```
//! use cognate::expr::Expr;
//! let f = Expr::parse("STEP5(TIME, 0, 0, 1, 10) * SIN(2*PI*TIME)")?;
//! assert_eq!(f.eval(&[("TIME", 0.25)])?, 1.03515625);
//! # Ok::<(), cognate::Error>(())
//! ```
//!
//! A model is read, simulated, and its results are read by the names of their columns:
//!
//! ```no_run
//! # #[cfg(feature = "solver")] {
//! use cognate::analysis::{session::{Analysis, Options, Session}, watch::Unwatched};
//! let model = cognate::model::Model::read("examples/slider_crank.adm")?;
//! let options = Options { columns: vec!["DX(41,22)".into()], ..Options::default() };
//! let mut session = Session::new(model, "crank", options);
//! session.simulate(Analysis::Dynamic, 2.0, 400, &mut Unwatched).ok();
//! let x = session.run.column("DX(41,22)");
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Conventions
//!
//! Lengths, masses, forces and times are in the units of the model, angles in radians. Vectors are
//! named after their frames: `p_JI_K` is the position of I from J expressed in K, `R_GP` turns
//! vectors of P into vectors of G. Every mistake of a user is a [`diagnostic::Diagnostic`] with a
//! code, a place and advice. The same input gives the same bits in every run.
//!
//! # Features
//!
//! Without any, the crate is an evaluator of expressions and has no linear algebra in its
//! dependency tree. `native` makes code of the processor at hand for programs that run often;
//! without it there is no unsafe Rust here. `solver` adds models and their simulation, `geometry`
//! the contacts of convex solids that need parry, `cli` the command line.
//!
//! # Floors
//!
//! A module uses lower floors only. The model stands above physics because its joints are rows of
//! the table of joints; results stand beside the scene because they know nothing of it:
//!
//! ```text
//! 6  cli                        the command line
//! 5  analysis   report          simulations of a scene; plots of results
//! 4  dataset  scene  results    files of models; equations; records and files of results
//! 3  model                      the elements as the user wrote them
//! 2  physics                    laws of single elements, and of measures
//! 1  expr  space  numeric       the language; frames; methods and linear algebra
//! 0  scalar  diagnostic         numbers; messages and places
//! ```

#![warn(missing_docs)]
// without generated code there is no unsafe Rust; with it, where it is allowed by name (see
// fuzz/README.md)
#![cfg_attr(not(feature = "native"), forbid(unsafe_code))]
#![deny(unsafe_code)]
// names follow the monogram notation: capitals are frames and only frames (`p_JI_K`, `R_GP`)
#![allow(non_snake_case)]

/// Programs of the README, as doc tests.
#[cfg(all(doctest, feature = "solver"))]
#[doc = include_str!("../README.md")]
struct Readme;

// floor 0
pub mod diagnostic;
pub mod scalar;

pub use diagnostic::Error;
// floor 1
pub mod expr;
#[cfg(feature = "solver")]
pub mod numeric;
pub mod space;
// floor 2
pub mod physics;
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
pub mod scene;
// floor 5
#[cfg(feature = "solver")]
pub mod analysis;
#[cfg(feature = "cli")]
pub mod report;
// floor 6
#[cfg(feature = "solver")]
pub mod build;
#[cfg(feature = "cli")]
pub mod cli;

#[cfg(feature = "solver")]
pub use analysis::session::{Analysis, Options, Session};
#[cfg(feature = "solver")]
pub use build::ModelBuilder;
