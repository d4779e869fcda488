//! Maps whose keys are numbers of nodes and guards: a multiplication spreads them, which is all
//! that such keys need. Nobody outside chooses the keys, so nobody can make them collide.

use std::collections;
use std::hash::{BuildHasherDefault, Hasher};

/// A map by small numbers.
pub(in crate::expr::program) type HashMap<K, V> =
    collections::HashMap<K, V, BuildHasherDefault<Spread>>;
/// A set of small numbers.
pub(in crate::expr::program) type HashSet<K> = collections::HashSet<K, BuildHasherDefault<Spread>>;

/// Spreads numbers over 64 bits, one word after the other.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::expr::program) struct Spread(u64);

/// An odd number without pattern: 2⁶⁴ over the golden ratio.
const MULTIPLIER: u64 = 0x9E37_79B9_7F4A_7C15;

impl Hasher for Spread {
    fn finish(&self) -> u64 {
        // tables take their place from the low bits and a check from the high ones
        self.0 ^ self.0 >> 32
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&b| self.write_u64(u64::from(b)));
    }
    fn write_u32(&mut self, word: u32) {
        self.write_u64(u64::from(word));
    }
    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(MULTIPLIER);
    }
    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }
    fn write_isize(&mut self, word: isize) {
        self.write_u64(word as u64);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::hash::BuildHasher;

    #[test]
    fn numbers_in_a_row_are_spread_over_low_and_high_bits() {
        let build = BuildHasherDefault::<Spread>::default();
        for shift in [0, 57] {
            let mut counts = [0; 128];
            for k in 0..12_800_u32 {
                counts[(build.hash_one(k) >> shift) as usize & 127] += 1;
            }
            let most = counts.iter().max().unwrap();
            assert!(*most < 200, "{most} where 100 are expected, shift {shift}");
        }
    }
}
