//! Contacts as they stiffen, against rigid contact: closed forms, and rapier (rapier3d-f64), an engine of velocities and impulses.
//!
//! Our contacts are springs and dampers. As their stiffness grows what follows from an impact must approach what rigid bodies
//! do. Closed forms are the judges: both engines are held to them, each with the tolerance of its own method (ours the
//! stiffness, rapier's its fixed step). Where the two differ the comment says which is right, and why.

use crate::contacts;

use contacts::*;
use rapier3d_f64::prelude::*;

/// Differences that shrink as the stiffness grows by factors of 100, at least by `factor` each.
fn shrink(differences: &[f64], factor: f64) {
    for pair in differences.windows(2) {
        assert!(
            pair[1] < pair[0] / factor || pair[1] < 1e-8,
            "{differences:?}"
        );
    }
}

const STIFFNESSES: [f64; 3] = [1e4, 1e6, 1e8];

#[test]
fn a_dropped_sphere_touches_when_free_fall_says() {
    let (r, h) = (0.1, 1.0);
    let touch = (2.0 * h / G).sqrt();
    let speed = G * touch;
    let k = 1e6;
    let text = ball(2, 1.0, r, [0.0, 0.0, r + h], "")
        + &contact(1, 2, 1, k, 0.0, "")
        + &format!("ACCGRAV/KGRAV=-{G}\n");
    let after = 1e-5;
    let before = run(&text, &["CONTACT(1,0,4,0)"], touch - 1e-9, 1, 1e-8);
    assert_eq!(last(&before, "CONTACT(1,0,4,0)"), 0.0);
    let s = run(&text, &["CONTACT(1,0,4,0)"], touch + after, 1, 1e-8);
    // k v Δt to first order in Δt ω: the touch is known to a hundredth of 10 µs
    assert!((last(&s, "CONTACT(1,0,4,0)") / (k * speed * after) - 1.0).abs() < 0.01);

    let mut world = world([0.0, 0.0, -G]);
    ground(&mut world, 0.0, 0.0);
    let body = rigid_ball(&mut world, 1.0, r, [0.0, 0.0, r + h], [0.0; 3], 0.0, 0.0);
    let mut t = 0.0;
    while world.bodies[body].linvel().z > -1e-3 - 0.9 * speed {
        world.step();
        t += DT;
    }
    while world.bodies[body].linvel().z < -0.5 * speed && t < 1.0 {
        world.step();
        t += DT;
    }
    // rapier knows it to its step, and touches a little early: contacts act within a prediction distance
    assert!((t - touch).abs() < 5.0 * DT, "{t} {touch}");
}

#[test]
fn a_sphere_bounces_with_the_restitution_that_its_damper_gives() {
    let (r, h) = (0.1, 0.2);
    let speed = (2.0 * G * h).sqrt();
    for e in [0.02, 0.2, 0.5, 0.9, 1.0] {
        let expected = e * speed;
        // the speed a while after the impact, corrected for the fall since
        let end = speed / G + if e < 0.1 { 0.004 } else { 0.02 };
        let differences: Vec<f64> = STIFFNESSES
            .iter()
            .map(|&k| {
                let text = falling_ball(r, h, k, e);
                let s = run(&text, &["VZ(2)", "DZ(2)"], end, 10, 1e-9);
                // energy above the plane tells the speed it left with
                (left_with([last(&s, "VZ(2)"), last(&s, "DZ(2)") - r]) - expected).abs()
            })
            .collect();
        if e > 0.1 {
            // what gravity does during the impact is of the order g √(m/k)
            shrink(&differences, 5.0);
        }
        // a strong damper lets go while it is still compressed by 2ζ v/ω₀, which the sphere then has to climb
        let limit = if e < 0.1 { 5e-3 } else { 2e-3 };
        assert!(differences[2] < limit * speed, "{e}: {differences:?}");

        let theirs = left_with(rigid_falling_ball(r, h, e, end));
        // a step's worth of gravity and of penetration
        assert!(
            (theirs - expected).abs() < 0.05 * speed,
            "{e}: {theirs} {expected}"
        );
    }
}

#[test]
fn a_sphere_comes_to_rest_where_its_weight_presses_it() {
    let r = 0.1;
    let differences: Vec<f64> = STIFFNESSES
        .iter()
        .map(|&k| {
            let text = falling_ball(r, 0.001, k, 0.2);
            let z = last(&run(&text, &["DZ(2)"], 0.6, 1, 1e-9), "DZ(2)");
            assert!((z - (r - G / k)).abs() < 1e-8, "{k}: {z}");
            (z - r).abs()
        })
        .collect();
    shrink(&differences, 99.0);
    let [_, height] = rigid_falling_ball(r, 0.001, 0.0, 2.0);
    // rapier leaves up to a millimetre (its allowed linear error)
    assert!(height.abs() < 2e-3);
}

