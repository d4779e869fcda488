//! Units as result files spell them.

/// The units of a model as result files spell them.
#[derive(Clone, Debug, PartialEq)]
pub struct Units {
    /// `rad` or `deg`
    pub angle: String,
    /// `meter`, `mm` …
    pub length: String,
    /// `kg`, `pound_mass` …
    pub mass: String,
    /// `sec`, `millisec` …
    pub time: String,
    /// `newton`, `pound_force` …
    pub force: String,
}

impl Default for Units {
    /// Returns meter, kg, sec, newton and rad.
    fn default() -> Self {
        let [angle, length, mass, time, force] =
            ["rad", "meter", "kg", "sec", "newton"].map(String::from);
        Self {
            angle,
            length,
            mass,
            time,
            force,
        }
    }
}

/// Returns the unit of an element's component as result files spell it.
///
/// The name of the component tells the quantity: `X` is a length, `VX` a length per time, `PSI` an
/// angle, `FX` a force, `TX` a torque. All others are pure numbers.
pub fn component_unit(component: &str, units: &Units) -> String {
    let Units {
        angle,
        length,
        time,
        force,
        ..
    } = units;
    match component {
        "TIME" => time.clone(),
        "X" | "Y" | "Z" | "DX" | "DY" | "DZ" | "DM" => length.clone(),
        "PSI" | "THETA" | "PHI" | "YAW" | "PITCH" | "ROLL" => angle.clone(),
        "VX" | "VY" | "VZ" | "VM" => format!("{length}/{time}"),
        "WX" | "WY" | "WZ" | "WM" => format!("{angle}/{time}"),
        "ACCX" | "ACCY" | "ACCZ" | "ACCM" => format!("{length}/{time}**2"),
        "WDX" | "WDY" | "WDZ" | "WDTX" | "WDTY" | "WDTZ" | "WDTM" => format!("{angle}/{time}**2"),
        "FX" | "FY" | "FZ" | "FM" => force.clone(),
        "TX" | "TY" | "TZ" | "TM" => format!("{force}-{length}"),
        _ => String::new(),
    }
}
