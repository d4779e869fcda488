//! Forces that are asked between two markers between which nothing acts: they are zero for ever.

use super::*;
use crate::expr::measures::Measure;
use std::cell::LazyCell;

/// Elements that act, by a marker that they name.
struct Acting<'m> {
    model: &'m Model,
    at: BTreeMap<u32, Vec<ElementId>>,
}

/// The function of each component of what acts between two markers.
fn is_force(measure: Measure) -> bool {
    use Measure as M;
    matches!(
        measure,
        M::Fm | M::Fx | M::Fy | M::Fz | M::Tm | M::Tx | M::Ty | M::Tz
    )
}

impl<'m> Acting<'m> {
    fn new(model: &'m Model) -> Self {
        let mut at: BTreeMap<u32, Vec<ElementId>> = BTreeMap::new();
        for r in model.each_reference() {
            // RM, IRM and JRM lend their axes only
            let acts = matches!(r.element.kind.family(), Family::Force | Family::Constraint)
                && !r.argument.ends_with("RM");
            if acts && r.target.kind == ElementKind::Marker {
                at.entry(r.target.number).or_default().push(r.element);
            }
        }
        Self { model, at }
    }

    fn of(&self, marker: u32) -> &[ElementId] {
        self.at.get(&marker).map_or(&[], Vec::as_slice)
    }

    /// Returns whether anything may act between two markers; `j` = 0: without a reaction.
    fn acts(&self, i: u32, j: u32) -> bool {
        let is_alone = |id: &ElementId| {
            let forces = (id.kind == ElementKind::Sforce).then_some(&self.model.sforces);
            (forces.and_then(|all| all.get(&id.number))).is_some_and(|f| f.action_only)
        };
        match (i, j) {
            (0, m) | (m, 0) => self.of(m).iter().any(is_alone),
            _ => self.of(i).iter().any(|id| self.of(j).contains(id)),
        }
    }

    /// Returns what is wrong with asking a force between two markers, and what could be asked.
    fn doubt(&self, asked: &str, i: u32, j: u32) -> Option<(String, Option<String>)> {
        if self.acts(i, j) {
            return None;
        }
        let marker = |m: u32| self.model.called(ElementKind::Marker.id(m));
        let what = match j {
            0 => format!(
                "{asked} is zero for ever: without J it is what acts on {} without a reaction, and nothing does",
                marker(i)
            ),
            _ => format!(
                "{asked} is zero for ever: nothing acts between {} and {}",
                marker(i),
                marker(j)
            ),
        };
        let mut near = self.of(i).iter().chain(self.of(j)).filter_map(|&id| {
            let [a, b] = self.model.element(id)?.ends()?;
            let id = self.model.called(id);
            Some(format!("{id} acts between {} and {}", marker(a), marker(b)))
        });
        Some((what, near.next()))
    }
}

pub(super) fn forces_act_where_asked(model: &Model, out: &mut Out) {
    let acting = LazyCell::new(|| Acting::new(model));
    for (&id, request) in &model.requests {
        let RequestKind::Force { i, j, .. } = request.kind else {
            continue;
        };
        if let Some((what, near)) = acting.doubt("the FORCE", i, j.unwrap_or(0)) {
            let who = (ElementKind::Request.id(id), &request.place);
            warn(out, "nothing_acts", who, what);
            near.into_iter().for_each(|near| advise(out, near));
        }
    }
    for (owned, measure, [i, j, _]) in model.measure_calls() {
        if !is_force(measure) {
            continue;
        }
        let asked = match j {
            0 => format!("{}({i})", measure.name()),
            _ => format!("{}({i},{j})", measure.name()),
        };
        if let Some((what, near)) = acting.doubt(&asked, i, j) {
            let what = format!("{}: {what}", owned.argument);
            warn(out, "nothing_acts", (owned.element, owned.place), what);
            near.into_iter().for_each(|near| advise(out, near));
        }
    }
}
