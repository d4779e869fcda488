//! The models of the manual: small ones that run as they stand, each with its commands.

/// A model that shows statements in use.
#[derive(Debug)]
pub struct Example {
    /// its name, which its commands use
    pub name: &'static str,
    /// one sentence
    pub about: &'static str,
    /// text of the dataset, `NAME.adm`
    pub dataset: &'static str,
    /// text of the command file, `NAME.acf`
    pub commands: &'static str,
    /// further arguments of `cognate run`
    pub options: &'static [&'static str],
}

macro_rules! examples {
    ($($name:literal $about:literal $options:expr;)*) => {
        static EXAMPLES: &[Example] = &[$(Example {
            name: $name,
            about: $about,
            dataset: include_str!(concat!("models/", $name, ".adm")),
            commands: include_str!(concat!("models/", $name, ".acf")),
            options: $options,
        }),*];
    };
}

examples! {
    "slider_crank" "A motor turns a crank, a rod pushes a slider; then the motor is taken away." &[];
    "cam" "A cam lifts a knife-edge follower against a spring." &[];
    "cam_and_tappet" "An eccentric disc lifts a flat tappet: curve on curve." &[];
    "contact" "A ball drops on a table, a box slides on it." &[];
    "suspension" "A quarter car drives over a bump." &[];
    "gears" "Spur gears, a coupler, a rack and a screw." &[];
    "primitives" "A bead on a wire, a rod of constant length." &[];
    "loads" "Forces and torques by their components, a point mass, many requests." &[];
    "beams" "A cantilever by BEAM, FIELD and NFORCE." &[];
    "sledge" "Friction in a joint, a sensor, and commands that save and reload." &[];
    "control" "A controller, a filter, a linear system, plant inputs and outputs." &[];
    "routine" "A system by routines of the user's, taken as zero." &["--zero-user"];
    "settings" "Settings of methods, statics and assembly." &[];
}

/// Returns all models.
pub fn examples() -> &'static [Example] {
    EXAMPLES
}

/// Returns the model of that name.
pub fn example(name: &str) -> Option<&'static Example> {
    EXAMPLES.iter().find(|e| e.name == name)
}
