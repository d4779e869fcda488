//! Who names whom: every number by which one element refers to another, and every FUNCTION, with its owner.

use super::{ArrayKind, CurveSide, Driven, Formula, MarkerOwner, Model, Place, RequestKind, Shape};
use crate::expr::signature;

/// A kind of element that others refer to by number.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[rustfmt::skip]
pub enum Target {
    Part, PointMass, Marker, Joint, Curve, Matrix, Array, Variable, Graphics,
    /// what an expression can name besides
    Named(signature::Element),
}

/// One element names another.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference<'a> {
    /// statement of the one that names
    pub keyword: &'static str,
    /// its number
    pub id: u32,
    /// where it stands
    pub place: &'a Place,
    /// the argument
    pub argument: &'static str,
    /// what is named
    pub target: Target,
    /// by which number
    pub number: u32,
}

/// A FUNCTION and its owner.
#[derive(Clone, Debug)]
pub struct Owned<'a> {
    /// statement
    pub keyword: &'static str,
    /// its number
    pub id: u32,
    /// where it stands
    pub place: &'a Place,
    /// the argument
    pub argument: &'static str,
    /// the function
    pub formula: &'a Formula,
}

impl Target {
    /// The statement that makes one.
    pub fn keyword(self) -> &'static str {
        use signature::Element as E;
        match self {
            Target::Part => "PART",
            Target::PointMass => "POINT_MASS",
            Target::Marker | Target::Named(E::Marker) => "MARKER",
            Target::Joint | Target::Named(E::Joint) => "JOINT",
            Target::Curve | Target::Named(E::Curve) => "CURVE",
            Target::Matrix => "MATRIX",
            Target::Array | Target::Named(E::Array) => "ARRAY",
            Target::Variable | Target::Named(E::Variable) => "VARIABLE",
            Target::Graphics => "GRAPHICS",
            Target::Named(E::Beam) => "BEAM",
            Target::Named(E::Bushing) => "BUSHING",
            Target::Named(E::Field) => "FIELD",
            Target::Named(E::SpringDamper) => "SPRINGDAMPER",
            Target::Named(E::Sforce) => "SFORCE",
            Target::Named(E::Gforce) => "GFORCE",
            Target::Named(E::Vforce) => "VFORCE",
            Target::Named(E::Vtorque) => "VTORQUE",
            Target::Named(E::Ptcv) => "PTCV",
            Target::Named(E::Cvcv) => "CVCV",
            Target::Named(E::Jprim) => "JPRIM",
            Target::Named(E::Motion) => "MOTION",
            Target::Named(E::Contact) => "CONTACT",
            Target::Named(E::Nforce) => "NFORCE",
            Target::Named(E::Friction) => "FRICTION",
            Target::Named(E::Diff) => "DIFF",
            Target::Named(E::Pinput) => "PINPUT",
            Target::Named(E::Poutput) => "POUTPUT",
            Target::Named(E::Sensor) => "SENSOR",
            Target::Named(E::Spline) => "SPLINE",
        }
    }
}

