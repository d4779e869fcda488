//! The table of elements: every statement with a number, its keyword, its family and its list in
//! the [`Model`].
//!
//! A row here makes the variant of [`ElementKind`], the list of the model and all lookups by kind;
//! the element's own type, next to its fields, says whom it names and what it computes
//! ([`Element`]). Arguments stand in the table of statements (`dataset/statement.rs`). Nobody else
//! knows keywords: inside the program an element is an [`ElementId`], a text only where it is
//! printed.

use super::{ById, Formula, Model, Place};
use crate::diagnostic::Subject;
use crate::expr::signature;
use std::fmt;
use std::str::FromStr;

/// Hands all rows of the table to the macro `$then`.
///
/// ```text
/// variant  "KEYWORD"  family  list: type of its elements        below what the list holds
/// ```
///
/// The second block holds statements that are read and written, but not solved: their arguments are
/// kept as text.
macro_rules! elements {
    ($then:ident) => {
        $then! {
            solved {
                /// rigid bodies, ground among them
                Part "PART" Body parts: Part;
                /// bodies without extent, which do not turn
                PointMass "POINT_MASS" Body point_masses: Part;
                /// frames fixed in bodies, and floating ones
                Marker "MARKER" Body markers: Marker;
                /// joints between two markers
                Joint "JOINT" Constraint joints: Joint;
                /// single conditions between two markers
                Jprim "JPRIM" Constraint primitives: Primitive;
                /// prescribed displacements, velocities and accelerations
                Motion "MOTION" Constraint motions: Motion;
                /// linear relations between displacements of joints
                Coupler "COUPLER" Constraint couplers: Coupler;
                /// gear pairs
                Gear "GEAR" Constraint gears: Gear;
                /// expressions that stay zero
                Gcon "GCON" Constraint general_constraints: GeneralConstraint;
                /// points that stay on curves
                Ptcv "PTCV" Constraint points_on_curves: PointOnCurve;
                /// curves that touch each other
                Cvcv "CVCV" Constraint curves_on_curves: CurveOnCurve;
                /// forces and torques of one component
                Sforce "SFORCE" Force sforces: SingleForce;
                /// forces of three components
                Vforce "VFORCE" Force vforces: VectorForce;
                /// torques of three components
                Vtorque "VTORQUE" Force vtorques: VectorForce;
                /// forces and torques of six components
                Gforce "GFORCE" Force gforces: VectorForce;
                /// springs with dampers along a line or about an axis
                SpringDamper "SPRINGDAMPER" Force spring_dampers: SpringDamper;
                /// elastic connections with a diagonal law
                Bushing "BUSHING" Force bushings: Bushing;
                /// elastic connections with full matrices
                Field "FIELD" Force fields: Field;
                /// massless beams
                Beam "BEAM" Force beams: Beam;
                /// linear laws between many markers
                Nforce "NFORCE" Force nodal_forces: NodalForce;
                /// contacts between geometries
                Contact "CONTACT" Force contacts: Contact;
                /// friction in joints
                Friction "FRICTION" Force frictions: Friction;
                /// algebraic variables
                Variable "VARIABLE" System variables: Variable;
                /// differential equations of first order
                Diff "DIFF" System differentials: Differential;
                /// linear systems in state space
                Lse "LSE" System linear_systems: LinearSystem;
                /// transfer functions
                Tfsiso "TFSISO" System transfer_functions: TransferFunction;
                /// systems computed by routines
                Gse "GSE" System general_systems: GeneralSystem;
                /// inputs of the plant, for linear models
                Pinput "PINPUT" System plant_inputs: Plant;
                /// outputs of the plant, for linear models
                Poutput "POUTPUT" System plant_outputs: Plant;
                /// expressions that are watched
                Sensor "SENSOR" System sensors: Sensor;
                /// lists of numbers, states, inputs and outputs
                Array "ARRAY" Data arrays: Array;
                /// curves in space or in a plane
                Curve "CURVE" Data curves: Curve;
                /// curves and surfaces through data
                Spline "SPLINE" Data splines: SplineData;
                /// texts
                String "STRING" Data strings: StringData;
                /// matrices of numbers
                Matrix "MATRIX" Data matrices: Matrix;
                /// results that are asked for
                Request "REQUEST" Output requests: Request;
                /// results of many elements at once
                Mrequest "MREQUEST" Output many_requests: ManyRequests;
                /// shapes: drawn, and touched by contacts
                Graphics "GRAPHICS" Output graphics: Graphics;
            }
            kept {
                FlexBody "FLEX_BODY" Body;
                FePart "FE_PART" Body;
                Ucon "UCON" Constraint;
                Ptsf "PTSF" Constraint;
                Cvsf "CVSF" Constraint;
                Sfsf "SFSF" Constraint;
                FeLoad "FE_LOAD" Force;
                Mforce "MFORCE" Force;
                Tire "TIRE" Force;
                Wheel "WHEEL" Force;
                Material "MATERIAL" Data;
                Section "SECTION" Data;
                FeNode "FE_NODE" Data;
                Surface "SURFACE" Data;
                Femdata "FEMDATA" Output;
            }
        }
    };
}
pub(super) use elements;