#[test]
fn two_spheres_meet_head_on_as_momentum_and_restitution_say() {
    let (m1, m2) = (1.0, 2.0);
    let (u1, u2) = (1.0, -0.5);
    for e in [0.3, 1.0] {
        let mean = (m1 * u1 + m2 * u2) / (m1 + m2);
        let exact = [
            mean - m2 / (m1 + m2) * e * (u1 - u2),
            mean + m1 / (m1 + m2) * e * (u1 - u2),
        ];
        let pair = Meeting {
            r: 0.1,
            from: -0.2,
            to: [0.2, 0.0],
            masses: [m1, m2],
            speeds: [u1, u2],
            e,
        };
        // without gravity the stiffness only says how long it takes
        for k in STIFFNESSES {
            let found = pair.ours(k, 1e-9);
            assert!(
                (found[0] - exact[0]).abs() < 1e-6 && (found[2] - exact[1]).abs() < 1e-6,
                "{k}: {found:?}"
            );
        }
        let theirs = pair.rigid();
        assert!((theirs[0] - exact[0]).abs() < 1e-3 && (theirs[2] - exact[1]).abs() < 1e-3);
    }
}

#[test]
fn two_spheres_meet_obliquely_along_the_line_of_their_centres() {
    let (pair, exact) = (oblique(), oblique_exact());
    let differences: Vec<f64> = STIFFNESSES
        .iter()
        .map(|&k| {
            let found = pair.ours(k, 1e-9);
            assert!((found[0] + found[2] - 1.0).abs() < 1e-9 && (found[1] + found[3]).abs() < 1e-9);
            let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs());
            off.fold(0.0, f64::max)
        })
        .collect();
    // the line turns while they are in touch, for a time that goes with 1/√k
    shrink(&differences, 5.0);
    // π √(m/2k) at speed 1 on a circle of radius 0.2 turns by 1e-3
    assert!(differences[2] < 1e-3, "{differences:?}");
    // rapier differs by 0.036, as if it acted at a distance of the centres of 0.214 instead of 0.2; the closed form is right
    for (theirs, exact) in pair.rigid().iter().zip(exact) {
        assert!((theirs - exact).abs() < 0.05, "{theirs} {exact}");
    }
}

#[test]
fn the_last_of_five_spheres_leaves_with_the_speed_of_the_first() {
    let (r, gap) = (0.1, 1e-3);
    let place = |n: usize| 2.0 * r * n as f64 + gap * n as f64 + if n == 0 { -0.1 } else { 0.0 };
    let columns = ["VX(2)", "VX(3)", "VX(4)", "VX(5)", "VX(6)"];
    let exact = [0.0, 0.0, 0.0, 0.0, 1.0];
    for k in STIFFNESSES {
        let mut text = String::new();
        for n in 0..5 {
            let more = if n == 0 { ", VX=1" } else { "" };
            text += &ball(n as u32 + 2, 1.0, r, [place(n), 0.0, 0.0], more);
        }
        for n in 2..6 {
            text += &contact(n, n, n + 1, k, 0.0, "");
        }
        let s = run(&text, &columns, 0.3, 1, 1e-10);
        // the softest ones overlap by 5 mm, more than the gaps: impacts are not one after another
        let found = columns.map(|c| last(&s, c));
        let sum: f64 = found.iter().sum();
        let squares: f64 = found.iter().map(|v| v * v).sum();
        assert!(
            (sum - 1.0).abs() < 1e-8 && (squares - 1.0).abs() < 1e-6,
            "{found:?}"
        );
        let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max);
        if k >= 1e6 {
            // at 1e6 a sphere still touches the one behind when it meets the next, at 1e8 impacts are one after another, each an
            // exchange of speeds
            assert!(off < if k > 1e7 { 1e-6 } else { 1e-4 }, "{k}: {found:?}");
        } else {
            assert!(found[4] < 0.999, "soft spheres disperse: {found:?}");
        }
    }
    let mut world = world([0.0; 3]);
    let bodies: Vec<RigidBodyHandle> = (0..5)
        .map(|n| {
            let v = if n == 0 { 1.0 } else { 0.0 };
            rigid_ball(
                &mut world,
                1.0,
                r,
                [place(n), 0.0, 0.0],
                [v, 0.0, 0.0],
                1.0,
                0.0,
            )
        })
        .collect();
    steps(&mut world, 0.3);
    let theirs: Vec<f64> = bodies.iter().map(|&b| world.bodies[b].linvel().x).collect();
    let sum: f64 = theirs.iter().sum();
    // rapier keeps the momentum; it resolves impacts within a step together, so that speeds need not be exchanged
    // one after another: where it differs from 0 0 0 0 1, the closed form above is right
    assert!((sum - 1.0).abs() < 1e-2, "{theirs:?}");
    assert!(theirs[4] > 0.5, "{theirs:?}");
}