impl Model {
    /// The numbers in use for a kind of element, ascending.
    pub fn numbers(&self, target: Target) -> Vec<u32> {
        use signature::Element as E;
        macro_rules! keys {
            ($list:ident) => {
                self.$list.keys().copied().collect()
            };
        }
        match target {
            Target::Part => keys!(parts),
            Target::PointMass => keys!(point_masses),
            Target::Marker | Target::Named(E::Marker) => keys!(markers),
            Target::Joint | Target::Named(E::Joint) => keys!(joints),
            Target::Curve | Target::Named(E::Curve) => keys!(curves),
            Target::Matrix => keys!(matrices),
            Target::Array | Target::Named(E::Array) => keys!(arrays),
            Target::Variable | Target::Named(E::Variable) => keys!(variables),
            Target::Graphics => keys!(graphics),
            Target::Named(E::Beam) => keys!(beams),
            Target::Named(E::Bushing) => keys!(bushings),
            Target::Named(E::Field) => keys!(fields),
            Target::Named(E::SpringDamper) => keys!(spring_dampers),
            Target::Named(E::Sforce) => keys!(sforces),
            Target::Named(E::Gforce) => keys!(gforces),
            Target::Named(E::Vforce) => keys!(vforces),
            Target::Named(E::Vtorque) => keys!(vtorques),
            Target::Named(E::Ptcv) => keys!(points_on_curves),
            Target::Named(E::Cvcv) => keys!(curves_on_curves),
            Target::Named(E::Jprim) => keys!(primitives),
            Target::Named(E::Motion) => keys!(motions),
            Target::Named(E::Contact) => keys!(contacts),
            Target::Named(E::Nforce) => keys!(nodal_forces),
            Target::Named(E::Friction) => keys!(frictions),
            Target::Named(E::Diff) => keys!(differentials),
            Target::Named(E::Pinput) => keys!(plant_inputs),
            Target::Named(E::Poutput) => keys!(plant_outputs),
            Target::Named(E::Sensor) => keys!(sensors),
            Target::Named(E::Spline) => keys!(splines),
        }
    }

    /// Whether an element of this kind has this number.
    pub fn has(&self, target: Target, id: u32) -> bool {
        match target {
            Target::Marker | Target::Named(signature::Element::Marker) => {
                self.markers.contains_key(&id)
            }
            Target::Part => self.parts.contains_key(&id),
            _ => self.numbers(target).binary_search(&id).is_ok(),
        }
    }

