//! What stiffness does to a contact: the difference from rigid contact, ours against k and rapier's, and what each costs.
//!
//! `cargo bench --bench contact`. Each row is one experiment of `tests/contact_rapier.rs`; the number is the largest difference
//! from the closed form of rigid bodies, relative to the speed or length of the experiment, then the milliseconds of the
//! run. rapier's column is for its step of 1 ms; its error does not depend on a stiffness.

#[path = "../tests/common/contacts.rs"]
mod contacts;

use contacts::*;
use rapier3d_f64::prelude::*;
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

/// Speed with which a ball left the plane, from its energy now.
fn left_with(v: f64, z: f64) -> f64 {
    (v * v + 2.0 * G * (z - R)).max(0.0).sqrt()
}

fn bounce(k: f64) -> f64 {
    let speed = (2.0 * G * H).sqrt();
    let text = ball(2, 1.0, R, [0.0, 0.0, R + H], "")
        + &contact(1, 2, 1, k, damper(0.5, k, 1.0), "")
        + &format!("ACCGRAV/KGRAV=-{G}\n");
    // until the softest has let go
    let end = speed / G + 0.02 + 4.0 / k.sqrt();
    let s = run(&text, &["VZ(2)", "DZ(2)"], end, 1, 1e-8);
    (left_with(last(&s, "VZ(2)"), last(&s, "DZ(2)")) - 0.5 * speed).abs() / speed
}

fn rigid_bounce() -> f64 {
    let speed = (2.0 * G * H).sqrt();
    let mut world = world([0.0, 0.0, -G]);
    ground(&mut world, 0.5, 0.0);
    let body = rigid_ball(&mut world, 1.0, R, [0.0, 0.0, R + H], [0.0; 3], 0.5, 0.0);
    steps(&mut world, speed / G + 0.02);
    let body = &world.bodies[body];
    (left_with(body.linvel().z, body.translation().z) - 0.5 * speed).abs() / speed
}

fn rest(k: f64) -> f64 {
    let text = ball(2, 1.0, R, [0.0, 0.0, R + 0.001], "")
        + &contact(1, 2, 1, k, damper(0.2, k, 1.0), "")
        + &format!("ACCGRAV/KGRAV=-{G}\n");
    (last(&run(&text, &["DZ(2)"], 0.6, 1, 1e-8), "DZ(2)") - R).abs() / R
}

fn rigid_rest() -> f64 {
    let mut world = world([0.0, 0.0, -G]);
    ground(&mut world, 0.0, 0.0);
    let body = rigid_ball(
        &mut world,
        1.0,
        R,
        [0.0, 0.0, R + 0.001],
        [0.0; 3],
        0.0,
        0.0,
    );
    steps(&mut world, 0.6);
    (world.bodies[body].translation().z - R).abs() / R
}

fn head_on(k: f64) -> f64 {
    let text = ball(2, 1.0, R, [-0.2, 0.0, 0.0], ", VX=1")
        + &ball(3, 1.0, R, [0.2, 0.0, 0.0], ", VX=-1")
        + &contact(1, 2, 3, k, damper(0.5, k, 0.5), "");
    let s = run(&text, &["VX(2)", "VX(3)"], 0.5, 1, 1e-8);
    (last(&s, "VX(2)") + 0.5)
        .abs()
        .max((last(&s, "VX(3)") - 0.5).abs())
}

fn rigid_head_on() -> f64 {
    let mut world = world([0.0; 3]);
    let a = rigid_ball(
        &mut world,
        1.0,
        R,
        [-0.2, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        0.5,
        0.0,
    );
    let b = rigid_ball(
        &mut world,
        1.0,
        R,
        [0.2, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        0.5,
        0.0,
    );
    steps(&mut world, 0.5);
    let v = |h: RigidBodyHandle| world.bodies[h].linvel().x;
    (v(a) + 0.5).abs().max((v(b) - 0.5).abs())
}

const OFFSET: f64 = 0.12;

/// Velocities after an oblique impact of a moving ball on one at rest, restitution 0.6.
fn oblique_exact() -> [f64; 4] {
    let n = [
        (4.0 * R * R - OFFSET * OFFSET).sqrt() / (2.0 * R),
        OFFSET / (2.0 * R),
    ];
    let lost = 0.8 * n[0];
    [1.0 - lost * n[0], -lost * n[1], lost * n[0], lost * n[1]]
}

fn worst(found: [f64; 4]) -> f64 {
    found
        .iter()
        .zip(oblique_exact())
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn oblique(k: f64) -> f64 {
    let text = ball(2, 1.0, R, [-0.3, 0.0, 0.0], ", VX=1")
        + &ball(3, 1.0, R, [0.0, OFFSET, 0.0], "")
        + &contact(1, 2, 3, k, damper(0.6, k, 0.5), "");
    let columns = ["VX(2)", "VY(2)", "VX(3)", "VY(3)"];
    let s = run(&text, &columns, 0.5, 1, 1e-8);
    worst(columns.map(|c| last(&s, c)))
}

fn rigid_oblique() -> f64 {
    let mut world = world([0.0; 3]);
    let a = rigid_ball(
        &mut world,
        1.0,
        R,
        [-0.3, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        0.6,
        0.0,
    );
    let b = rigid_ball(&mut world, 1.0, R, [0.0, OFFSET, 0.0], [0.0; 3], 0.6, 0.0);
    steps(&mut world, 0.5);
    let (a, b) = (world.bodies[a].linvel(), world.bodies[b].linvel());
    worst([a.x, a.y, b.x, b.y])
}
