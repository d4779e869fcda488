//! FIELD, BEAM and NFORCE of a model as force elements of the scene.

use super::asker::Asker;
use super::build::Builder;
use super::compile::Compiler;
use super::forces::{ForceElement, ForceLaw};
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::{BeamFormulation, ElementKind};
use crate::physics::beam::Section;
use crate::physics::field::{self, Field};
use crate::physics::nodal_force::NodalForce;
use std::sync::Arc;

/// Damping of a BEAM that says nothing of it, as a part of its stiffness.
const BEAM_DAMPING: f64 = 0.01;

impl Builder<'_> {
    pub(super) fn fields(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (id, f) in model.active(ElementKind::Field, &model.fields) {
            let name = ElementKind::Field.id(id);
            if let Some(user) = &f.function {
                // a closure computes the force and torque on I, in the axes of J
                let all = self.user(c, &Asker::argument(name, "FUNCTION"), user, 6, &[]);
                let formulas = std::array::from_fn(|k| Some(all[k]));
                let rm = c.marker(f.j, name);
                let law = ForceLaw::Vector { rm, formulas };
                self.between(c, name, (f.i, f.j), law);
                continue;
            }
            let Some(stiffness) = field::by_columns(&f.stiffness) else {
                c.error(name, "KMATRIX needs 36 numbers, by columns");
                continue;
            };
            let damping = match (f.damping.as_slice(), f.damping_ratio) {
                ([], ratio) => Some(field::scaled(&stiffness, ratio.unwrap_or(0.0))),
                (numbers, _) => field::by_columns(numbers),
            };
            let Some(damping) = damping else {
                c.error(name, "CMATRIX needs 36 numbers, by columns");
                continue;
            };
            let law = Field {
                stiffness,
                damping,
                free: f.free,
                preload: f.preload,
            };
            let law = ForceLaw::Field(Box::new(law));
            self.between(c, name, (f.i, f.j), law);
        }
    }

    pub(super) fn beams(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (id, b) in model.active(ElementKind::Beam, &model.beams) {
            let name = ElementKind::Beam.id(id);
            let linear = b.formulation == BeamFormulation::Linear;
            if !linear {
                let what = format!(
                    "FORMULATION={} is solved by the linear law: tension does not stiffen it",
                    format!("{:?}", b.formulation).to_uppercase()
                );
                self.scene
                    .warnings
                    .push(Diagnostic::warning(Cause::Approximate, what).element(name));
            }
            let section = Section {
                length: b.length,
                area: b.area,
                second_moments: b.second_moments,
                shear: b.shear,
                youngs_modulus: b.youngs_modulus,
                shear_modulus: b.shear_modulus,
            };
            let stiffness = section.stiffness();
            if !stiffness.iter().flatten().all(|k| k.is_finite()) {
                c.error(name, "its numbers make no stiffness: LENGTH, and with shear also AREA and GMODULUS, must be positive");
                continue;
            }
            let damping = match (b.damping.as_slice(), b.damping_ratio) {
                ([], ratio) => Some(field::scaled(&stiffness, ratio.unwrap_or(BEAM_DAMPING))),
                (numbers, _) => field::by_lower_triangle(numbers),
            };
            let Some(damping) = damping else {
                c.error(name, "CMATRIX needs 21 numbers: the lower triangle by rows");
                continue;
            };
            let law = Field {
                stiffness,
                damping,
                free: [b.length, 0.0, 0.0, 0.0, 0.0, 0.0],
                preload: [0.0; 6],
            };
            let law = ForceLaw::Field(Box::new(law));
            self.between(c, name, (b.i, b.j), law);
        }
    }

    pub(super) fn nodal_forces(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (id, f) in model.active(ElementKind::Nforce, &model.nodal_forces) {
            let name = ElementKind::Nforce.id(id);
            let markers: Vec<usize> = f.i.iter().filter_map(|&i| c.marker(i, name)).collect();
            let Some(j) = c.marker(f.j, name) else {
                continue;
            };
            if markers.len() < f.i.len() {
                continue;
            }
            let n = 6 * markers.len();
            // numbers of a MATRIX of the given size, by rows
            let mut numbers = |what: &str, matrix: u32, columns: usize| {
                let given = model.matrices.get(&matrix);
                let found = given.and_then(|m| {
                    let fits = m.rows == n && m.columns == columns
                        || columns == 1 && m.rows == 1 && m.columns == n;
                    m.by_rows().filter(|_| fits)
                });
                if found.is_none() {
                    let why = match given {
                        None => "does not exist".to_string(),
                        Some(m) if m.unread_file().is_some() => {
                            "stands in a file, which is not read".into()
                        }
                        Some(m) => format!("is {} × {}", m.rows, m.columns),
                    };
                    let matrix = ElementKind::Matrix.id(matrix);
                    c.error(name, format!("{what}: {matrix} {why}, but {n} × {columns} numbers are needed: six for each I marker"));
                }
                found
            };
            let rows = |flat: Vec<f64>| flat.chunks(n.max(1)).map(<[f64]>::to_vec).collect();
            let Some(stiffness) = numbers("KMATRIX", f.stiffness, n) else {
                continue;
            };
            let damping = match (f.damping, f.damping_ratio) {
                (Some(matrix), _) => numbers("CMATRIX", matrix, n),
                (None, Some(ratio)) => Some(stiffness.iter().map(|k| k * ratio).collect()),
                (None, None) => Some(Vec::new()),
            };
            let mut column = |what: &str, matrix: Option<u32>| match matrix {
                Some(matrix) => numbers(what, matrix, 1),
                None => Some(vec![0.0; n]),
            };
            let (free, preload) = (column("LENGTH", f.free), column("FORCE", f.preload));
            let (Some(damping), Some(free), Some(preload)) = (damping, free, preload) else {
                continue;
            };
            let law = Arc::new(NodalForce {
                stiffness: rows(stiffness),
                damping: rows(damping),
                free,
                preload,
            });
            let markers: Arc<[usize]> = markers.into();
            let reaction = Some(self.scene.markers[j].link);
            for (place, &i) in markers.iter().enumerate() {
                self.scene.forces.push(ForceElement {
                    id: name,
                    i,
                    j: Some(j),
                    floating: 0,
                    reaction,
                    law: ForceLaw::Nodal {
                        law: law.clone(),
                        markers: markers.clone(),
                        place,
                    },
                });
            }
        }
    }
}
