//! Handles of statements: copies are cheap, and give the same statement its arguments.

use super::{ModelBuilder, Setting};
use crate::model::ElementKind;
use std::fmt;
use std::marker::PhantomData;

/// A PART or POINT_MASS; see [`Element`].
#[derive(Clone, Copy, Debug)]
pub struct Body;
/// A MARKER; see [`Element`].
#[derive(Clone, Copy, Debug)]
pub struct Frame;
/// Any other statement; see [`Element`].
#[derive(Clone, Copy, Debug)]
pub struct Other;

/// A statement of a model that is being built.
///
/// Prints as its number, so that expressions can name it.
pub struct Element<'m, Kind = Other> {
    pub(super) model: &'m ModelBuilder,
    /// place among the drafts
    pub(super) draft: usize,
    kind: PhantomData<Kind>,
}

/// A statement of a builder, as handles of other languages keep it: without the lifetime of the
/// builder, and checked where it is used ([`ModelBuilder::statement`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// number of the builder
    model: u64,
    /// place among its drafts
    draft: usize,
}

impl ModelBuilder {
    /// Returns the statement of a key; `None`: the key is of another builder.
    pub fn statement(&self, key: Key) -> Option<Element<'_>> {
        (key.model == self.id).then(|| Element::new(self, key.draft))
    }

    /// Returns the body of a key; `None`: it is another statement.
    pub fn body(&self, key: Key) -> Option<Element<'_, Body>> {
        let kind = self.statement(key)?.kind()?;
        let is_body = matches!(kind, ElementKind::Part | ElementKind::PointMass);
        is_body.then(|| Element::new(self, key.draft))
    }

    /// Returns the marker of a key; `None`: it is another statement.
    pub fn frame(&self, key: Key) -> Option<Element<'_, Frame>> {
        let is_marker = self.statement(key)?.kind()? == ElementKind::Marker;
        is_marker.then(|| Element::new(self, key.draft))
    }
}

impl<Kind> Clone for Element<'_, Kind> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Kind> Copy for Element<'_, Kind> {}

impl<'m, Kind> Element<'m, Kind> {
    pub(super) fn new(model: &'m ModelBuilder, draft: usize) -> Self {
        Self {
            model,
            draft,
            kind: PhantomData,
        }
    }

    /// Gives an argument of the statement its value, by its keyword (or an abbreviation that means
    /// only it): `set("K", 100.0)`, `set("I", &marker)`, `set("TYPE", "T:R")`.
    ///
    /// `cognate statements NAME` tells the arguments, units and defaults. A keyword that the
    /// statement does not have, and a value that does not fit, are told by
    /// [`build`](ModelBuilder::build).
    pub fn set(self, keyword: &str, value: impl Into<Setting>) -> Self {
        self.model.give(self.draft, keyword, value.into());
        self
    }

    /// Gives an argument that stands alone: `flag("ROTATIONAL")`.
    pub fn flag(self, keyword: &str) -> Self {
        self.set(keyword, Setting::Flag)
    }

    /// Gives FUNCTION as an expression of the function language; handles print as their numbers:
    /// `function(&format!("-25*DM({a},{b})"))`.
    pub fn function(self, expression: &str) -> Self {
        self.set("FUNCTION", expression)
    }

    /// Returns the number that stands for it in expressions and datasets; 0 of settings.
    pub fn number(&self) -> u32 {
        self.model.inner.borrow().drafts[self.draft].id.unwrap_or(0)
    }

    /// Returns what stands for it in handles of other languages.
    pub fn key(&self) -> Key {
        let (model, draft) = (self.model.id, self.draft);
        Key { model, draft }
    }

    /// Returns its name; empty: it has none.
    pub fn name(&self) -> String {
        let inner = self.model.inner.borrow();
        inner.drafts[self.draft].name.clone().unwrap_or_default()
    }

    /// Returns the kind of element; `None` of settings.
    pub fn kind(&self) -> Option<ElementKind> {
        self.model.inner.borrow().drafts[self.draft].row.kind()
    }
}

impl<Kind> fmt::Display for Element<'_, Kind> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.number(), f)
    }
}

impl<Kind> fmt::Debug for Element<'_, Kind> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind() {
            Some(kind) => write!(f, "{} '{}'", kind.id(self.number()), self.name()),
            None => f.write_str("settings"),
        }
    }
}

impl<'m> Element<'m, Body> {
    /// Sets the mass.
    pub fn mass(self, mass: f64) -> Self {
        self.set("MASS", mass)
    }

    /// Sets moments of inertia about the centre of mass, along ground axes as the model is drawn:
    /// Ixx, Iyy, Izz, or these and the positive products ∫xy, ∫xz, ∫yz dm.
    pub fn inertia<const N: usize>(self, moments: [f64; N]) -> Self {
        self.set("IP", moments)
    }

    /// Puts the centre of mass at a place in ground.
    pub fn center(self, place: [f64; 3]) -> Self {
        let marker = self.at(place);
        self.set("CM", &marker)
    }

    /// Puts the part's own frame at a place in ground; without it, it is that of ground. Places
    /// that are given in ground stay where they are.
    pub fn origin(self, place: [f64; 3]) -> Self {
        self.set("QG", place)
    }

    /// Makes a marker fixed in the body at a place in ground, with the axes of ground unless
    /// [`z`](Element::z) or [`axes`](Element::axes) turn them.
    pub fn at(self, place: [f64; 3]) -> Element<'m, Frame> {
        self.model.marker_at(self.draft, place)
    }
}

impl Element<'_, Frame> {
    /// Names the marker.
    pub fn named(self, name: &str) -> Self {
        let mut inner = self.model.inner.borrow_mut();
        inner.drafts[self.draft].name = Some(name.to_string());
        drop(inner);
        self
    }

    /// Turns the marker so that its z axis has a direction in ground: the axis of a revolute or
    /// translational joint.
    pub fn z(self, direction: [f64; 3]) -> Self {
        self.model.turn(self.draft, direction, None);
        self
    }

    /// Turns the marker: the direction of its z axis in ground, and one in the half plane of its
    /// positive x axis.
    pub fn axes(self, z: [f64; 3], x: [f64; 3]) -> Self {
        self.model.turn(self.draft, z, Some(x));
        self
    }
}
