//! Units of a command file: what a number with a unit is in those of the file.
//!
//! ```text
//! x(newton-mm/deg)  →  x · Π (unit / unit of the file)^exponent
//! ```
//!
//! Force, mass, length, time and angle are units of their own; `-` between two of them multiplies.

use crate::model::units as names;

/// Factor to SI (radians for angles) and the exponents of length, mass, force, time and angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    factor: f64,
    exponents: [i32; 5],
}

impl Unit {
    const NONE: Unit = Unit {
        factor: 1.0,
        exponents: [0; 5],
    };

    const fn of(kind: usize, factor: f64) -> Unit {
        let mut exponents = [0; 5];
        exponents[kind] = 1;
        Unit { factor, exponents }
    }

    fn times(self, other: Unit, power: i32) -> Unit {
        let mut exponents = self.exponents;
        for (mine, its) in exponents.iter_mut().zip(other.exponents) {
            *mine += its * power;
        }
        let factor = self.factor * other.factor.powi(power);
        Unit { factor, exponents }
    }
}

const LENGTH: usize = 0;
const MASS: usize = 1;
const FORCE: usize = 2;
const TIME: usize = 3;
const ANGLE: usize = 4;

/// A degree in radians.
pub(super) const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Words of Adams View for units, and the names of datasets for the same.
const SPELLINGS: &[(usize, &str, &str)] = &[
    (LENGTH, "mm millimeter", "MILLIMETER"),
    (LENGTH, "cm centimeter", "CENTIMETER"),
    (LENGTH, "m meter", "METER"),
    (LENGTH, "km kilometer", "KILOMETER"),
    (LENGTH, "um micrometer micron", "MICROMETER"),
    (LENGTH, "nm nanometer", "NANOMETER"),
    (LENGTH, "angstrom", "ANGSTROM"),
    (LENGTH, "in inch", "INCH"),
    (LENGTH, "ft foot", "FOOT"),
    (LENGTH, "yard", "YARD"),
    (LENGTH, "mile", "MILE"),
    (LENGTH, "mils mil", "MILS"),
    (LENGTH, "microinch", "MICROINCH"),
    (MASS, "kg kilogram", "KILOGRAM"),
    (MASS, "g gram", "GRAM"),
    (MASS, "mg milligram", "MILLIGRAM"),
    (MASS, "microgram", "MICROGRAM"),
    (MASS, "nanogram", "NANOGRAM"),
    (MASS, "tonne", "TONNE"),
    (MASS, "lbm pound_mass", "POUND_MASS"),
    (MASS, "kpound_mass", "KPOUND_MASS"),
    (MASS, "ounce_mass", "OUNCE_MASS"),
    (MASS, "us_ton", "US_TON"),
    (MASS, "slug", "SLUG"),
    (MASS, "slinch", "SLINCH"),
    (FORCE, "newton n", "NEWTON"),
    (FORCE, "knewton kn kilonewton", "KNEWTON"),
    (FORCE, "meganewton", "MEGANEWTON"),
    (FORCE, "centinewton", "CENTINEWTON"),
    (FORCE, "millinewton", "MILLINEWTON"),
    (FORCE, "micronewton", "MICRONEWTON"),
    (FORCE, "nanonewton", "NANONEWTON"),
    (FORCE, "dyne", "DYNE"),
    (FORCE, "kg_force kgf kilogram_force", "KILOGRAM_FORCE"),
    (FORCE, "pound_force lbf", "POUND_FORCE"),
    (FORCE, "kpound_force", "KPOUND_FORCE"),
    (FORCE, "ounce_force", "OUNCE_FORCE"),
    (FORCE, "poundal", "POUNDAL"),
    (TIME, "sec second s", "SECOND"),
    (TIME, "ms msec millisecond", "MILLISECOND"),
    (TIME, "microsecond", "MICROSECOND"),
    (TIME, "nanosecond", "NANOSECOND"),
    (TIME, "min minute", "MINUTE"),
    (TIME, "hour h", "HOUR"),
    (TIME, "day", "DAY"),
];

/// Returns the kind of a unit and its name in datasets.
fn spelled(word: &str) -> Option<(usize, &'static str)> {
    let is = |known: &&(usize, &str, &'static str)| {
        let mut words = known.1.split(' ');
        words.any(|w| w.eq_ignore_ascii_case(word)) || known.2.eq_ignore_ascii_case(word)
    };
    SPELLINGS.iter().find(is).map(|known| (known.0, known.2))
}

fn to_si(kind: usize, name: &str) -> Option<f64> {
    match kind {
        LENGTH => names::length(name),
        MASS => names::mass(name),
        FORCE => names::force(name),
        TIME => names::time(name),
        _ => None,
    }
}

