//! The program: the command line, files of results, the README. A module a claim's subject; see `tests/README.md`.

#[path = "../common/command.rs"]
mod command;
#[path = "../common/needs.rs"]
mod needs;
#[path = "../common/repository.rs"]
mod repository;
#[path = "../common/results.rs"]
mod result_laws;
#[path = "../common/running.rs"]
mod running;

mod animation;
mod broken;
mod capabilities;
mod cli;
mod cli_eval;
mod configuration;
mod disk;
mod doors;
mod elements;
mod exchange;
mod first_hour;
mod foreseen;
mod gallery;
mod groups;
#[cfg(feature = "geometry")]
mod interference;
mod loads;
mod manual;
mod motion;
mod names;
mod pages;
mod piped;
mod plants;
mod plots;
mod prompt;
mod readers;
mod recorded;
mod report;
mod results;
#[cfg(unix)]
mod routines;
mod runs;
mod sweep;
mod threads;
mod view;
mod viewer;
mod written;