#[test]
fn a_sphere_rolls_below_seven_halves_of_friction_and_slides_above() {
    let (r, mu) = (0.1, 0.2);
    let limit = f64::atan(3.5 * mu);
    let end = 0.5;
    for theta in [0.5 * limit, 0.95 * limit, 1.2 * limit] {
        let g = tilted(theta);
        let rolls = theta < limit;
        let a = if rolls {
            5.0 / 7.0 * g[0]
        } else {
            g[0] + mu * g[2]
        };
        let spin = if rolls { a / r } else { -2.5 * mu * g[2] / r };
        let (k, c) = (1e6, damper(0.1, 1e6, 1.0));
        let differences: Vec<f64> = [1e-1, 1e-2, 1e-3]
            .iter()
            .map(|&vs| {
                let text = ball(2, 1.0, r, [0.0, 0.0, r + g[2] / k], "")
                    + &contact(1, 2, 1, k, c, &friction(mu, vs))
                    + &format!("ACCGRAV/IGRAV={:?}, KGRAV={:?}\n", g[0], g[2]);
                let s = run(&text, &["VX(2)", "WY(2)"], end, 1, 1e-8);
                let v = (last(&s, "VX(2)") - a * end).abs();
                v.max(r * (last(&s, "WY(2)") - spin * end).abs())
            })
            .collect();
        // rolling creeps, and sliding begins, below the stiction velocity
        assert!(
            differences
                .windows(2)
                .all(|d| d[1] < d[0] / 3.0 || d[1] < 1e-5),
            "{theta}: {differences:?}"
        );
        assert!(differences[2] < 2e-3, "{theta}: {differences:?}");

        let mut world = world(g);
        ground(&mut world, 0.0, mu);
        let body = rigid_ball(&mut world, 1.0, r, [0.0, 0.0, r], [0.0; 3], 0.0, mu);
        steps(&mut world, end);
        let body = &world.bodies[body];
        // some steps until the contact carries
        assert!(
            (body.linvel().x - a * end).abs() < 0.05,
            "{theta} {} {}",
            body.linvel().x,
            a * end
        );
        assert!(
            (body.angvel().y - spin * end).abs() * r < 0.05,
            "{theta} {} {}",
            body.angvel().y,
            spin * end
        );
    }
}

#[test]
fn a_box_sticks_below_the_angle_of_friction_and_slides_above() {
    let mu: f64 = 0.3;
    let end = 0.5;
    for ratio in [0.8, 1.0, 1.3] {
        let theta = (ratio * mu).atan();
        let g = tilted(theta);
        // at tan θ = µ it neither holds nor gains speed
        let a = (g[0] + mu * g[2]).max(0.0);
        let k = 1e6;
        let differences: Vec<f64> = [1e-2, 1e-3]
            .iter()
            .map(|&vs| {
                let text = cuboid([0.2, 0.2, 0.1], [0.0, 0.0, 0.1 + g[2] / (4.0 * k)], 0.0)
                    + &contact(1, 2, 1, k, damper(0.1, k, 0.25), &friction(mu, vs))
                    + &format!("ACCGRAV/IGRAV={:?}, KGRAV={:?}\n", g[0], g[2]);
                (last(&run(&text, &["VX(2)"], end, 1, 1e-8), "VX(2)") - a * end).abs()
            })
            .collect();
        // what should stick creeps at a part of the stiction velocity
        assert!(
            differences[0] < 1.1e-2 && differences[1] < 1.1e-3,
            "{ratio}: {differences:?}"
        );

        let mut world = world(g);
        ground(&mut world, 0.0, mu);
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.0, 0.0, 0.1))
            .can_sleep(false);
        let (body, _) = world.insert(
            body,
            ColliderBuilder::cuboid(0.2, 0.2, 0.1)
                .mass(1.0)
                .friction(mu)
                .restitution(0.0),
        );
        steps(&mut world, end);
        assert!(
            (world.bodies[body].linvel().x - a * end).abs() < 0.05,
            "{ratio}: {}",
            world.bodies[body].linvel().x
        );
    }
}

