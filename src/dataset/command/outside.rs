//! Names of results in command files: others write these, so they stay in the folder of the
//! results.

use super::{Command, Script, last_component};
use crate::diagnostic::Diagnostic;
use crate::disk::{self, leads_outside};

impl Script {
    /// Takes OUTPUT_PREFIX and the files of LINEAR without their folders, where these lead out of
    /// the folder of the results; says so among the diagnostics.
    pub fn keep_inside(&mut self) {
        let output_line = self.output_line;
        let named = self.output.iter_mut();
        let mut named: Vec<_> = named
            .map(|name| ("OUTPUT_PREFIX", output_line, name))
            .collect();
        for step in &mut self.steps {
            if let Command::Linear(linear) = &mut step.command
                && let Some(name) = &mut linear.file
            {
                named.push(("FILE", step.line, name));
            }
        }
        let file = self.path.as_ref().map(disk::text);
        for (argument, line, name) in named {
            if !leads_outside(name) {
                continue;
            }
            let inside = match last_component(name) {
                "" | "." | ".." => "results",
                last => last,
            };
            let what = format!(
                "{argument}={name} leads out of the folder of the results: {inside} is taken in its \
                 place; --trust-paths takes it as it stands"
            );
            let mut d = Diagnostic::warning("outside_folder", what);
            (d.file, d.line, d.column) = (file.clone(), line, usize::from(line > 0));
            self.diagnostics.push(d);
            *name = inside.to_owned();
        }
    }
}
