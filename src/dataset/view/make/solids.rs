//! Solids of contacts: shapes that are solids of datasets, links as bars with round ends, surfaces
//! and solids of files.

use super::{Maker, Want};
use crate::dataset::view::database::Database;
use crate::dataset::view::mass::bar;
use crate::diagnostic::{Cause, Diagnostic, Span};
use crate::model::{ElementId, ElementKind};
use crate::space::rotation::to_313;
use crate::space::{Mat3, Vec3};

impl Maker<'_> {
    /// Returns the solids that a shape is in a contact: itself, or what it is made of.
    pub(super) fn shapes_of(&mut self, k: usize, shape: usize) -> Vec<ElementId> {
        if let Some(id) = self.ids.get(&shape) {
            return vec![*id];
        }
        let kind = self.db.objects[shape].kind;
        let is_switched_off = self.db.objects[shape].is_idle;
        if kind == "geometry shape link" && !is_switched_off {
            return self.link_solids(shape);
        }
        if kind == "geometry shape shell" && !is_switched_off {
            return self.shell(shape).into_iter().collect();
        }
        let what = kind.rsplit(' ').next().unwrap_or_default();
        let name = self.db.inner_name(shape);
        let what = match is_switched_off {
            true => format!("{name} is switched off (active = off)"),
            false => format!(
                "contact with {name}, a {what}, is not solved: its surface is not in the file"
            ),
        };
        let d = Diagnostic::error(Cause::ViewUnsolved, what);
        let d =
            d.help("contacts know blocks, links, cylinders, ellipsoids, frusta, tori and planes");
        self.say(k, "i_geometry_name", d);
        Vec::new()
    }

    /// Makes the surface of a file of its own.
    fn shell(&mut self, shape: usize) -> Option<ElementId> {
        let id = self.behind(ElementKind::Graphics);
        let head = self.db.objects[shape].head;
        let name = self.db.short_name(shape);
        let mut draft = self.made(id, &name, head)?;
        draft.object = Some(shape);
        draft.flag("SHELL");
        self.element(&mut draft, "reference_marker", "RM");
        let file = self.db.texts(shape, "file_name").concat();
        draft.give("FILE", Want::Text(file), self.db.span(shape, "file_name"));
        self.ids.insert(shape, id);
        self.push(draft);
        Some(id)
    }

    /// Returns a solid of a file that is imported, on the part that its name begins with.
    pub(super) fn imported(&mut self, k: usize, argument: &str, name: &str) -> Vec<ElementId> {
        let full = self.db.full_name(name, None);
        let part = Database::parent(&full);
        let part = part.and_then(|part| self.db.find(part));
        let (Some(part), Some(file)) = (part, self.db.solids_file.clone()) else {
            // tells that there is no such shape
            self.db.references_of(k, argument);
            return Vec::new();
        };
        let head = self.db.objects[k].head;
        let object = self.db.object(&full, "geometry shape imported", head);
        if let Some(id) = self.ids.get(&object) {
            return vec![*id];
        }
        if self.db.objects[part].is_idle {
            return Vec::new();
        }
        let origin = Vec3::zero();
        let axes = Mat3::identity();
        let short = self.db.short_name(object);
        let marker = self.placed_marker(part, &format!("{short}_frame"), origin, axes, head);
        let id = self.behind(ElementKind::Graphics);
        let (Some(marker), Some(mut draft)) = (marker, self.made(id, &short, head)) else {
            return Vec::new();
        };
        draft.flag("EXTERNAL");
        draft.give("RM", Want::Object(marker), head);
        draft.give("FILE", Want::Text(file), head);
        draft.give("ELEMENT", Want::Text(short), head);
        self.ids.insert(object, id);
        self.push(draft);
        vec![id]
    }

    /// Makes the solids of a link: its bar and its two round ends.
    fn link_solids(&mut self, k: usize) -> Vec<ElementId> {
        let name = self.db.objects[k].name.clone();
        if let Some(first) = self.db.find(&format!("{name}_bar")) {
            let ends = ["end_i", "end_j"].map(|end| self.db.find(&format!("{name}_{end}")));
            let all = [Some(first), ends[0], ends[1]];
            return all
                .iter()
                .flatten()
                .filter_map(|k| self.ids.get(k).copied())
                .collect();
        }
        self.make_link_solids(k, &name).unwrap_or_default()
    }

    fn make_link_solids(&mut self, k: usize, name: &str) -> Option<Vec<ElementId>> {
        let part = self.db.owner(k)?;
        let own = self.db.pose(part).ok()?.inverse();
        let i = self.db.reference_of(k, "i_marker")?;
        let j = self.db.reference_of(k, "j_marker")?;
        let [i, j] = [
            own.compose(&self.db.pose(i).ok()?),
            own.compose(&self.db.pose(j).ok()?),
        ];
        let (width, depth) = (self.db.number(k, "width")?, self.db.number(k, "depth")?);
        let (frame, length) = bar(&i, &j);
        let R = frame.rotation;
        let (y, z) = (R.column(1), R.column(2));
        let corner = i.position - y.times(width / 2.0) - z.times(depth / 2.0);
        let back = z.times(depth / 2.0);
        let head = self.db.objects[k].head;
        let mut ids = Vec::new();
        let solids = [
            ("bar", corner),
            ("end_i", i.position - back),
            ("end_j", j.position - back),
        ];
        for (what, place) in solids {
            let label = format!("{}_{what}", self.db.short_name(k));
            let marker = self.placed_marker(part, &label, place, R, head)?;
            let id = self.behind(ElementKind::Graphics);
            let mut draft = self.made(id, &label, head)?;
            if what == "bar" {
                draft.flag("BOX");
                draft.give("CORNER", Want::Object(marker), head);
                for (keyword, side) in [("X", length), ("Y", width), ("Z", depth)] {
                    draft.give(keyword, Want::Numbers(vec![side]), head);
                }
            } else {
                draft.flag("CYLINDER");
                draft.give("CM", Want::Object(marker), head);
                draft.give("LENGTH", Want::Numbers(vec![depth]), head);
                draft.give("RADIUS", Want::Numbers(vec![width / 2.0]), head);
            }
            let object = self.db.object(
                &format!("{name}_{what}"),
                "geometry shape part_of_link",
                head,
            );
            self.ids.insert(object, id);
            self.push(draft);
            ids.push(id);
        }
        Some(ids)
    }

    /// Makes a marker on a part.
    fn placed_marker(
        &mut self,
        part: usize,
        name: &str,
        place: Vec3<f64>,
        R: Mat3<f64>,
        head: Span,
    ) -> Option<ElementId> {
        let owner = *self.ids.get(&part)?;
        let id = self.behind(ElementKind::Marker);
        let mut draft = self.made(id, name, head)?;
        draft.give("PART", Want::Object(owner), head);
        draft.give("QP", Want::Numbers(place.0.to_vec()), head);
        let angles = to_313(&R).map(f64::to_degrees);
        draft.give("REULER", Want::Degrees(angles.to_vec()), head);
        self.push(draft);
        Some(id)
    }
}