#[test]
fn a_box_tips_over_when_its_weight_is_beyond_the_edge() {
    let half: [f64; 3] = [0.1, 0.1, 0.2];
    // balance on an edge: the centre of mass above it
    let balance = half[0].atan2(half[2]);
    for (angle, height) in [(balance - 0.05, half[2]), (balance + 0.05, half[0])] {
        // the centre of mass while the edge x = +a, z = −c stands on the plane
        let (s, c) = angle.sin_cos();
        let z = half[0] * s + half[2] * c;
        let heights: Vec<f64> = [1e4, 1e5]
            .iter()
            .map(|&k| {
                let text = cuboid(half, [0.0, 0.0, z], angle)
                    + &contact(1, 2, 1, k, damper(0.1, k, 0.25), &friction(0.8, 1e-2))
                    + &format!("ACCGRAV/KGRAV=-{G}\n");
                let rest = last(&run(&text, &["DZ(2)"], 3.0, 1, 1e-6), "DZ(2)");
                // on four corners
                assert!(
                    (rest - (height - G / (4.0 * k))).abs() < 1e-5,
                    "{angle} {k}: {rest}"
                );
                (rest - height).abs()
            })
            .collect();
        assert!(heights[1] < heights[0] / 5.0, "{heights:?}");

        let mut world = world([0.0, 0.0, -G]);
        ground(&mut world, 0.0, 0.8);
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.0, 0.0, z))
            .rotation(Vector::new(0.0, angle, 0.0))
            .can_sleep(false);
        let (body, _) = world.insert(
            body,
            ColliderBuilder::cuboid(half[0], half[1], half[2])
                .mass(1.0)
                .friction(0.8)
                .restitution(0.0),
        );
        steps(&mut world, 3.0);
        let theirs = world.bodies[body].translation().z;
        assert!((theirs - height).abs() < 3e-3, "{angle}: {theirs}");
    }
}

#[test]
fn ten_spheres_in_a_tube_carry_each_other() {
    let (r, n) = (0.1, 10);
    let mut differences = Vec::new();
    // dynamically until nothing moves any more, and in statics
    for (k, analysis, end) in [
        (1e4, Analysis::Dynamic, 4.0),
        (1e6, Analysis::Dynamic, 1.0),
        (1e8, Analysis::Dynamic, 0.2),
        (1e4, Analysis::Static, 0.0),
        (1e6, Analysis::Static, 0.0),
    ] {
        let mut text = format!("ACCGRAV/KGRAV=-{G}\n");
        let mut pressed = 0.0;
        for b in 0..n {
            let id = b + 2;
            // pressed by half as much again as they will be, so that they stay in touch
            pressed += 1.5 * f64::from(n - b) * G / k;
            let z = r + 2.0 * r * f64::from(b) - pressed;
            text += &ball(id, 1.0, r, [0.0, 0.0, z], "");
            text += &format!("JOINT/{id}, TRANSLATIONAL, I={id}, J=1\n");
            let below = if b == 0 { 1 } else { id - 1 };
            text += &contact(id, id, below, k, damper(0.05, k, 0.5), "");
        }
        let columns: Vec<String> = (0..n).map(|b| format!("DZ({})", b + 2)).collect();
        let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
        let s = solve(&text, &columns, analysis, end, 1, 1e-7);
        // each touch is pressed by all that is above it
        let (mut pressed, mut worst) = (0.0, 0.0);
        for (b, column) in columns.iter().enumerate() {
            pressed += f64::from(n - b as u32) * G / k;
            let z = last(&s, column);
            let rigid = r + 2.0 * r * b as f64;
            assert!(
                (z - (rigid - pressed)).abs() < 2e-2 / k + 2e-9,
                "{k} {b}: {z} {}",
                rigid - pressed
            );
            worst = (z - rigid).abs().max(worst);
        }
        if analysis == Analysis::Dynamic {
            differences.push(worst);
        }
    }
    shrink(&differences, 99.0);

    let mut world = world([0.0, 0.0, -G]);
    ground(&mut world, 0.0, 0.0);
    let bodies: Vec<RigidBodyHandle> = (0..n)
        .map(|b| {
            let body = RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.0, 0.0, r + 2.0 * r * f64::from(b)))
                .enabled_translations(false, false, true)
                .enabled_rotations(false, false, false)
                .can_sleep(false);
            world
                .insert(
                    body,
                    ColliderBuilder::ball(r)
                        .mass(1.0)
                        .restitution(0.0)
                        .friction(0.0),
                )
                .0
        })
        .collect();
    steps(&mut world, 3.0);
    for (b, &body) in bodies.iter().enumerate() {
        let z = world.bodies[body].translation().z;
        // rapier's contacts give by some millimetres each under the stack (6 mm at the second sphere, where rigid ones give
        // nothing and ours what the stiffness says): the closed form is right
        assert!(
            (z - (r + 2.0 * r * b as f64)).abs() < 1e-2 * (b + 1) as f64,
            "{b}: {z}"
        );
    }
}
