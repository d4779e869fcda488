//! Results: what a run produced, and one file per format that it is written to or read from.
//!
//! A [`Run`] is a table with a story. The table has named [`Column`]s of one length, the first of
//! which is time. [`Sequence`]s say which rows belong to which simulation, [`Entity`]s which
//! columns are components of which element. The story is the [`Record`] (status, counts, timings,
//! warnings) and the log of [`Event`]s. Formats know these types and nothing of each other.

pub mod comparison;
pub mod csv;
mod cut;
mod digest;
mod file;
pub mod format;
pub mod gra;
pub mod json;
pub(crate) mod kept;
mod log;
pub mod msg;
pub mod msg_table;
mod named;
mod number;
pub(crate) mod output_folder;
#[cfg(feature = "parquet")]
pub mod parquet;
mod part_file;
mod record;
pub mod req;
pub mod res;
mod run;
mod seconds;
mod units;
mod words;
mod writing;

pub use digest::digest;
pub use file::{read, write, write_bytes, write_text};
pub use log::Event;
pub use number::{digits, digits_of_six};
pub(crate) use record::USUAL_SHARE;
pub use record::{
    Accuracy, ChannelAccuracy, Counts, Energy, InputTable, Jump, Loads, Quantity, RankChange,
    Record, RowChange, Simulation, Status, Warning,
};
pub use run::{Column, Component, Entity, Kind, Requested, Run, Sequence, Switched};
pub use seconds::Seconds;
pub use units::{Units, component_unit};
pub use words::word_of;
pub use writing::Writing;

use cut::{no_row, whole_lines};
use number::{malformed, number};
