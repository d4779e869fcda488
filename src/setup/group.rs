//! Groups of functions: every function is in at least one, and groups can hold groups.
//!
//! `USER_DEFINED` holds the user's functions that no group names. Functions that a run has produced
//! are in the group of that run, which needs no entry: it is named as the run is.

use super::{Named, Setup};
use crate::diagnostic::{Diagnostic, near_names};

/// The group of functions that no other group names.
pub const USER_DEFINED: &str = "USER_DEFINED";

/// A named group.
#[derive(Clone, Debug)]
pub struct Group {
    /// its name
    pub name: Named,
    /// what it holds
    pub members: Members,
}

/// The members of a group.
#[derive(Clone, Debug)]
pub enum Members {
    /// functions of the user's, or columns of results
    Functions(Vec<Named>),
    /// other groups
    Groups(Vec<Named>),
}

impl Setup {
    /// Returns the group of a name.
    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|g| g.name.text == name)
    }

    /// Returns the user's functions that are in no group but `USER_DEFINED`.
    fn ungrouped(&self) -> Vec<String> {
        let is_named = |name: &str| {
            self.groups.iter().any(|g| match &g.members {
                Members::Functions(all) => {
                    g.name.text != USER_DEFINED && all.iter().any(|n| n.text == name)
                }
                Members::Groups(_) => false,
            })
        };
        let names = self.functions.iter().map(|f| f.name.text.clone());
        names.filter(|name| !is_named(name)).collect()
    }

    /// Returns the functions of a group and of the groups in it, each once, in order; `None` where
    /// the file has no such group.
    pub fn functions_of(&self, name: &str) -> Option<Vec<String>> {
        if name != USER_DEFINED && self.group(name).is_none() {
            return None;
        }
        let mut found: Vec<String> = Vec::new();
        let mut open = vec![name];
        while let Some(name) = open.pop() {
            let mut take = |function: String| {
                if !found.contains(&function) {
                    found.push(function);
                }
            };
            match self.group(name).map(|g| &g.members) {
                Some(Members::Groups(groups)) => {
                    open.extend(groups.iter().rev().map(|g| g.text.as_str()));
                }
                Some(Members::Functions(all)) => all.iter().for_each(|n| take(n.text.clone())),
                None => {}
            }
            if name == USER_DEFINED {
                self.ungrouped().into_iter().for_each(&mut take);
            }
        }
        Some(found)
    }

    /// Returns the names of all groups of the file, `USER_DEFINED` first.
    pub fn group_names(&self) -> Vec<&str> {
        let own = self.groups.iter().map(|g| g.name.text.as_str());
        let own = own.filter(|name| *name != USER_DEFINED);
        std::iter::once(USER_DEFINED).chain(own).collect()
    }
}

/// Returns what is wrong with the groups of a file: groups that do not exist or hold themselves,
/// results in `USER_DEFINED`.
pub(super) fn mistakes(setup: &Setup) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let known = setup.group_names();
    for group in &setup.groups {
        let of_user = group.name.text == USER_DEFINED;
        match &group.members {
            Members::Groups(_) if of_user => {
                let what = "USER_DEFINED is a group of functions";
                found.push(setup.mistake(group.name.span, "bad_setup", what));
            }
            Members::Groups(all) => {
                for name in all.iter().filter(|n| !known.contains(&n.text.as_str())) {
                    let what = format!("there is no group `{}`", name.text);
                    let d = setup.mistake(name.span, "unknown_group", what);
                    let near = near_names(&name.text, known.iter().copied());
                    found.push(match near.is_empty() {
                        true => d.help(format!("groups: {}", known.join(", "))),
                        false => d.help(format!("did you mean {}?", near.join(" or "))),
                    });
                }
            }
            Members::Functions(all) if of_user => {
                let results = all.iter().filter(|n| setup.function(&n.text).is_none());
                for name in results {
                    let what = format!("`{}` is no function of [functions]", name.text);
                    let d = setup.mistake(name.span, "unknown_function", what);
                    let advice = "USER_DEFINED holds functions of yours, and no results of a run";
                    found.push(d.help(advice));
                }
            }
            Members::Functions(_) => {}
        }
    }
    if found.is_empty() {
        let circular = setup.groups.iter().filter(|g| holds_itself(setup, g));
        found.extend(circular.map(|g| {
            let what = format!("the group {} holds itself", g.name.text);
            setup.mistake(g.name.span, "circular_group", what)
        }));
    }
    found
}

/// Returns whether a group is among the groups below it.
fn holds_itself(setup: &Setup, group: &Group) -> bool {
    let mut seen: Vec<&str> = Vec::new();
    let mut open = vec![group];
    while let Some(next) = open.pop() {
        let Members::Groups(below) = &next.members else {
            continue;
        };
        for name in below {
            if name.text == group.name.text {
                return true;
            }
            if !seen.contains(&name.text.as_str()) {
                seen.push(&name.text);
                open.extend(setup.group(&name.text));
            }
        }
    }
    false
}
