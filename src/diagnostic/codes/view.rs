//! Codes of command files of Adams View.

use super::Code;

/// The codes of command files of Adams View, in the order in which they are read.
pub static VIEW_CODES: &[Code] = &[
    Code {
        name: "view_syntax",
        summary: "a command of Adams View that cannot be taken apart",
        explanation: "\
A command is words, then `name = value`; values of a list are separated by commas. It goes on in the next line where the line ends
in `&`. Texts stand in quotation marks, expressions in parentheses; `if`, `for` and `while` end with `end`.

    marker create  &
       marker_name = .m.rod.tip  &
       location = 0.0, (.m.DV_length / 2), 0.0",
    },
    Code {
        name: "unknown_command",
        summary: "words that begin no command of Adams View",
        explanation: "\
Commands of Adams View may be abbreviated word by word, but not invented.

    motion create ...                 write constraint create motion_generator
    geometry create shape sphere      write geometry create shape ellipsoid, with three equal factors",
    },
    Code {
        name: "view_expression",
        summary: "an expression of Adams View without a value",
        explanation: "\
The name is not that of an object or of a field of one, a function is not known here, or numbers and texts do not go together.
Names begin with a dot and the model; without it they are looked up in the model and in the part that was made last.

    length = (.m.DV_lenght * 2)           did you mean .m.DV_length?
    location = (LOC_RELATIVE_TO({0, 0}, .m.ground.origin))      a location has three numbers",
    },
    Code {
        name: "view_left_out",
        summary: "something of a command file of Adams View that is not read",
        explanation: "\
The command or argument changes nothing here, which is said where it could matter: further files, copies of objects, loops over
objects, arguments that the command does not have. Measures that View computes behind a run (computed, range, angle) are no part
of a dataset either.

    file command read file_name = \"more.cmd\"      put its commands into this file",
    },
    Code {
        name: "view_unsolved",
        summary: "an element of Adams View that is not solved",
        explanation: "\
Tyres, gear pairs and other user-defined elements need libraries of Adams, contacts of what only a file of a CAD program knows
need that file. The rest of the model is read, and `cognate convert` writes it; a run would be one of another model.

    force attributes force_name = .m.tyre_force active = off      solves the model without it",
    },
    Code {
        name: "view_mass",
        summary: "a mass that cannot be had from the shapes of a part",
        explanation: "\
Where a part has a material and no mass, View computes it from the shapes. Shapes of CAD programs, shells, and solids that are cut
from others have none here; the marker at the centre of mass in the file shows where a shape was read otherwise than View does.

    part modify rigid_body mass_properties part_name = .m.rod  &
       mass = 2.5 ixx = 1200 iyy = 1200 izz = 30 center_of_mass_marker = .m.rod.cm",
    },
    Code {
        name: "view_units",
        summary: "numbers of a command file whose unit is not sure",
        explanation: "\
Initial angular velocities are read in the file's unit of angles, as View shows them; files of programs often have radians there
though the file has degrees. Matrices of a FIELD are taken as they stand.

    part modify rigid_body initial_velocity part_name = .m.rotor wz = 72.0      degrees per second",
    },
    Code {
        name: "view_frames",
        summary: "markers that meet in another frame than that in which they are read",
        explanation: "\
Locations without `relative_to` are in the default coordinate system, and where none is set in the part that holds the marker. The
markers of joints do not meet so; they would if their numbers were in ground.

    defaults coordinate_system default_coordinate_system = .m.ground      above the markers",
    },
    Code {
        name: "view_script",
        summary: "the simulation that a command file of Adams View asks for",
        explanation: "\
Without --end a run does what the file asks for: the commands `simulation single_run` at its end, else the script `Last_Sim`, in
which View keeps what ran last, else the last script. That may be an assembly or an equilibrium alone.

    cognate run crank.cmd --end 2 --steps 200      another simulation",
    },
    Code {
        name: "view_no_model",
        summary: "a command file of Adams View that makes no model",
        explanation: "\
Files of dialogs, macros and settings have no `model create`. What they would make when somebody clicks is not made here.

    model create model_name = .crank",
    },
    Code {
        name: "view_is_left",
        summary: "a command file of Adams View is not changed",
        explanation: "\
`fmt`, and `elements` with --rename or --delete, write datasets. A command file is read, and stays as it is.

    cognate convert crank.cmd crank.adm       then change the dataset",
    },
];