/// Returns the unit that a word stands for; `None` for other words.
pub(super) fn unit(word: &str) -> Option<Unit> {
    if let Some((kind, name)) = spelled(word) {
        return Some(Unit::of(kind, to_si(kind, name)?));
    }
    let area = Unit::of(LENGTH, 1.0).times(Unit::of(LENGTH, 1.0), 1);
    let newton = Unit::of(FORCE, 1.0);
    let scaled = |unit: Unit, factor| Unit { factor, ..unit };
    Some(match word.to_ascii_lowercase().as_str() {
        "d" | "deg" | "degree" | "degrees" => Unit::of(ANGLE, DEGREE),
        "r" | "rad" | "radian" | "radians" => Unit::of(ANGLE, 1.0),
        "rev" | "revolution" | "revolutions" => Unit::of(ANGLE, 360.0 * DEGREE),
        "hz" | "hertz" => Unit::NONE.times(Unit::of(TIME, 1.0), -1),
        "rpm" => Unit::of(ANGLE, 360.0 * DEGREE).times(Unit::of(TIME, 60.0), -1),
        "pascal" | "pa" => newton.times(area, -1),
        "mpa" | "megapascal" => scaled(newton.times(area, -1), 1e6),
        "joule" => newton.times(Unit::of(LENGTH, 1.0), 1),
        "watt" => newton
            .times(Unit::of(LENGTH, 1.0), 1)
            .times(Unit::of(TIME, 1.0), -1),
        "no_units" | "none" => Unit::NONE,
        _ => return None,
    })
}

/// Returns the unit of several words, `kg / meter ** 3`, `newton - mm / deg`.
pub(super) fn compound<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<Unit> {
    let mut all = Unit::NONE;
    let mut sign = 1;
    let mut word = words.next()?;
    loop {
        let one = match word {
            "1" => Unit::NONE,
            word => unit(word)?,
        };
        let mut power = sign;
        let mut mark = words.next();
        if matches!(mark, Some("**" | "^")) {
            power *= words.next()?.parse::<i32>().ok().filter(|n| *n <= 9)?;
            mark = words.next();
        }
        all = all.times(one, power);
        sign = match mark {
            None => return Some(all),
            Some("*" | "-") => 1,
            Some("/") => -1,
            Some(_) => return None,
        };
        word = words.next()?;
    }
}

/// The units of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Units {
    /// names in datasets of length, mass, force and time
    names: [&'static str; 4],
    /// factors to SI and to radians
    si: [f64; 5],
}

impl Default for Units {
    fn default() -> Self {
        Self {
            names: ["MILLIMETER", "KILOGRAM", "NEWTON", "SECOND"],
            si: [1e-3, 1.0, 1.0, 1.0, DEGREE],
        }
    }
}

impl Units {
    /// Sets the unit of a kind of quantity; returns false for a word that is none.
    pub fn set(&mut self, kind: &str, word: &str) -> bool {
        let place = match kind {
            "length" => LENGTH,
            "mass" => MASS,
            "force" => FORCE,
            "time" => TIME,
            _ => {
                let found = unit(word).filter(|u| u.exponents == Unit::of(ANGLE, 1.0).exponents);
                self.si[ANGLE] = found.map_or(self.si[ANGLE], |u| u.factor);
                return found.is_some();
            }
        };
        let Some((kind, name)) = spelled(word).filter(|(kind, _)| *kind == place) else {
            return false;
        };
        self.names[kind] = name;
        self.si[kind] = to_si(kind, name).unwrap_or(1.0);
        true
    }

    /// Returns the value of one unit in those of the file.
    pub fn factor(&self, unit: Unit) -> f64 {
        // a quotient of decimal powers has one rounding where factors have two
        let own = unit.exponents.iter().zip(self.si);
        let of_file = own.fold(1.0, |all, (n, si)| all * si.powi(*n));
        unit.factor / of_file
    }

    /// Returns the unit of angles in radians.
    pub fn angle(&self) -> f64 {
        self.si[ANGLE]
    }

    /// Returns whether angles are degrees.
    pub fn in_degrees(&self) -> bool {
        self.si[ANGLE] == DEGREE
    }

    /// Returns the names in datasets of length, mass, force and time.
    pub fn names(&self) -> [&'static str; 4] {
        self.names
    }

    /// Returns a density in kg/m³ in the units of the file.
    pub fn density(&self, si: f64) -> f64 {
        si * self.si[LENGTH].powi(3) / self.si[MASS]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_units_are_in_those_of_the_file() {
        let mut file = Units::default();
        let value = |file: &Units, words: &str| compound(words.split(' ')).map(|u| file.factor(u));
        assert_eq!(value(&file, "cm"), Some(10.0));
        assert!((value(&file, "kg / meter ** 3").unwrap() * 7801.0 - 7.801e-6).abs() < 1e-18);
        assert!((value(&file, "newton - m / rad").unwrap() - 1000.0 * DEGREE).abs() < 1e-12);
        assert!((value(&file, "newton - mm / deg").unwrap() - 1.0).abs() < 1e-15);
        assert!(file.set("length", "inch") && !file.set("length", "kg"));
        assert!(file.set("angle", "rad") && file.set("mass", "pound_mass"));
        assert!((value(&file, "d").unwrap() - DEGREE).abs() < 1e-17);
        assert!((file.density(7801.0) - 0.281_829_3).abs() < 1e-6);
        assert_eq!(value(&file, "x"), None);
    }
}
