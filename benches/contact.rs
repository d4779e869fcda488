//! What stiffness does to a contact: the difference from rigid contact, ours against k and rapier's, and what each costs.
//!
//! `cargo bench --bench contact`. Each row is one experiment of `tests/forces/contact_rapier.rs`; the number is the largest difference
//! from the closed form of rigid bodies, relative to the speed or length of the experiment, then the milliseconds of the
//! run. rapier's column is for its step of 1 ms; its error does not depend on a stiffness.

#[path = "../tests/common/contacts.rs"]
mod contacts;
#[path = "../tests/common/running.rs"]
mod running;

use contacts::*;
use std::time::Instant;

/// One experiment: a name, our difference at a stiffness, rapier's.
type Experiment = (&'static str, fn(f64) -> f64, fn() -> f64);

fn main() {
    let experiments: [Experiment; 4] = [
        ("drop, restitution 0.5: speed after", bounce, rigid_bounce),
        ("rest on a plane: height", rest, rigid_rest),
        (
            "head-on, restitution 0.5: speeds after",
            head_on,
            rigid_head_on,
        ),
        (
            "oblique, restitution 0.6: speeds after",
            oblique,
            rigid_oblique,
        ),
    ];
    print!("{:42}", "difference from rigid contact (ms)");
    let stiffnesses = [1e4, 1e5, 1e6, 1e7, 1e8];
    for k in stiffnesses {
        print!("{:>20}", format!("k = {k:.0e}"));
    }
    println!("{:>20}", "rapier");
    for (name, ours, theirs) in experiments {
        print!("{name:42}");
        for k in stiffnesses {
            let begin = Instant::now();
            let d = ours(k);
            print!(
                "{:>20}",
                format!("{d:.1e} ({:.1})", begin.elapsed().as_secs_f64() * 1e3)
            );
        }
        let begin = Instant::now();
        let d = theirs();
        println!(
            "{:>20}",
            format!("{d:.1e} ({:.1})", begin.elapsed().as_secs_f64() * 1e3)
        );
    }
}

const R: f64 = 0.1;
const H: f64 = 0.2;

fn bounce(k: f64) -> f64 {
    let speed = (2.0 * G * H).sqrt();
    // until the softest has let go
    let end = speed / G + 0.02 + 4.0 / k.sqrt();
    let s = run(
        &falling_ball(R, H, k, 0.5),
        &["VZ(2)", "DZ(2)"],
        end,
        1,
        1e-8,
    );
    let left = left_with([last(&s, "VZ(2)"), last(&s, "DZ(2)") - R]);
    (left - 0.5 * speed).abs() / speed
}

fn rigid_bounce() -> f64 {
    let speed = (2.0 * G * H).sqrt();
    let left = left_with(rigid_falling_ball(R, H, 0.5, speed / G + 0.02));
    (left - 0.5 * speed).abs() / speed
}

fn rest(k: f64) -> f64 {
    let text = falling_ball(R, 0.001, k, 0.2);
    (last(&run(&text, &["DZ(2)"], 0.6, 1, 1e-8), "DZ(2)") - R).abs() / R
}

fn rigid_rest() -> f64 {
    rigid_falling_ball(R, 0.001, 0.0, 0.6)[1].abs() / R
}

const HEAD_ON: Meeting = Meeting {
    r: R,
    from: -0.2,
    to: [0.2, 0.0],
    masses: [1.0; 2],
    speeds: [1.0, -1.0],
    e: 0.5,
};

fn worst(found: [f64; 4], exact: [f64; 4]) -> f64 {
    let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs());
    off.fold(0.0, f64::max)
}

fn head_on(k: f64) -> f64 {
    worst(HEAD_ON.ours(k, 1e-8), [-0.5, 0.0, 0.5, 0.0])
}

fn rigid_head_on() -> f64 {
    worst(HEAD_ON.rigid(), [-0.5, 0.0, 0.5, 0.0])
}

fn oblique(k: f64) -> f64 {
    worst(contacts::oblique().ours(k, 1e-8), oblique_exact())
}

fn rigid_oblique() -> f64 {
    worst(contacts::oblique().rigid(), oblique_exact())
}
