//! Mechanisms, links that constraints join, and the groups of these that forces join.

use super::forces::ForceLaw;
use super::{ConstraintElement, RowKind, Scene};
use crate::numeric::connected::{SparseRow, connected};

/// Where a link belongs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Membership {
    /// the size of its mechanism, which rounds its lengths
    pub size: f64,
    /// how far its mechanism reaches from the origin, at least its size: against it lengths in
    /// ground are rounded
    pub reach: f64,
    /// number of the mechanisms that forces join with its own
    pub group: u32,
}

impl Scene {
    /// Returns how many groups of links move that nothing but forces can couple: links with what
    /// carries them, and those that constraints join.
    pub fn n_mechanisms(&self) -> usize {
        connected(&self.joined_by_constraints(), self.links.len()).len()
    }

    /// Finds where each link belongs, once constraints and forces are known   (n_links)
    pub(super) fn find_memberships(&self) -> Vec<Membership> {
        let mut of = vec![Membership::default(); self.links.len()];
        let mut rows = self.joined_by_constraints();
        let blocks = connected(&rows, of.len());
        let mut block_of = vec![0; of.len()];
        for (k, block) in blocks.iter().enumerate() {
            block.columns.iter().for_each(|&l| block_of[l] = k);
        }
        let of_blocks = |links: &mut dyn Iterator<Item = Option<usize>>| {
            let mut all = vec![Vec::new(); blocks.len()];
            let linked = links.enumerate().filter_map(|(k, link)| Some((k, link?)));
            linked.for_each(|(k, link)| all[block_of[link]].push(k));
            all
        };
        let parts = of_blocks(&mut self.parts.iter().map(|part| part.link));
        let markers = of_blocks(&mut self.markers.iter().map(|marker| marker.link));
        let sizes: Vec<[f64; 2]> = (parts.iter().zip(&markers))
            .map(|(parts, markers)| self.size_and_reach(parts, markers))
            .collect();
        (of.iter_mut().zip(block_of)).for_each(|(of, k)| [of.size, of.reach] = sizes[k]);
        rows.extend(self.forces.iter().map(|force| {
            let nodes = match &force.law {
                ForceLaw::Nodal { markers, .. } => &markers[..],
                _ => &[],
            };
            let markers = std::iter::once(force.i)
                .chain(force.j)
                .chain(nodes.iter().copied());
            let links = markers.filter_map(|m| self.markers[m].link);
            row(&mut links.chain(force.reaction.flatten()))
        }));
        for (block, group) in connected(&rows, of.len()).into_iter().zip(0..) {
            block.columns.iter().for_each(|&l| of[l].group = group);
        }
        of
    }

    /// Returns the links that a constraint joins.
    pub(crate) fn joined_by(&self, element: &ConstraintElement) -> SparseRow {
        let pair = element.markers.into_iter().flat_map(|(i, j)| [i, j]);
        let markers = pair.chain(element.acts_on.iter().copied());
        let markers = markers.chain(element.joins.iter().copied());
        row(&mut markers.filter_map(|m| self.markers[m].link))
    }

    /// Returns the links that stand together in a constraint or carry each other.
    pub(crate) fn joined_by_constraints(&self) -> Vec<SparseRow> {
        let links = self.links.iter().enumerate();
        let carried = links.map(|(l, link)| row(&mut [Some(l), link.parent].into_iter().flatten()));
        let constraints = self
            .constraints
            .iter()
            .map(|element| self.joined_by(element));
        let sums = self.rows.iter().filter_map(|r| match &r.kind {
            RowKind::Displacements(sum) => Some(sum),
            _ => None,
        });
        let geared = sums.map(|sum| {
            let markers = sum.terms.iter().flat_map(|(_, d)| [d.i, d.j]);
            row(&mut markers.filter_map(|m| self.markers[m].link))
        });
        carried.chain(constraints).chain(geared).collect()
    }
}

/// Returns the row that joins some links.
fn row(links: &mut dyn Iterator<Item = usize>) -> SparseRow {
    links.map(|l| (l, 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use crate::model::Model;
    use crate::scene::Scene;
    use crate::scene::build::Options;

    #[test]
    fn forces_join_what_constraints_do_not() {
        let model = Model::from_text(
            "t\nPART/1, GROUND\nMARKER/1, PART=1\n\
             PART/2, MASS=1, CM=2, IP=4,4,4\nMARKER/2, PART=2\n\
             PART/3, MASS=1, CM=3, IP=9,9,9\nMARKER/3, PART=3\n\
             PART/4, MASS=1, CM=4, IP=1,1,1, QG=1E9,0,0\nMARKER/4, PART=4\n\
             JOINT/2, TRANSLATIONAL, I=2, J=1\n\
             SPRINGDAMPER/1, TRANSLATION, I=3, J=2, K=1, LENGTH=1\nEND\n",
        )
        .expect("a model");
        let scene = Scene::compile(&model, &Options::default()).expect("a scene");
        let moving = scene.parts.iter().filter_map(|part| part.link);
        let found = moving.map(|link| scene.memberships[link]);
        let found: Vec<_> = found.map(|of| (of.size, of.group)).collect();
        assert_eq!(found, [(2.0, 0), (3.0, 0), (1.0, 1)]);
    }
}