    /// Every reference from one element to another. Numbers that were not given (0) are left out.
    pub fn references(&self) -> Vec<Reference<'_>> {
        let mut all = References(Vec::new());
        self.references_of_bodies(&mut all);
        self.references_of_constraints(&mut all);
        self.references_of_forces(&mut all);
        self.references_of_systems(&mut all);
        self.references_of_output(&mut all);
        all.0
    }

    fn references_of_bodies<'a>(&'a self, all: &mut References<'a>) {
        for (keyword, list) in [("PART", &self.parts), ("POINT_MASS", &self.point_masses)] {
            for (&id, p) in list {
                let markers = [("CM", p.cm), ("IM", p.im), ("VM", p.vm), ("WM", p.wm)];
                all.optional(keyword, id, &p.place, Target::Marker, markers);
            }
        }
        for (&id, m) in &self.markers {
            match m.owner {
                MarkerOwner::Part(n) => all.one("MARKER", id, &m.place, "PART", Target::Part, n),
                MarkerOwner::PointMass(n) => {
                    all.one("MARKER", id, &m.place, "POINT_MASS", Target::PointMass, n)
                }
                MarkerOwner::Other(_) => {}
            }
        }
    }

    fn references_of_constraints<'a>(&'a self, all: &mut References<'a>) {
        const M: Target = Target::Marker;
        for (&id, j) in &self.joints {
            all.some("JOINT", id, &j.place, M, [("I", j.i), ("J", j.j)]);
        }
        for (&id, j) in &self.primitives {
            all.some("JPRIM", id, &j.place, M, [("I", j.i), ("J", j.j)]);
        }
        for (&id, m) in &self.motions {
            match m.driven {
                Driven::Joint(n) | Driven::JointRotation(n) | Driven::JointTranslation(n) => {
                    all.one("MOTION", id, &m.place, "JOINT", Target::Joint, n);
                }
                Driven::Markers { i, j, .. } => {
                    all.some("MOTION", id, &m.place, M, [("I", i), ("J", j)])
                }
            }
        }
        for (&id, c) in &self.couplers {
            all.each("COUPLER", id, &c.place, "JOINTS", Target::Joint, &c.joints);
        }
        for (&id, g) in &self.gears {
            all.each("GEAR", id, &g.place, "JOINTS", Target::Joint, &g.joints);
            all.one("GEAR", id, &g.place, "CV", M, g.cv);
        }
        for (&id, g) in &self.general_constraints {
            all.optional("GCON", id, &g.place, M, [("I", g.i)]);
        }
        for (&id, c) in &self.curves {
            all.optional(
                "CURVE",
                id,
                &c.place,
                Target::Matrix,
                [("MATRIX", c.matrix)],
            );
        }
        for (&id, p) in &self.points_on_curves {
            all.one("PTCV", id, &p.place, "CURVE", Target::Curve, p.curve);
            all.some("PTCV", id, &p.place, M, [("I", p.i), ("RM", p.rm)]);
            all.optional(
                "PTCV",
                id,
                &p.place,
                M,
                [("JFLOAT", p.jfloat), ("ICM", p.start_marker)],
            );
        }
        for (&id, c) in &self.curves_on_curves {
            let mut side = |s: &CurveSide, [curve, rm, float, icm]: [&'static str; 4]| {
                all.one("CVCV", id, &c.place, curve, Target::Curve, s.curve);
                all.one("CVCV", id, &c.place, rm, M, s.rm);
                all.optional(
                    "CVCV",
                    id,
                    &c.place,
                    M,
                    [(float, s.float), (icm, s.start_marker)],
                );
            };
            side(&c.i, ["ICURVE", "IRM", "IFLOAT", "IICM"]);
            side(&c.j, ["JCURVE", "JRM", "JFLOAT", "JICM"]);
        }
    }

    fn references_of_forces<'a>(&'a self, all: &mut References<'a>) {
        const M: Target = Target::Marker;
        macro_rules! i_and_j {
            ($keyword:literal, $list:ident) => {
                for (&id, f) in &self.$list {
                    all.some($keyword, id, &f.place, M, [("I", f.i), ("J", f.j)]);
                }
            };
        }
        i_and_j!("SFORCE", sforces);
        i_and_j!("SPRINGDAMPER", spring_dampers);
        i_and_j!("BUSHING", bushings);
        i_and_j!("FIELD", fields);
        i_and_j!("BEAM", beams);
        for (keyword, list) in [
            ("VFORCE", &self.vforces),
            ("VTORQUE", &self.vtorques),
            ("GFORCE", &self.gforces),
        ] {
            for (&id, f) in list {
                all.one(keyword, id, &f.place, "I", M, f.i);
                all.optional(
                    keyword,
                    id,
                    &f.place,
                    M,
                    [("JFLOAT", f.jfloat), ("RM", f.rm)],
                );
            }
        }
        for (&id, f) in &self.nodal_forces {
            all.each("NFORCE", id, &f.place, "IMARKERS", M, &f.i);
            all.one("NFORCE", id, &f.place, "J", M, f.j);
            all.one(
                "NFORCE",
                id,
                &f.place,
                "KMATRIX",
                Target::Matrix,
                f.stiffness,
            );
            let matrices = [
                ("LENGTH", f.free),
                ("FORCE", f.preload),
                ("CMATRIX", f.damping),
            ];
            all.optional("NFORCE", id, &f.place, Target::Matrix, matrices);
        }
        for (&id, c) in &self.contacts {
            all.each(
                "CONTACT",
                id,
                &c.place,
                "IGEOM",
                Target::Graphics,
                &c.i_geometry,
            );
            all.each(
                "CONTACT",
                id,
                &c.place,
                "JGEOM",
                Target::Graphics,
                &c.j_geometry,
            );
        }
        for (&id, f) in &self.frictions {
            all.one("FRICTION", id, &f.place, "JOINT", Target::Joint, f.joint);
        }
    }

    fn references_of_systems<'a>(&'a self, all: &mut References<'a>) {
        const A: Target = Target::Array;
        for (&id, a) in &self.arrays {
            if let ArrayKind::Inputs(variables) = &a.kind {
                all.each(
                    "ARRAY",
                    id,
                    &a.place,
                    "VARIABLES",
                    Target::Variable,
                    variables,
                );
            }
        }
        for (&id, s) in &self.linear_systems {
            all.one("LSE", id, &s.place, "X", A, s.x);
            all.optional(
                "LSE",
                id,
                &s.place,
                A,
                [("U", s.u), ("Y", s.y), ("IC", s.ic)],
            );
            all.one("LSE", id, &s.place, "A", Target::Matrix, s.a);
            all.optional(
                "LSE",
                id,
                &s.place,
                Target::Matrix,
                [("B", s.b), ("C", s.c), ("D", s.d)],
            );
        }
        for (&id, s) in &self.general_systems {
            let arrays = [
                ("X", s.x),
                ("U", s.u),
                ("Y", s.y),
                ("IC", s.ic),
                ("XD", s.xd),
                ("ICD", s.icd),
            ];
            all.optional("GSE", id, &s.place, A, arrays);
        }
        for (&id, s) in &self.transfer_functions {
            all.some(
                "TFSISO",
                id,
                &s.place,
                A,
                [("X", s.x), ("U", s.u), ("Y", s.y)],
            );
        }
        for (keyword, list) in [
            ("PINPUT", &self.plant_inputs),
            ("POUTPUT", &self.plant_outputs),
        ] {
            for (&id, p) in list {
                all.each(
                    keyword,
                    id,
                    &p.place,
                    "VARIABLES",
                    Target::Variable,
                    &p.variables,
                );
            }
        }
    }

    fn references_of_output<'a>(&'a self, all: &mut References<'a>) {
        const M: Target = Target::Marker;
        for (&id, r) in &self.requests {
            match r.kind {
                RequestKind::Displacement { i, j, rm }
                | RequestKind::Velocity { i, j, rm }
                | RequestKind::Acceleration { i, j, rm }
                | RequestKind::Force { i, j, rm } => {
                    all.one("REQUEST", id, &r.place, "I", M, i);
                    all.optional("REQUEST", id, &r.place, M, [("J", j), ("RM", rm)]);
                }
                RequestKind::Functions(_) | RequestKind::User(_) => {}
            }
        }
        for (&id, r) in &self.many_requests {
            all.optional("MREQUEST", id, &r.place, M, [("RM", r.rm)]);
        }
        for (&id, g) in &self.graphics {
            let (name, marker) = match g.shape {
                Shape::Box { corner, .. } => ("CORNER", corner),
                Shape::Cylinder { cm, .. }
                | Shape::Frustum { cm, .. }
                | Shape::Ellipsoid { cm, .. }
                | Shape::Torus { cm, .. }
                | Shape::Circle { cm, .. }
                | Shape::Arc { cm, .. } => ("CM", cm),
                Shape::Plane { rm, .. }
                | Shape::Point { rm }
                | Shape::External { rm, .. }
                | Shape::Shell { rm, .. } => ("RM", rm),
                Shape::Curve { curve, rm } => {
                    all.one("GRAPHICS", id, &g.place, "CID", Target::Curve, curve);
                    ("CRM", rm)
                }
                Shape::Other(_) | Shape::Nothing => continue,
            };
            all.one("GRAPHICS", id, &g.place, name, M, marker);
        }
    }

    /// Every FUNCTION of the model with its owner.
    pub fn formulas(&self) -> Vec<Owned<'_>> {
        let mut all = Vec::new();
        let mut add = |keyword, id, place, argument, formula| {
            all.push(Owned {
                keyword,
                id,
                place,
                argument,
                formula,
            });
        };
        macro_rules! required {
            ($keyword:literal, $list:ident) => {
                for (&id, e) in &self.$list {
                    add($keyword, id, &e.place, "FUNCTION", &e.function);
                }
            };
        }
        macro_rules! optional {
            ($keyword:literal, $list:ident, $field:ident, $argument:literal) => {
                for (&id, e) in &self.$list {
                    if let Some(f) = &e.$field {
                        add($keyword, id, &e.place, $argument, f);
                    }
                }
            };
        }
        required!("MOTION", motions);
        optional!("COUPLER", couplers, user, "FUNCTION");
        required!("GCON", general_constraints);
        optional!("CURVE", curves, function, "FUNCTION");
        required!("SFORCE", sforces);
        for (keyword, list) in [
            ("VFORCE", &self.vforces),
            ("VTORQUE", &self.vtorques),
            ("GFORCE", &self.gforces),
        ] {
            for (&id, f) in list {
                let names = ["FX", "FY", "FZ", "TX", "TY", "TZ"];
                for (name, formula) in names.into_iter().zip(f.force.iter().chain(&f.torque)) {
                    if let Some(formula) = formula {
                        add(keyword, id, &f.place, name, formula);
                    }
                }
                if let Some(formula) = &f.user {
                    add(keyword, id, &f.place, "FUNCTION", formula);
                }
            }
        }
        optional!("FIELD", fields, function, "FUNCTION");
        optional!("CONTACT", contacts, function, "FUNCTION");
        required!("VARIABLE", variables);
        required!("DIFF", differentials);
        optional!("GSE", general_systems, function, "FUNCTION");
        optional!("GSE", general_systems, sample_period, "SAMPLE_PERIOD");
        required!("SENSOR", sensors);
        optional!("SENSOR", sensors, evaluate, "EVALUATE");
        for (&id, r) in &self.requests {
            match &r.kind {
                RequestKind::Functions(f) => {
                    let names = ["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8"];
                    for (name, formula) in names.into_iter().zip(f.iter()) {
                        if let Some(formula) = formula {
                            add("REQUEST", id, &r.place, name, formula);
                        }
                    }
                }
                RequestKind::User(f) => add("REQUEST", id, &r.place, "FUNCTION", f),
                RequestKind::Displacement { .. }
                | RequestKind::Velocity { .. }
                | RequestKind::Acceleration { .. }
                | RequestKind::Force { .. } => {}
            }
        }
        all
    }

    /// The part or point mass a marker is fixed in, as (is a point mass, number); `None` for owners that are not solved.
    pub fn body_of(&self, marker: u32) -> Option<(bool, u32)> {
        match self.markers.get(&marker)?.owner {
            MarkerOwner::Part(n) => Some((false, n)),
            MarkerOwner::PointMass(n) => Some((true, n)),
            MarkerOwner::Other(_) => None,
        }
    }
}

