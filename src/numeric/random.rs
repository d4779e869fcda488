//! Random numbers of the tests of this floor: the same ones for the same seed, without a library.

/// Returns numbers between −1 and 1.
pub(super) fn between_ones(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
