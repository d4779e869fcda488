//! Units: every name a UNITS statement may hold, its factor to SI, and the factor that makes them
//! consistent.
//!
//! ```text
//! Force · UCF = Mass · Acceleration        all in model units
//! UCF = (1 force unit in N) · (1 time unit in s)² / ((1 mass unit in kg) · (1 length unit in m))
//! ```

/// Pounds to kilograms, exactly.
const POUND: f64 = 0.453_592_37;
/// Standard gravity [m/s²], exactly.
const G: f64 = 9.806_65;
/// Inches to metres, exactly.
const INCH: f64 = 0.0254;

macro_rules! table {
    ($(#[$doc:meta])* $names:ident, $factor:ident: $($name:literal = $value:expr),+ $(,)?) => {
        $(#[$doc])*
        pub const $names: &[&str] = &[$($name),+];
        /// Factor to SI of a unit of that list; `None` when it is not there.
        pub fn $factor(name: &str) -> Option<f64> {
            match name {
                $($name => Some($value),)+
                _ => None,
            }
        }
    };
}

table!(
    /// Units of force.
    FORCES, force:
    "NEWTON" = 1.0, "KNEWTON" = 1e3, "MEGANEWTON" = 1e6, "CENTINEWTON" = 1e-2, "MILLINEWTON" = 1e-3,
    "MICRONEWTON" = 1e-6, "NANONEWTON" = 1e-9, "DYNE" = 1e-5, "KILOGRAM_FORCE" = G, "POUND_FORCE" = POUND * G,
    "KPOUND_FORCE" = 1e3 * POUND * G, "OUNCE_FORCE" = POUND * G / 16.0, "POUNDAL" = POUND * 12.0 * INCH,
);

table!(
    /// Units of mass.
    MASSES, mass:
    "KILOGRAM" = 1.0, "GRAM" = 1e-3, "MILLIGRAM" = 1e-6, "MICROGRAM" = 1e-9, "NANOGRAM" = 1e-12, "TONNE" = 1e3,
    "POUND_MASS" = POUND, "KPOUND_MASS" = 1e3 * POUND, "OUNCE_MASS" = POUND / 16.0, "US_TON" = 2000.0 * POUND,
    "SLUG" = POUND * G / (12.0 * INCH), "SLINCH" = POUND * G / INCH,
);

table!(
    /// Units of length.
    LENGTHS, length:
    "METER" = 1.0, "KILOMETER" = 1e3, "CENTIMETER" = 1e-2, "MILLIMETER" = 1e-3, "MICROMETER" = 1e-6,
    "NANOMETER" = 1e-9, "ANGSTROM" = 1e-10, "INCH" = INCH, "FOOT" = 12.0 * INCH, "YARD" = 36.0 * INCH,
    "MILE" = 63360.0 * INCH, "MILS" = 1e-3 * INCH, "MICROINCH" = 1e-6 * INCH,
);

table!(
    /// Units of time.
    TIMES, time:
    "SECOND" = 1.0, "MILLISECOND" = 1e-3, "MICROSECOND" = 1e-6, "NANOSECOND" = 1e-9, "MINUTE" = 60.0,
    "HOUR" = 3600.0, "DAY" = 86400.0,
);

/// Systems of units.
pub const SYSTEMS: &[&str] = &["MKS", "CGS", "FPS", "IPS", "NONE", "MMKS"];

/// Force, mass, length and time of a system; `None` for NONE, which has UCF 1 and no units.
pub fn system(name: &str) -> Option<[&'static str; 4]> {
    match name {
        "MKS" => Some(["NEWTON", "KILOGRAM", "METER", "SECOND"]),
        // the preset of Adams View
        "MMKS" => Some(["NEWTON", "KILOGRAM", "MILLIMETER", "SECOND"]),
        "CGS" => Some(["DYNE", "GRAM", "CENTIMETER", "SECOND"]),
        "FPS" => Some(["POUND_FORCE", "POUND_MASS", "FOOT", "SECOND"]),
        "IPS" => Some(["POUND_FORCE", "POUND_MASS", "INCH", "SECOND"]),
        _ => None,
    }
}

/// The units consistency factor of four units; 1 where one of them is unknown.
pub fn consistency(force: &str, mass: &str, length: &str, time: &str) -> f64 {
    let factor = || {
        let t = self::time(time)?;
        Some(self::force(force)? * t * t / (self::mass(mass)? * self::length(length)?))
    };
    // 1000 rather than 999.9999999999999 for millimetres: the nearest number of 14 digits, where
    // that is one.
    factor().map_or(1.0, |f| format!("{f:.13e}").parse().unwrap_or(f))
}

impl super::Units {
    /// Four units and the factor that goes with them.
    pub fn new(force: &str, mass: &str, length: &str, time: &str) -> Self {
        Self {
            force: force.into(),
            mass: mass.into(),
            length: length.into(),
            time: time.into(),
            ucf: consistency(force, mass, length, time),
        }
    }

    /// Factors to SI of force, mass, length and time; 1 for a unit that is not known.
    pub fn to_si(&self) -> [f64; 4] {
        [
            force(&self.force).unwrap_or(1.0),
            mass(&self.mass).unwrap_or(1.0),
            length(&self.length).unwrap_or(1.0),
            time(&self.time).unwrap_or(1.0),
        ]
    }
}