/// Collects references.
struct References<'a>(Vec<Reference<'a>>);

impl<'a> References<'a> {
    fn one(
        &mut self,
        keyword: &'static str,
        id: u32,
        place: &'a Place,
        argument: &'static str,
        target: Target,
        number: u32,
    ) {
        if number != 0 {
            self.0.push(Reference {
                keyword,
                id,
                place,
                argument,
                target,
                number,
            });
        }
    }
    fn some<const N: usize>(
        &mut self,
        keyword: &'static str,
        id: u32,
        place: &'a Place,
        target: Target,
        of: [(&'static str, u32); N],
    ) {
        for (argument, number) in of {
            self.one(keyword, id, place, argument, target, number);
        }
    }
    fn optional<const N: usize>(
        &mut self,
        keyword: &'static str,
        id: u32,
        place: &'a Place,
        target: Target,
        of: [(&'static str, Option<u32>); N],
    ) {
        self.some(
            keyword,
            id,
            place,
            target,
            of.map(|(a, n)| (a, n.unwrap_or(0))),
        );
    }
    fn each(
        &mut self,
        keyword: &'static str,
        id: u32,
        place: &'a Place,
        argument: &'static str,
        target: Target,
        of: &[u32],
    ) {
        for &number in of {
            self.one(keyword, id, place, argument, target, number);
        }
    }
}
