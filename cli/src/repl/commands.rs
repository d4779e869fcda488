//! The commands of the prompt, and what is said of one that is used wrongly.

use cognate::diagnostic::{Diagnostic, near_names};

/// The TABLE of commands: name, arguments, effect.
pub const COMMANDS: [(&str, &str, &str); 24] = [
    (
        ":help",
        "[NAME]",
        "this list, or what a function, statement, code or command is",
    ),
    (":functions", "", "all names of the language"),
    (
        ":statements",
        "[NAME]",
        "the statements of datasets and the commands, or one of them",
    ),
    (
        ":let",
        "[NAME = EXPRESSION | VARVAL(3) = VALUE]",
        "name a part of later expressions, or give a function of the model its value",
    ),
    (":time", "[T]", "set TIME"),
    (
        ":derivative",
        "[0|1|2]",
        "show derivatives over time up to this order",
    ),
    (
        ":marker",
        "[ID X Y Z | ID {\"r\": [x,y,z], \"v\": …}]",
        "place a marker",
    ),
    (":markers", "FILE.json", "read states of markers"),
    (":splines", "FILE.json", "read data of splines"),
    (":curves", "FILE.json", "read points of curves"),
    (
        ":plot",
        "EXPRESSION [FIRST LAST] [FILE]",
        "plot an expression over TIME, or over the run of the model; FILE: .svg, .png or .pdf",
    ),
    (
        ":explain",
        "EXPRESSION [FIRST LAST]",
        "its tree with values, inputs, switches, class, breakpoints and program",
    ),
    (":dialect", "[function|expression]", "change the language"),
    (
        ":load",
        "FILE",
        "read a model (.adm, .acf): expressions then have its values at TIME",
    ),
    (
        ":info",
        "[ELEMENT]",
        "what is loaded, and its last run; or an element, as :show",
    ),
    (
        ":list",
        "[KEYWORD]",
        "its elements with their names, or those of a kind",
    ),
    (
        ":show",
        "ELEMENT",
        "the statement of an element, by JOINT/3 or its name; whom it names and who names it",
    ),
    (
        ":rename",
        "ELEMENT NAME",
        "give an element another name, until :save in memory alone",
    ),
    (
        ":delete",
        "ELEMENT",
        "take out an element that no other names, until :save in memory alone",
    ),
    (":save", "FILE.adm", "write the dataset as it is now"),
    (
        ":verify",
        "",
        "its freedoms, what is fixed twice, what is free",
    ),
    (
        ":run",
        "[END [STEPS]]",
        "solve it: by its commands, or up to END",
    ),
    (":draw", "FILE", "draw it at TIME; FILE: .svg, .png or .pdf"),
    (":quit", "", "end the session"),
];

/// Returns the mistake of a command that is used wrongly, with its form.
pub fn usage(command: &str) -> Diagnostic {
    let row = COMMANDS.iter().find(|c| c.0 == command);
    let form = row.map_or(String::new(), |(name, arguments, _)| {
        format!("{name} {arguments}")
    });
    let form = form.trim_end();
    Diagnostic::error("usage", format!("{command} is used like this: {form}"))
}

/// Returns the mistake of a command that does not exist, with near names.
pub fn unknown_command(name: &str) -> Diagnostic {
    let near = near_names(name, COMMANDS.iter().map(|c| c.0));
    let d = Diagnostic::error("usage", format!("there is no command {name}"));
    if near.is_empty() {
        d.help(":help lists them")
    } else {
        d.help(format!("did you mean {}?", near.join(" or ")))
    }
}
