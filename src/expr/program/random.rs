//! Random numbers for tests: the same ones on every run.

/// Random numbers by a linear congruence, from a seed.
pub(super) struct Random(pub u64);

impl Random {
    /// Returns the next one below `n`.
    pub(super) fn below(&mut self, n: usize) -> usize {
        self.0 = (self.0)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}