/// The part that an element plays in the mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Family {
    /// it is a body or a frame in one
    Body,
    /// it ties bodies together
    Constraint,
    /// it pushes
    Force,
    /// it is an equation of the user's, or reads one
    System,
    /// others read it; it does nothing by itself
    Data,
    /// it asks for results or shows shapes
    Output,
}

/// An element of a model: its kind and the number the user gave it. Prints as `BUSHING/3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ElementId {
    /// which statement it is
    pub kind: ElementKind,
    /// its number
    pub number: u32,
}

impl fmt::Display for ElementId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.kind, self.number)
    }
}

impl From<ElementId> for String {
    fn from(element: ElementId) -> Self {
        element.to_string()
    }
}

impl From<ElementId> for Subject {
    fn from(element: ElementId) -> Self {
        element.to_string().into()
    }
}

impl FromStr for ElementId {
    type Err = String;

    /// Reads `JOINT/3`: a full keyword in any case, a slash and a number; or `1-CONTACT1`, the name
    /// that preprocessors give to CONTACT/1 where nobody names it.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is not KEYWORD/number, such as MARKER/41");
        let label = text.trim().split_once('-').and_then(|(number, rest)| {
            let keyword = rest.strip_suffix(number)?;
            let is_number = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
            is_number.then_some((keyword, number))
        });
        let (keyword, number) = text.trim().split_once('/').or(label).ok_or_else(wrong)?;
        let kind: ElementKind = keyword.trim().parse()?;
        Ok(kind.id(number.trim().parse().map_err(|_| wrong())?))
    }
}

impl ElementKind {
    /// Returns the element of this kind with a number.
    pub const fn id(self, number: u32) -> ElementId {
        ElementId { kind: self, number }
    }

    /// Returns all kinds of a family, in the order of the table.
    pub fn of(family: Family) -> impl Iterator<Item = ElementKind> {
        let all = Self::ALL.iter().copied();
        all.filter(move |kind| kind.family() == family)
    }

    /// Returns whether the element takes part in motion but is not solved: a model that holds one
    /// is refused, unless the user leaves it out.
    pub fn is_unsolved(self) -> bool {
        let moves = match self.family() {
            Family::Body | Family::Constraint | Family::Force | Family::System => true,
            Family::Data | Family::Output => false,
        };
        moves && !self.is_solved()
    }
}

impl fmt::Display for ElementKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.keyword())
    }
}

impl FromStr for ElementKind {
    type Err = String;

    /// Reads a full keyword, in any case.
    fn from_str(keyword: &str) -> Result<Self, String> {
        let mut all = Self::ALL.iter().copied();
        let found = all.find(|kind| kind.keyword().eq_ignore_ascii_case(keyword));
        found.ok_or_else(|| format!("`{keyword}` is not a statement with a number"))
    }
}

