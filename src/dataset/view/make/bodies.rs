//! Units, gravity, parts with their masses, markers, shapes.

use super::{Draft, Maker, Want};
use crate::dataset::view::database::{Attribute, Item, Pose, Reference};
use crate::dataset::view::frames::cleaned;
use crate::dataset::view::mass::{Mass, Section};
use crate::dataset::view::term::Term;
use crate::dataset::view::{PART, POINT_MASS};
use crate::diagnostic::{Diagnostic, Severity};
use crate::scalar::Scalar;
use crate::space::Mat3;
use crate::space::rotation::to_313;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Share of the size of a part by which a centre that is computed may differ from the one that the
/// file states with ten digits.
const OF_CENTRE: f64 = 1e-6;

impl Maker<'_> {
    /// Makes markers that joints, forces and masses ask for by a place.
    pub(super) fn make_markers(&mut self) {
        for k in 0..self.db.objects.len() {
            let object = &self.db.objects[k];
            if object.is_gone || object.is_idle {
                continue;
            }
            if object.kind.starts_with("constraint") || object.kind.starts_with("force") {
                self.markers_at_place(k);
            } else if object.kind == POINT_MASS || object.kind == PART && !object.is_ground {
                self.marker_at_center(k);
            }
        }
    }

    /// `i_part_name`, `j_part_name`, `location`: a marker on each part at one place.
    fn markers_at_place(&mut self, k: usize) {
        let head = self.db.objects[k].head;
        for side in ["i", "j"] {
            let (part, marker, floating) = match side {
                "i" => ("i_part_name", "i_marker_name", ""),
                _ => ("j_part_name", "j_marker_name", "j_floating_marker_name"),
            };
            if self.db.given(k, marker).is_some() || self.db.given(k, floating).is_some() {
                continue;
            }
            let Some(part) = self.db.reference_of(k, part) else {
                continue;
            };
            let short = self.db.short_name(k);
            let name = format!("{}.{short}_{side}", self.db.objects[part].name);
            let floats = self.db.objects[k]
                .attributes
                .contains_key("ref_marker_name");
            let (kind, argument) = match floats {
                true => ("floating_marker", "j_floating_marker_name"),
                false => ("marker", marker),
            };
            let made = self.db.object(&name, kind, head);
            let frame = self.db.objects[k]
                .attributes
                .get("location")
                .map(|a| a.frame.clone());
            let frame = match frame {
                // of a joint ground is the frame of itself
                None | Some(Reference::Own) => {
                    let model = self.db.model.clone().unwrap_or_default();
                    Reference::Of(format!("{model}.ground"))
                }
                Some(of) => of,
            };
            let places = [
                "location",
                "orientation",
                "along_axis_orientation",
                "in_plane_orientation",
            ];
            for place in places {
                if let Some(given) = self.db.objects[k].attributes.get(place) {
                    let mut given = given.clone();
                    given.frame = frame.clone();
                    if let Some(fixed) = &mut given.fixed {
                        fixed.frame = frame.clone();
                    }
                    self.db.objects[made].attributes.insert(place, given);
                }
            }
            let named = self.named(&name, argument);
            self.db.objects[k].attributes.insert(named.0, named.1);
        }
    }

    /// Returns an argument that names an object.
    fn named(&self, name: &str, argument: &'static str) -> (&'static str, Attribute) {
        let item = Item {
            term: Rc::new(Term::Name(name.to_owned())),
            span: crate::diagnostic::Span::default(),
            is_bare: true,
        };
        let attribute = Attribute {
            items: vec![item],
            ..Attribute::default()
        };
        (argument, attribute)
    }

    /// A part whose mass is given or follows from its shapes has a marker at its centre.
    fn marker_at_center(&mut self, k: usize) {
        if self.db.given(k, "center_of_mass_marker").is_some() {
            return;
        }
        let name = format!("{}.cm", self.db.objects[k].name);
        if self.db.find(&name).is_none() {
            let solid = self.db.solids(k).ok().flatten();
            let is_given = self.db.given(k, "mass").is_some();
            if solid.is_none() && !is_given {
                return;
            }
            let head = self.db.objects[k].head;
            let made = self.db.object(&name, "marker", head);
            let center = solid.map_or([0.0; 3], |solid| solid.center.0);
            let item = |x: f64| Item {
                term: Rc::new(Term::Number(x)),
                span: head,
                is_bare: true,
            };
            let location = Attribute {
                items: center.map(item).to_vec(),
                ..Attribute::default()
            };
            self.db.objects[made]
                .attributes
                .insert("location", location);
        }
        let (argument, attribute) = self.named(&name, "center_of_mass_marker");
        self.db.objects[k].attributes.insert(argument, attribute);
    }

    pub(super) fn make_bodies(&mut self) {
        let parts = self
            .db
            .of_kind("part rigid_body")
            .chain(self.db.of_kind(POINT_MASS));
        for k in parts.collect::<Vec<_>>() {
            self.make_part(k);
        }
        self.tell_of_masses();
        self.note_sides();
        let markers = self
            .db
            .of_kind("marker")
            .chain(self.db.of_kind("floating_marker"));
        for k in markers.collect::<Vec<_>>() {
            self.make_marker(k);
        }
        for k in self.db.of_kind("geometry").collect::<Vec<_>>() {
            self.make_shape(k);
        }
    }

    /// Gives a position and an orientation where they are not those of the frame.
    fn place(&self, draft: &mut Draft, k: usize, local: Pose, position: &str) {
        let span = self.db.span(k, "location");
        let stated = self.stated(k, "location");
        let p = stated.unwrap_or_else(|| cleaned(local.position.0, self.size_of(k)));
        if p != [0.0; 3] {
            draft.give(position, Want::Numbers(p.to_vec()), span);
        }
        let span = self.db.span(k, "orientation");
        let in_degrees = self.db.units.in_degrees();
        match self.stated(k, "orientation") {
            Some([0.0, 0.0, 0.0]) => {}
            Some(angles) if in_degrees => {
                draft.give("REULER", Want::Degrees(angles.to_vec()), span);
            }
            Some(angles) => {
                let angles = angles.map(|x| x * self.db.units.angle());
                draft.give("REULER", Want::Numbers(angles.to_vec()), span);
            }
            None => {
                let angles = degrees(local.rotation);
                if angles != [0.0; 3] {
                    draft.give("REULER", Want::Degrees(angles.to_vec()), span);
                }
            }
        }
    }

    /// Returns the distance from ground of the farthest of an object and its part.
    fn size_of(&self, k: usize) -> f64 {
        let far = |k: usize| self.db.pose(k).map_or(0.0, |pose| pose.position.norm());
        far(k).max(self.db.owner(k).map_or(0.0, far))
    }

    /// Returns three numbers that are those of a dataset already: of body 3-1-3, in the part.
    fn stated(&self, k: usize, argument: &str) -> Option<[f64; 3]> {
        let attribute = self.db.given(k, argument)?;
        if argument == "orientation" && self.db.sequence != Default::default() {
            return None;
        }
        if argument == "location" && self.db.coordinates != Default::default() {
            return None;
        }
        let owner = match self.db.objects[k].kind.starts_with("part") {
            true => None,
            false => self.db.owner(k),
        };
        let is_own = match (self.db.frame_of(attribute), owner) {
            (Reference::Own, _) => true,
            (Reference::Of(name), Some(owner)) => self.db.find(name) == Some(owner),
            (Reference::Of(name), None) => {
                let frame = self.db.find(name);
                frame.is_some_and(|frame| self.db.objects[frame].is_ground)
            }
        };
        let numbers = self.db.numbers(k, argument).filter(|_| is_own)?;
        <[f64; 3]>::try_from(numbers).ok()
    }

    fn make_part(&mut self, k: usize) {
        let Some(mut draft) = self.draft(k) else {
            return;
        };
        if self.db.objects[k].is_ground {
            draft.flag("GROUND");
            self.push(draft);
            return;
        }
        match self.db.pose(k) {
            Ok(pose) => self.place(&mut draft, k, pose, "QG"),
            Err(trouble) => self
                .db
                .trouble(Some(k), self.db.span(k, "location"), &trouble),
        }
        self.give_mass(&mut draft, k);
        self.numbers(
            &mut draft,
            &[("vx", "VX"), ("vy", "VY"), ("vz", "VZ")],
            true,
        );
        for (argument, keyword) in [("wx", "WX"), ("wy", "WY"), ("wz", "WZ")] {
            if let Some(w) = self.db.numbers(k, argument) {
                draft.give(keyword, Want::Angles(w), self.db.span(k, argument));
            }
        }
        self.element(&mut draft, "vm", "VM");
        self.element(&mut draft, "wm", "WM");
        self.note_rates(k);
        if let Some(words) = self
            .db
            .given(k, "exact_coordinates")
            .map(|_| self.db.texts(k, "exact_coordinates"))
        {
            let words: Vec<String> = words.iter().map(|w| w.to_uppercase()).collect();
            let known = |w: &String| ["X", "Y", "Z", "PSI", "THETA", "PHI"].contains(&w.as_str());
            if !words.is_empty() && words.iter().all(known) {
                draft.give(
                    "EXACT",
                    Want::Words(words),
                    self.db.span(k, "exact_coordinates"),
                );
            }
        }
        self.push(draft);
    }

    /// Says once in which unit rates of angles are read.
    fn note_rates(&mut self, k: usize) {
        let rates = ["wx", "wy", "wz"];
        let mut given = rates.iter().filter_map(|w| self.db.number(k, w));
        if self.db.units.in_degrees() && !self.has_told_rates && given.any(|w| w != 0.0) {
            self.has_told_rates = true;
            let what = "initial angular velocities are read in degrees per unit of time, the file's unit of angles";
            let d = Diagnostic {
                severity: Severity::Note,
                ..Diagnostic::warning("view_units", what)
            };
            self.say(k, "wz", d);
        }
    }

    /// Gives mass, centre and inertia: as stated, or of the shapes.
    fn give_mass(&mut self, draft: &mut Draft, k: usize) {
        let mass_given = self.db.given(k, "mass").map(|a| a.span.start);
        let material = ["material_type", "density"];
        let of_shapes = material.iter().filter_map(|m| self.db.given(k, m));
        let of_shapes = of_shapes.map(|a| a.span.start).max();
        let is_stated = mass_given.is_some_and(|at| of_shapes.is_none_or(|other| at > other));
        let is_point = self.db.objects[k].kind == POINT_MASS;
        if is_stated || is_point {
            self.numbers(draft, &[("mass", "MASS")], true);
            let moments = ["ixx", "iyy", "izz", "ixy", "izx", "iyz"];
            let all = moments.map(|m| self.db.number(k, m).unwrap_or(0.0));
            let used = if all[3..] == [0.0; 3] {
                &all[..3]
            } else {
                &all[..]
            };
            self.element(draft, "center_of_mass_marker", "CM");
            if !is_point {
                self.element(draft, "inertia_marker", "IM");
                if used.iter().any(|x| *x != 0.0) {
                    draft.give("IP", Want::Numbers(used.to_vec()), self.db.span(k, "ixx"));
                }
            }
            return;
        }
        self.mass_of_shapes(draft, k, of_shapes.is_some());
    }

    fn mass_of_shapes(&mut self, draft: &mut Draft, k: usize, has_material: bool) {
        let solids = self.db.solids(k);
        let has_mass = self.db.mass_of(k);
        let Some(mass) = has_mass else {
            if self.db.is_within_unread(&self.db.objects[k].name) {
                return;
            }
            let why = match solids {
                Err(why) => why,
                Ok(None) if has_material => "it has no shape of which a volume is known".into(),
                Ok(None) => "it has neither a mass nor shapes".into(),
                Ok(Some(_)) => "the density of its material is not known".into(),
            };
            self.massless.push((k, why));
            self.element(draft, "center_of_mass_marker", "CM");
            return;
        };
        let span = self.db.span(k, "material_type");
        draft.give("MASS", Want::Numbers(vec![mass.mass]), span);
        let marker = self.db.reference_of(k, "center_of_mass_marker");
        let local = marker.and_then(|m| {
            let own = self.db.pose(k).ok()?;
            Some(own.inverse().compose(&self.db.pose(m).ok()?))
        });
        let local = local.unwrap_or_else(Pose::identity);
        self.element(draft, "center_of_mass_marker", "CM");
        let away = (local.position - mass.center).norm();
        if away > OF_CENTRE * (mass.center.norm() + extent(&mass)) {
            let d = Diagnostic::warning(
                "view_mass",
                format!(
                    "the shapes of {} have their centre {away:.3e} beside the marker at its centre of mass",
                    self.db.inner_name(k)
                ),
            );
            let d = d.help("one of its shapes is not what is read here; mass and inertia are those of the shapes as read");
            self.say(k, "material_type", d);
        }
        let in_marker = mass.in_axes(local.rotation);
        let largest = in_marker[..3].iter().fold(0.0_f64, |a, b| a.max(*b));
        let is_principal = in_marker[3..].iter().all(|x| x.abs() <= 1e-6 * largest);
        let ip = match is_principal {
            true => in_marker[..3].to_vec(),
            // products of inertia are positive integrals
            false => {
                let [xx, yy, zz, xy, xz, yz] = in_marker;
                vec![xx, yy, zz, -xy, -xz, -yz]
            }
        };
        draft.give("IP", Want::Numbers(ip), span);
    }

    /// Says once for each reason which masses are not known.
    fn tell_of_masses(&mut self) {
        const SHOWN: usize = 3;
        let mut of_reason: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (k, why) in std::mem::take(&mut self.massless) {
            of_reason.entry(why).or_default().push(k);
        }
        for (why, parts) in of_reason {
            let names = parts.iter().map(|k| self.db.inner_name(*k));
            let mut names: Vec<String> = names.take(SHOWN).collect();
            if parts.len() > SHOWN {
                names.push(format!("{} more", parts.len() - SHOWN));
            }
            let what = match &names[..] {
                [one] => format!("the mass of {one} is not known: {why}"),
                _ => format!("the masses of {} are not known: {why}", names.join(", ")),
            };
            let d = Diagnostic::warning("view_mass", what).help(
                "give them with `part modify rigid_body mass_properties`: mass, ixx, iyy, izz, center_of_mass_marker",
            );
            self.say(parts[0], "material_type", d);
        }
    }

    /// Says once which cylinders of many sides are taken as round.
    fn note_sides(&self) {
        let counts = |k: usize| {
            self.db.owner(k).is_some_and(|part| {
                self.db.given(part, "mass").is_none() && !self.db.objects[part].is_ground
            })
        };
        let all = self.db.of_kind("geometry shape cylinder");
        let odd = all.filter_map(|k| match self.db.section(k) {
            Section::MaybeRound(sides) if counts(k) => Some((k, sides)),
            _ => None,
        });
        let odd: Vec<(usize, f64)> = odd.collect();
        let Some(&(first, sides)) = odd.first() else {
            return;
        };
        let turn = std::f64::consts::TAU;
        let less = 100.0 * (1.0 - sides / turn * Scalar::sin(turn / sides));
        let others = match odd.len() - 1 {
            0 => String::new(),
            n => format!(", and so are {n} more"),
        };
        let what = format!(
            "for its mass {} is a round cylinder{others}; a prism of {sides} sides has {less:.1} % less",
            self.db.inner_name(first)
        );
        let d = Diagnostic {
            severity: Severity::Note,
            ..Diagnostic::warning("view_mass", what)
        };
        self.say(first, "side_count_for_body", d);
    }

    fn make_marker(&mut self, k: usize) {
        let Some(mut draft) = self.draft(k) else {
            return;
        };
        let owner = self.db.owner(k);
        let Some(part) = owner.filter(|o| self.ids.contains_key(o)) else {
            let what = match owner {
                Some(_) => "its part is not part of the model",
                None => "there is no part that holds it",
            };
            let name = self.db.inner_name(k);
            let d = Diagnostic::error("view_left_out", format!("{name}: {what}"));
            return self.say(k, "marker_name", d);
        };
        let id = self.ids[&part];
        let keyword = match id.kind {
            crate::model::ElementKind::PointMass => "POINT_MASS",
            _ => "PART",
        };
        draft.give(keyword, Want::Object(id), draft.record.head);
        if self.db.objects[k].kind == "floating_marker" {
            draft.flag("FLOATING");
            return self.push(draft);
        }
        let local = self
            .db
            .pose(k)
            .and_then(|pose| Ok(self.db.pose(part)?.inverse().compose(&pose)));
        match local {
            Ok(local) => self.place(&mut draft, k, local, "QP"),
            Err(trouble) => self
                .db
                .trouble(Some(k), self.db.span(k, "location"), &trouble),
        }
        self.push(draft);
    }

    /// Gives a box its corner and its sides.
    fn block(&self, draft: &mut Draft, k: usize) {
        draft.flag("BOX");
        self.element(draft, "corner_marker", "CORNER");
        let sides = self.db.numbers(k, "diag_corner_coords").unwrap_or_default();
        let span = self.db.span(k, "diag_corner_coords");
        for (side, keyword) in sides.iter().zip(["X", "Y", "Z"]) {
            draft.give(keyword, Want::Numbers(vec![*side]), span);
        }
    }

    fn make_shape(&mut self, k: usize) {
        let Some(mut draft) = self.draft(k) else {
            return;
        };
        let kind = self.db.objects[k].kind;
        let pairs: &[(&str, &str)] = match kind {
            "geometry shape block" => {
                self.block(&mut draft, k);
                &[]
            }
            "geometry shape cylinder" => {
                draft.flag("CYLINDER");
                &[("length", "LENGTH"), ("radius", "RADIUS")]
            }
            "geometry shape frustum" => {
                draft.flag("FRUSTUM");
                &[
                    ("length", "LENGTH"),
                    ("top_radius", "TOP"),
                    ("bottom_radius", "BOTTOM"),
                ]
            }
            "geometry shape ellipsoid" => {
                draft.flag("ELLIPSOID");
                &[
                    ("x_scale_factor", "XSCALE"),
                    ("y_scale_factor", "YSCALE"),
                    ("z_scale_factor", "ZSCALE"),
                ]
            }
            "geometry shape torus" => {
                draft.flag("TORUS");
                &[
                    ("major_radius", "MAJOR_RADIUS"),
                    ("minor_radius", "MINOR_RADIUS"),
                ]
            }
            "geometry shape plane" => {
                draft.flag("PLANE");
                self.element(&mut draft, "ref_marker_name", "RM");
                &[
                    ("x_minimum", "XMIN"),
                    ("x_maximum", "XMAX"),
                    ("y_minimum", "YMIN"),
                    ("y_maximum", "YMAX"),
                ]
            }
            "geometry shape force" => return self.force_symbol(draft, k),
            "geometry shape spring_damper" => {
                draft.flag("SPDP");
                self.element(&mut draft, "i_marker_name", "I");
                self.element(&mut draft, "j_marker_name", "J");
                &[("coil_count", "COILS"), ("diameter_of_spring", "DA")]
            }
            "geometry curve circle" => {
                draft.flag("CIRCLE");
                &[("radius", "RADIUS")]
            }
            _ => {
                draft.flag("ARC");
                if let Some(angle) = self.db.numbers(k, "angle_extent") {
                    draft.give(
                        "RANGLE",
                        Want::Angles(angle),
                        self.db.span(k, "angle_extent"),
                    );
                }
                &[("radius", "RADIUS")]
            }
        };
        self.numbers(&mut draft, pairs, true);
        if !["block", "plane", "spring_damper"]
            .iter()
            .any(|end| kind.ends_with(end))
        {
            self.element(&mut draft, "center_marker", "CM");
        }
        self.push(draft);
    }
}

