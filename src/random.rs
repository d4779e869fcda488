//! Random numbers: the same ones for the same seed, on every system.

/// A generator of random numbers, begun with a seed: Steele, Lea & Flood, Fast Splittable
/// Pseudorandom Number Generators, OOPSLA 2014 (SplitMix64).
#[derive(Clone, Debug)]
pub(crate) struct Random(pub u64);

/// Distance of the states of neighbours in the sequence: 2⁶⁴ over the golden ratio.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

impl Random {
    /// Returns the next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Returns a number from 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        const LEAST: f64 = 1.0 / (1u64 << 53) as f64;
        (self.bits() >> 11) as f64 * LEAST
    }

    /// Returns a whole number below `n`.
    #[cfg(any(test, feature = "solver"))]
    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    /// Returns the number at a place of the sequence that begins with seed 0, without those before
    /// it.
    #[cfg(feature = "solver")]
    pub fn bits_at(place: u64) -> u64 {
        Self(STEP.wrapping_mul(place)).bits()
    }
}

/// Returns the sign that random bits stand for.
#[cfg(feature = "solver")]
pub(crate) fn sign(bits: u64) -> f64 {
    if bits & 1 == 0 { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_numbers_of_the_publication() {
        // the sequence of seed 1234567, as the generator's authors and its ports print it
        let known: [u64; 5] = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        let mut random = Random(1_234_567);
        assert_eq!(known.map(|_| random.bits()), known);
    }

    #[test]
    fn numbers_stay_within_their_ranges_and_fill_them() {
        let mut random = Random(5);
        let mut counts = [0; 10];
        for _ in 0..10_000 {
            let x = random.unit();
            assert!((0.0..1.0).contains(&x), "{x}");
            counts[random.below(10)] += 1;
        }
        assert!(counts.iter().all(|n| (900..1100).contains(n)), "{counts:?}");
    }

    #[cfg(feature = "solver")]
    #[test]
    fn a_place_of_the_sequence_is_reached_at_once() {
        let mut random = Random(0);
        for place in 0..100 {
            assert_eq!(Random::bits_at(place), random.bits());
        }
    }
}