impl From<signature::Element> for ElementKind {
    /// Returns the kind of element that an argument of an expression names.
    fn from(named: signature::Element) -> Self {
        use signature::Element as E;
        match named {
            E::Marker => Self::Marker,
            E::Beam => Self::Beam,
            E::Bushing => Self::Bushing,
            E::Field => Self::Field,
            E::SpringDamper => Self::SpringDamper,
            E::Sforce => Self::Sforce,
            E::Gforce => Self::Gforce,
            E::Vforce => Self::Vforce,
            E::Vtorque => Self::Vtorque,
            E::Ptcv => Self::Ptcv,
            E::Cvcv => Self::Cvcv,
            E::Joint => Self::Joint,
            E::Jprim => Self::Jprim,
            E::Motion => Self::Motion,
            E::Contact => Self::Contact,
            E::Nforce => Self::Nforce,
            E::Friction => Self::Friction,
            E::Variable => Self::Variable,
            E::Array => Self::Array,
            E::Diff => Self::Diff,
            E::Pinput => Self::Pinput,
            E::Poutput => Self::Poutput,
            E::Sensor => Self::Sensor,
            E::Spline => Self::Spline,
            E::Curve => Self::Curve,
        }
    }
}

/// An argument by which an element names another, and the other.
pub type Named = (&'static str, ElementId);

/// An element as its statement wrote it: where it stands, whom it names, what it computes.
pub trait Element {
    /// Returns where it was written.
    fn place(&self) -> &Place;

    /// Returns the same, to be set.
    fn place_mut(&mut self) -> &mut Place;

    /// Returns the elements it names by number. A number that was not given is 0.
    fn references(&self) -> Vec<Named> {
        Vec::new()
    }

    /// Returns its functions by their arguments.
    fn formulas(&self) -> Vec<(&'static str, &Formula)> {
        Vec::new()
    }

    /// Returns how many equations it stands for; `None` for what is no constraint, or not solved.
    fn equations(&self) -> Option<usize> {
        None
    }

    /// Returns the numbers of the two markers between which it acts, where these must belong to two
    /// bodies.
    fn ends(&self) -> Option<[u32; 2]> {
        None
    }
}

/// The two methods of [`Element`] that are the same for all.
macro_rules! placed {
    () => {
        fn place(&self) -> &Place {
            &self.place
        }
        fn place_mut(&mut self) -> &mut Place {
            &mut self.place
        }
    };
}
pub(super) use placed;

/// Returns references to elements of one kind; absent numbers are left out.
pub(super) fn names<const N: usize>(
    kind: ElementKind,
    of: [(&'static str, impl Into<Option<u32>>); N],
) -> Vec<Named> {
    let given = of.into_iter().map(|(argument, n)| (argument, n.into()));
    let given = given.filter_map(|(argument, n)| Some((argument, kind.id(n?))));
    given.collect()
}

/// Returns references from a list of numbers.
pub(super) fn names_each(kind: ElementKind, argument: &'static str, numbers: &[u32]) -> Vec<Named> {
    numbers.iter().map(|&n| (argument, kind.id(n))).collect()
}

macro_rules! kinds {
    (
        solved { $($(#[$doc:meta])* $kind:ident $keyword:literal $family:ident $list:ident: $type:ident;)* }
        kept { $($kept:ident $kept_keyword:literal $kept_family:ident;)* }
    ) => {
        /// The kinds of elements: one for every statement with a number.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum ElementKind {
            $(#[doc = $keyword] $kind,)*
            $(#[doc = concat!($kept_keyword, ", which is kept as text")] $kept,)*
        }

        impl ElementKind {
            /// All kinds, in the order of the table.
            pub const ALL: &[ElementKind] = &[$(Self::$kind,)* $(Self::$kept,)*];

            /// Returns the keyword of its statement, in capitals.
            pub const fn keyword(self) -> &'static str {
                match self {
                    $(Self::$kind => $keyword,)*
                    $(Self::$kept => $kept_keyword,)*
                }
            }

            /// Returns what it does to the mechanism.
            pub const fn family(self) -> Family {
                match self {
                    $(Self::$kind => Family::$family,)*
                    $(Self::$kept => Family::$kept_family,)*
                }
            }

            /// Returns whether it has a list of its own in the model; the others are kept as text.
            pub const fn is_solved(self) -> bool {
                match self {
                    $(Self::$kind => true,)*
                    $(Self::$kept => false,)*
                }
            }
        }

        impl Model {
            /// Returns the numbers in use for a kind of element, ascending.
            pub fn numbers(&self, kind: ElementKind) -> Vec<u32> {
                match kind {
                    $(ElementKind::$kind => self.$list.keys().copied().collect(),)*
                    $(ElementKind::$kept)|* => {
                        let all = self.others.range(kind.id(0)..=kind.id(u32::MAX));
                        all.map(|(id, _)| id.number).collect()
                    }
                }
            }

            /// Returns an element; `None` when there is none of this kind with this number.
            pub fn element(&self, id: ElementId) -> Option<&dyn Element> {
                match id.kind {
                    $(ElementKind::$kind => found(&self.$list, id.number),)*
                    $(ElementKind::$kept)|* => self.others.get(&id).map(|e| e as &dyn Element),
                }
            }

            /// Returns all elements, in the order of the table and of their numbers.
            pub fn elements(&self) -> Vec<(ElementId, &dyn Element)> {
                let mut all: Vec<(ElementId, &dyn Element)> = Vec::new();
                $(
                    let list = self.$list.iter();
                    all.extend(list.map(|(&n, e)| (ElementKind::$kind.id(n), e as &dyn Element)));
                )*
                all.extend(self.others.iter().map(|(&id, e)| (id, e as &dyn Element)));
                all
            }

            /// Takes an element over as another model has it, where it does.
            pub(crate) fn take_over(&mut self, id: ElementId, from: &Model) {
                match id.kind {
                    $(ElementKind::$kind => {
                        let found = from.$list.get(&id.number);
                        self.$list.extend(found.map(|e| (id.number, e.clone())));
                    })*
                    $(ElementKind::$kept)|* => {
                        self.others.extend(from.others.get(&id).map(|e| (id, e.clone())));
                    }
                }
            }

            /// Removes all elements of a kind.
            pub fn clear(&mut self, kind: ElementKind) {
                match kind {
                    $(ElementKind::$kind => self.$list.clear(),)*
                    $(ElementKind::$kept)|* => self.others.retain(|id, _| id.kind != kind),
                }
            }
        }
    };
}
elements!(kinds);

/// Returns an element of a list.
fn found<T: Element>(list: &ById<T>, number: u32) -> Option<&dyn Element> {
    list.get(&number).map(|e| e as &dyn Element)
}

impl Model {
    /// Returns whether the element exists.
    pub fn has(&self, id: ElementId) -> bool {
        self.element(id).is_some()
    }

    /// Returns an element as messages name it, with the name that its file gives it: "JOINT/47
    /// 'hinge'".
    pub fn called(&self, id: ElementId) -> String {
        let name = self.element(id).and_then(|e| e.place().name.as_deref());
        Subject::from(id).named(name)
    }

    /// Returns whether an element has not been switched off.
    pub fn is_active(&self, id: ElementId) -> bool {
        !self.inactive.contains(&id)
    }

    /// Returns those elements of a list that have not been switched off, with their numbers.
    pub fn active<'m, T>(
        &'m self,
        kind: ElementKind,
        list: &'m ById<T>,
    ) -> impl Iterator<Item = (u32, &'m T)> {
        let on = move |(id, _): &(&u32, &T)| self.is_active(kind.id(**id));
        list.iter().filter(on).map(|(&id, e)| (id, e))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_reads_back_as_it_prints() {
        for &kind in ElementKind::ALL {
            let id = kind.id(17);
            assert_eq!(id.to_string().parse(), Ok(id));
            assert_eq!(id.to_string().to_lowercase().parse(), Ok(id));
        }
        assert!("BUSHING".parse::<ElementId>().is_err());
        assert!("BUSHING/x".parse::<ElementId>().is_err());
        assert!("ROPE/3".parse::<ElementId>().is_err());
    }

    #[test]
    fn kinds_of_a_family_follow_each_other() {
        let solved = ElementKind::ALL.iter().filter(|k| k.is_solved());
        let families: Vec<Family> = solved.map(|k| k.family()).collect();
        assert!(families.is_sorted());
    }
}
