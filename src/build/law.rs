//! Closures of numbers as laws: typed by how many numbers they are given and how many they return.

use super::{Element, ModelBuilder, Setting};
use crate::analysis::system::closures::{Call, Hook};
use crate::diagnostic::{Diagnostic, counted};
use crate::model::ElementKind;
use std::sync::Arc;

/// Results of a closure: a number, or as many as an array holds.
pub trait Results {
    /// how many
    const COUNT: usize;
    /// Puts the numbers where the equations read them.
    fn put(self, out: &mut [f64]);
}

impl Results for f64 {
    const COUNT: usize = 1;
    fn put(self, out: &mut [f64]) {
        [self].put(out);
    }
}

impl<const N: usize> Results for [f64; N] {
    const COUNT: usize = N;
    fn put(self, out: &mut [f64]) {
        for (out, x) in out.iter_mut().zip(self) {
            *out = x;
        }
    }
}

/// Numbers that FUNCTION = USER of an element yields, and their meaning; `None` for elements whose
/// routines do other things.
fn yields(kind: ElementKind) -> Option<(usize, &'static str)> {
    Some(match kind {
        ElementKind::Sforce => (1, "the force or torque"),
        ElementKind::Variable => (1, "its value"),
        ElementKind::Diff => (1, "its rate, or its residual"),
        ElementKind::Sensor => (1, "the value that is watched"),
        ElementKind::Vforce => (3, "FX, FY, FZ"),
        ElementKind::Vtorque => (3, "TX, TY, TZ"),
        ElementKind::Gforce => (6, "FX, FY, FZ, TX, TY, TZ"),
        ElementKind::Motion => (3, "the value and its first two derivatives in time"),
        ElementKind::Request => (8, "its components"),
        _ => return None,
    })
}

impl<Kind> Element<'_, Kind> {
    /// Gives FUNCTION as a closure: of the time, and of the values of expressions, in their order.
    ///
    /// It returns the numbers that the element needs: one for SFORCE, VARIABLE, DIFF and SENSOR; an
    /// array of three for VFORCE and VTORQUE, six for GFORCE, eight for REQUEST; for MOTION the
    /// value and its first two derivatives in time. It must be a function of what it is given, for
    /// it is called as often as a method needs it; its derivatives are found by differences. In a
    /// written dataset it is USER().
    ///
    /// ```
    /// use cognate::ModelBuilder;
    /// let model = ModelBuilder::new("a mass on a spring");
    /// let ground = model.ground();
    /// let mass = model.part("mass").mass(1.0).inertia([1.0; 3]).center([0.0; 3]);
    /// let (i, j) = (mass.at([0.0; 3]), ground.at([0.0, 0.0, -1.0]));
    /// let spring = model.force("spring", &i, &j);
    /// spring.law([format!("DM({i},{j})"), format!("VR({i},{j})")], |_time, [length, rate]| {
    ///     -100.0 * (length - 1.0) - 0.5 * rate
    /// });
    /// assert!(model.build()?.to_text().contains("FUNCTION = USER()"));
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn law<const N: usize, R: Results>(
        self,
        inputs: [impl Into<String>; N],
        law: impl Fn(f64, [f64; N]) -> R + Send + Sync + 'static,
    ) -> Self {
        let element = self.set("FUNCTION", Setting::User(Vec::new()));
        let inputs = inputs.map(Into::into).to_vec();
        element
            .model
            .hook(element.draft, R::COUNT, inputs, move |call, out| {
                let mut values = [0.0; N];
                values
                    .iter_mut()
                    .zip(call.values)
                    .for_each(|(to, x)| *to = *x);
                law(call.time, values).put(out);
            });
        element
    }
}

impl ModelBuilder {
    /// Registers the closure of a draft, which returns `count` numbers.
    fn hook(
        &self,
        draft: usize,
        count: usize,
        inputs: Vec<String>,
        law: impl Fn(&Call<'_>, &mut [f64]) + Send + Sync + 'static,
    ) {
        let mut inner = self.inner.borrow_mut();
        let Some(id) = inner.drafts[draft].element() else {
            return;
        };
        match yields(id.kind) {
            Some((n, _)) if n == count => inner.hooks.push(Hook {
                name: id.to_string(),
                inputs,
                law: Arc::new(law),
            }),
            Some((n, meaning)) => {
                let what = format!(
                    "its closure returns {}; it needs {n}: {meaning}",
                    counted(count, "number")
                );
                inner.drafts[draft].refuse(Diagnostic::error("wrong_count", what));
            }
            None => {
                let what = format!("a closure of numbers cannot stand for a {}", id.kind);
                let said = Diagnostic::error("user_routine", what);
                let said = said.help("give it FUNCTION = USER(…) and Session::register");
                inner.drafts[draft].refuse(said);
            }
        }
    }
}
