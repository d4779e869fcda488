//! Modes as a person reads them: a table, its words, and a drawing of each shape.

use super::table::Table;
use cognate::analysis::linear::{Linearization, Mode};
use cognate::diagnostic::counted;
use cognate::results::digits_of_six;

/// Most modes whose shapes are drawn.
const DRAWN: usize = 8;
/// Half the length of a bar, in characters.
const BAR: usize = 12;
/// Smallest component that is drawn, as a part of the largest of its mode.
const LEAST: f64 = 0.01;

/// Prints the modes about a state; `time`: name of the unit of time.
pub fn text(found: &Linearization, time: &str, width: usize) -> String {
    let at = digits_of_six(found.time);
    if found.modes.is_empty() {
        return format!("at time {at} nothing is free to vibrate\n");
    }
    let [per_time, rate, turns] = units(time);
    let mut table = Table::new([
        "mode",
        "frequency",
        "damping",
        "real",
        "imaginary",
        "what it does",
    ]);
    table.head(
        ["", &per_time, "ratio", &rate, &turns, ""]
            .map(str::to_owned)
            .to_vec(),
    );
    for (k, mode) in found.modes.iter().enumerate() {
        let numbers = [mode.frequency(), mode.damping_ratio(), mode.re, mode.im].map(digits_of_six);
        let [frequency, damping, re, im] = numbers;
        table.push([
            (k + 1).to_string(),
            frequency,
            damping,
            re,
            im,
            behaviour(mode, time),
        ]);
    }
    let mut text = format!("modes at time {at}\n{}", table.text(width));
    text += "frequency: |eigenvalue|/(2 PI); damping ratio: 0 is undamped, 1 no longer swings, below 0 it grows\nshapes: a bar for the real part of each motion, then its size and its phase\n";
    for (k, mode) in found.modes.iter().enumerate().take(DRAWN) {
        text += &shape(k + 1, mode, &per_time);
    }
    if found.modes.len() > DRAWN {
        text += &format!(
            "\nshapes of {}: --json prints all\n",
            counted(found.modes.len() - DRAWN, "more mode")
        );
    }
    text
}

/// Returns the units of frequencies, of real and of imaginary parts.
fn units(time: &str) -> [String; 3] {
    match time {
        "" | "sec" => ["Hz", "1/s", "rad/s"].map(str::to_owned),
        _ => ["1/", "1/", "rad/"].map(|unit| format!("{unit}{time}")),
    }
}

/// Returns the behaviour of a mode in words.
fn behaviour(mode: &Mode, time: &str) -> String {
    /// Damping ratio below which a vibration counts as undamped.
    const UNDAMPED: f64 = 1e-9;
    let unit = if time.is_empty() {
        String::new()
    } else {
        format!(" {time}")
    };
    let constant = || format!("{}{unit}", digits_of_six(1.0 / mode.re.abs()));
    match (mode.im != 0.0, mode.damping_ratio()) {
        (true, d) if d.abs() < UNDAMPED => "vibrates".into(),
        (true, d) if d > 0.0 => format!("vibrates, falls to 1/e in {}", constant()),
        (true, _) => format!("vibrates, grows by e in {}", constant()),
        (false, _) if mode.re == 0.0 => "moves freely".into(),
        (false, d) if d > 0.0 => format!("falls to 1/e in {}", constant()),
        (false, _) => format!("grows by e in {}", constant()),
    }
}

/// Draws the shape of a mode: a bar for each motion that is not small.
fn shape(number: usize, mode: &Mode, per_time: &str) -> String {
    let all = motions(mode);
    let largest = all.iter().map(|m| size(m.1)).fold(0.0, f64::max);
    let drawn: Vec<_> = all.iter().filter(|m| size(m.1) > LEAST * largest).collect();
    if drawn.is_empty() {
        return String::new();
    }
    let width = drawn.iter().map(|m| m.0.chars().count()).max().unwrap_or(0);
    let mut text = format!(
        "\nmode {number}, {} {per_time}\n",
        digits_of_six(mode.frequency())
    );
    for (name, value) in drawn {
        let phase = value[1].atan2(value[0]).to_degrees();
        text += &format!(
            "  {name:width$}  {}  {:>8.3}  {:>5.0} deg\n",
            bar(value[0] / largest),
            size(*value),
            if phase.abs() < 0.5 { 0.0 } else { phase }
        );
    }
    text
}

fn size(value: [f64; 2]) -> f64 {
    value[0].hypot(value[1])
}

/// Returns the motions of a mode with their names: those of parts, else those of states.
fn motions(mode: &Mode) -> Vec<(String, [f64; 2])> {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let mut all = Vec::new();
    for part in &mode.parts {
        for (axis, value) in AXES.into_iter().zip(part.translation) {
            all.push((format!("{} along {axis}", part.part), value));
        }
        for (axis, value) in AXES.into_iter().zip(part.rotation) {
            all.push((format!("{} about {axis}", part.part), value));
        }
    }
    if all.iter().all(|m| size(m.1) == 0.0) {
        all = mode.states.clone();
    }
    all
}

/// Draws a number between −1 and 1 as a bar to the left or right of a line.
fn bar(x: f64) -> String {
    let n = (x.abs().min(1.0) * BAR as f64).round() as usize;
    let (full, none) = ("█".repeat(n), " ".repeat(BAR - n));
    let (left, right) = if x < 0.0 {
        (none + &full, " ".repeat(BAR))
    } else {
        (" ".repeat(BAR), full + &none)
    };
    format!("{left}│{right}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_goes_to_the_side_of_its_sign() {
        assert_eq!(
            bar(-0.5),
            format!("{}██████│{}", " ".repeat(6), " ".repeat(12))
        );
        assert_eq!(bar(2.0), format!("{}│████████████", " ".repeat(12)));
    }

    #[test]
    fn behaviour_is_said_in_words() {
        let mode = |re, im| Mode {
            re,
            im,
            parts: Vec::new(),
            states: Vec::new(),
        };
        assert_eq!(behaviour(&mode(0.0, 2.0), "sec"), "vibrates");
        assert_eq!(
            behaviour(&mode(-0.5, 2.0), "sec"),
            "vibrates, falls to 1/e in 2 sec"
        );
        assert_eq!(behaviour(&mode(4.0, 0.0), "sec"), "grows by e in 0.25 sec");
        assert_eq!(behaviour(&mode(0.0, 0.0), "sec"), "moves freely");
    }
}
