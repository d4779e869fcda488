//! The effect of a command on a model.

use super::*;
use crate::diagnostic::Cause;

impl Model {
    /// Does to the model what a command says: changes an element or settings, switches elements on
    /// or off.
    ///
    /// Commands that control the run (SIMULATE, STOP …) leave the model as it is.
    ///
    /// # Errors
    /// An element that does not exist, or values that do not fit; the model is then unchanged.
    ///
    /// # Examples
    /// ```
    /// use cognate::{dataset::command::Script, model::Model};
    /// let mut model = Model::from_text("t\nPART/1, GROUND\nVARIABLE/5, FUNCTION=0\nEND\n")?;
    /// for step in Script::from_text("\nVAR/5, FUN=TIME**2\n")?.steps {
    ///     model.apply(&step.command)?;
    /// }
    /// assert!(format!("{:?}", model.variables[&5].function).contains("TIME**2"));
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn apply(&mut self, command: &Command) -> Result<(), Error> {
        match command {
            Command::Change(record) => self.change(record),
            Command::Activate {
                on,
                kind,
                ids,
                range,
            } => self.activate(*on, *kind, ids, *range),
            Command::File { .. }
            | Command::Simulate(_)
            | Command::Linear(_)
            | Command::Save(_)
            | Command::Reload(_)
            | Command::Show(_)
            | Command::Stop => Ok(()),
        }
    }

    fn change(&mut self, record: &Record) -> Result<(), Error> {
        let arguments = record.row.arguments();
        let mut record = record.clone();
        // LIST asks for a print, DEFAULT for the documented values; neither is a setting.
        let word = |g: &super::super::row::Given| arguments[g.argument].keyword();
        let reset = !record.row.numbered() && record.given.iter().any(|g| word(g) == "DEFAULT");
        if !record.row.numbered() {
            record
                .given
                .retain(|g| !matches!(word(g).as_str(), "LIST" | "DEFAULT"));
        }
        let before = reset.then(|| self.clone());
        if reset {
            record.row.reset(self);
        }
        let mut out = Vec::new();
        enter(&Source::default(), self, &record, true, &mut out);
        if out.is_empty() {
            return Ok(());
        }
        if let Some(before) = before {
            *self = before;
        }
        for d in &mut out {
            (d.span, d.line, d.column) =
                (None, record.place.line, usize::from(record.place.line > 0));
        }
        Err(out.into())
    }

    fn activate(
        &mut self,
        on: bool,
        kind: ElementKind,
        ids: &[u32],
        range: Option<[u32; 2]>,
    ) -> Result<(), Error> {
        let mut out = Vec::new();
        for &id in ids.iter().filter(|id| !self.has(kind.id(**id))) {
            let message = format!("{} does not exist", kind.id(id));
            let mut d = Diagnostic::error(Cause::UnknownElement, message);
            d.help.extend(near_ids(id, self.numbers(kind).into_iter()));
            out.push(d);
        }
        if !out.is_empty() {
            return Err(out.into());
        }
        // most commands name numbers, and there may be one for each element
        let of_range = range.map(|[a, b]| {
            let all = self.numbers(kind).into_iter();
            all.filter(move |id| (a..=b).contains(id))
        });
        for id in ids.iter().copied().chain(of_range.into_iter().flatten()) {
            let key = kind.id(id);
            if on {
                self.inactive.remove(&key);
            } else {
                self.inactive.insert(key);
            }
        }
        Ok(())
    }
}