impl Maker<'_> {
    /// An arrow for a force.
    fn force_symbol(&mut self, mut draft: Draft, k: usize) {
        let names = [
            "force_element_name",
            "joint_name",
            "jprim_name",
            "curve_curve_name",
            "point_curve_name",
        ];
        let of = names.iter().find_map(|name| {
            self.db.given(k, name)?;
            self.db.reference_of(k, name)
        });
        let Some(id) = of.and_then(|of| self.ids.get(&of).copied()) else {
            return;
        };
        draft.flag("FORCE");
        draft.give(
            "ETYPE",
            Want::Word(id.kind.keyword().into()),
            draft.record.head,
        );
        draft.give("EID", Want::Object(id), draft.record.head);
        self.element(&mut draft, "applied_at_marker_name", "EMARKER");
        self.push(draft);
    }
}

/// Returns the length of a body of which the inertia is known.
fn extent(mass: &Mass) -> f64 {
    let trace: f64 = (0..3).map(|k| mass.tensor.0[k][k]).sum();
    (trace / mass.mass.max(f64::MIN_POSITIVE)).sqrt()
}

/// Returns body 3-1-3 angles in degrees, without the rounding behind their eleventh digit.
fn degrees(R: Mat3<f64>) -> [f64; 3] {
    to_313(&R).map(|x| {
        let exact = x.to_degrees();
        let short = (exact * 1e9).round() / 1e9;
        match (short - exact).abs() < 1e-11 {
            true => short + 0.0,
            false => exact,
        }
    })
}
