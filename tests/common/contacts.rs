//! Models of spheres and boxes in contact, for us and for rapier, with their closed forms.
#![allow(dead_code)] // each program uses its own part

use super::running;

use rapier3d_f64::prelude::*;
pub use running::{Analysis, Session, last};

pub const G: f64 = 9.81;
/// rapier's step
pub const DT: f64 = 1e-3;

/// A dynamic run over a plane at height 0.
pub fn run(text: &str, columns: &[&str], end: f64, steps: u32, error: f64) -> Session {
    solve(text, columns, Analysis::Dynamic, end, steps, error)
}

/// A simulation over a plane at height 0.
pub fn solve(
    text: &str,
    columns: &[&str],
    analysis: Analysis,
    end: f64,
    steps: u32,
    error: f64,
) -> Session {
    let text = format!("GRAPHICS/1, PLANE, RM=1\n{text}");
    running::run(&text, columns, analysis, (end, steps as usize), error)
}

/// A ball of dataset number `n` (part, marker, graphics), mass `m`, radius `r`.
pub fn ball(n: u32, m: f64, r: f64, at: [f64; 3], more: &str) -> String {
    let [x, y, z] = at;
    let (i, d) = (0.4 * m * r * r, 2.0 * r);
    format!(
        "PART/{n}, MASS={m:?}, CM={n}, IP={i:?},{i:?},{i:?}, QG={x:?},{y:?},{z:?}{more}\nMARKER/{n}, PART={n}\n\
         GRAPHICS/{n}, ELLIPSOID, CM={n}, XSCALE={d:?}, YSCALE={d:?}, ZSCALE={d:?}\n"
    )
}

/// A linear contact: stiffness k, damper c that is fully there at once.
pub fn contact(n: u32, i: u32, j: u32, k: f64, c: f64, more: &str) -> String {
    format!(
        "CONTACT/{n}, IGEOM={i}, JGEOM={j}, IMPACT, STIFFNESS={k:?}, EXPONENT=1, DAMPING={c:?}, DMAX=1E-12{more}\n"
    )
}

/// Coulomb friction with one coefficient and a stiction velocity.
pub fn friction(mu: f64, v: f64) -> String {
    format!(
        "\n, COULOMB_FRICTION=ON, MU_STATIC={mu:?}, MU_DYNAMIC={mu:?}, STICTION_TRANSITION_VELOCITY={v:?}\n\
         , FRICTION_TRANSITION_VELOCITY={:?}",
        2.0 * v
    )
}

/// Restitution of a spring with a damper that never pulls, at damping ratio ζ.
///
/// x = v/ω e^(−βt) sin ωt with β = ζω₀, ω² = ω₀² − β² until the force, and with it ẍ, vanishes:
/// tan ωt = 2βω/(β² − ω²); beyond ζ = 1 the same with hyperbolic functions.
pub fn restitution(zeta: f64) -> f64 {
    if zeta < 1.0 {
        let w = (1.0 - zeta * zeta).sqrt();
        let a = (2.0 * zeta * w).atan2(zeta * zeta - w * w);
        (-zeta * a / w).exp() * (zeta / w * a.sin() - a.cos())
    } else {
        let s = (zeta * zeta - 1.0).sqrt();
        let a = (2.0 * zeta * s / (zeta * zeta + s * s)).atanh();
        (-zeta * a / s).exp() * (zeta / s * a.sinh() - a.cosh())
    }
}

/// The damping ratio of a restitution between 0.02 and 1.
pub fn damping_ratio(e: f64) -> f64 {
    if e == 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (1e-9, 8.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (middle - 1.0f64).abs() < 1e-12 || restitution(middle) > e {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// c of a linear contact of stiffness k and effective mass m with restitution e.
pub fn damper(e: f64, k: f64, m: f64) -> f64 {
    2.0 * damping_ratio(e) * (k * m).sqrt()
}

/// A world without ground, z up.
pub fn world(gravity: [f64; 3]) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(gravity[0], gravity[1], gravity[2]);
    world.integration_parameters.dt = DT;
    world
}

pub fn ground(world: &mut PhysicsWorld, e: f64, mu: f64) {
    world.insert(
        RigidBodyBuilder::fixed().translation(Vector::new(0.0, 0.0, -1.0)),
        ColliderBuilder::cuboid(100.0, 100.0, 1.0)
            .restitution(e)
            .friction(mu),
    );
}

pub fn steps(world: &mut PhysicsWorld, end: f64) {
    for _ in 0..(end / DT).round() as usize {
        world.step();
    }
}

pub fn rigid_ball(
    world: &mut PhysicsWorld,
    m: f64,
    r: f64,
    at: [f64; 3],
    v: [f64; 3],
    e: f64,
    mu: f64,
) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::new(at[0], at[1], at[2]))
        .linvel(Vector::new(v[0], v[1], v[2]))
        .can_sleep(false);
    world
        .insert(
            body,
            ColliderBuilder::ball(r).mass(m).restitution(e).friction(mu),
        )
        .0
}

/// Gravity of a plane tilted by θ about y, in the plane's own axes.
pub fn tilted(theta: f64) -> [f64; 3] {
    [G * theta.sin(), 0.0, -G * theta.cos()]
}

/// A box with edges 2a, 2b, 2c about its centre of mass at `at`, turned by `angle` about y.
pub fn cuboid(half: [f64; 3], at: [f64; 3], angle: f64) -> String {
    let [a, b, c] = half;
    let i = [b * b + c * c, a * a + c * c, a * a + b * b].map(|x| x / 3.0);
    // REULER 90, angle, −90: a turn about y
    format!(
        "PART/2, MASS=1, CM=2, IP={:?},{:?},{:?}, QG={:?},{:?},{:?}, REULER=90D,{angle:?},-90D\nMARKER/2, PART=2\n\
         MARKER/3, PART=2, QP={:?},{:?},{:?}\nGRAPHICS/2, BOX, CORNER=3, X={:?}, Y={:?}, Z={:?}\n",
        i[0],
        i[1],
        i[2],
        at[0],
        at[1],
        at[2],
        -a,
        -b,
        -c,
        2.0 * a,
        2.0 * b,
        2.0 * c
    )
}

/// A ball of mass 1 at height `h` above the plane, and a contact of stiffness `k` and restitution `e`.
pub fn falling_ball(r: f64, h: f64, k: f64, e: f64) -> String {
    ball(2, 1.0, r, [0.0, 0.0, r + h], "")
        + &contact(1, 2, 1, k, damper(e, k, 1.0), "")
        + &format!("ACCGRAV/KGRAV=-{G}\n")
}

/// Speed and height above the plane of the same ball as rapier has it at a time.
pub fn rigid_falling_ball(r: f64, h: f64, e: f64, end: f64) -> [f64; 2] {
    let mut world = world([0.0, 0.0, -G]);
    ground(&mut world, e, 0.0);
    let body = rigid_ball(&mut world, 1.0, r, [0.0, 0.0, r + h], [0.0; 3], e, 0.0);
    steps(&mut world, end);
    let body = &world.bodies[body];
    [body.linvel().z, body.translation().z - r]
}

/// Speed with which a ball left the plane, from its speed and height now.
pub fn left_with([v, z]: [f64; 2]) -> f64 {
    (v * v + 2.0 * G * z).max(0.0).sqrt()
}

/// Columns of two balls that meet.
pub const MEETING: [&str; 4] = ["VX(2)", "VY(2)", "VX(3)", "VY(3)"];

/// Two balls on the x axis, `offset` apart across it, with masses, speeds along x, stiffness and restitution.
pub struct Meeting {
    pub r: f64,
    pub from: f64,
    pub to: [f64; 2],
    pub masses: [f64; 2],
    pub speeds: [f64; 2],
    pub e: f64,
}

impl Meeting {
    /// Velocities of both at time 0.5.
    pub fn ours(&self, k: f64, error: f64) -> [f64; 4] {
        let ([m1, m2], [u1, u2]) = (self.masses, self.speeds);
        let text = ball(
            2,
            m1,
            self.r,
            [self.from, 0.0, 0.0],
            &format!(", VX={u1:?}"),
        ) + &ball(
            3,
            m2,
            self.r,
            [self.to[0], self.to[1], 0.0],
            &format!(", VX={u2:?}"),
        ) + &contact(1, 2, 3, k, damper(self.e, k, m1 * m2 / (m1 + m2)), "");
        let s = run(&text, &MEETING, 0.5, 1, error);
        MEETING.map(|c| last(&s, c))
    }

    /// The same by rapier.
    pub fn rigid(&self) -> [f64; 4] {
        let mut world = world([0.0; 3]);
        let places = [[self.from, 0.0, 0.0], [self.to[0], self.to[1], 0.0]];
        let [a, b] = [0, 1].map(|n| {
            let v = [self.speeds[n], 0.0, 0.0];
            rigid_ball(
                &mut world,
                self.masses[n],
                self.r,
                places[n],
                v,
                self.e,
                0.0,
            )
        });
        steps(&mut world, 0.5);
        let (a, b) = (world.bodies[a].linvel(), world.bodies[b].linvel());
        [a.x, a.y, b.x, b.y]
    }
}

/// Two balls of which one is passed 0.12 aside of its centre, restitution 0.6.
pub fn oblique() -> Meeting {
    Meeting {
        r: 0.1,
        from: -0.3,
        to: [0.0, 0.12],
        masses: [1.0; 2],
        speeds: [1.0, 0.0],
        e: 0.6,
    }
}

/// Their velocities afterwards: the moving one loses half of (1 + e) of its speed along the line of centres, whose slope where
/// they touch is 0.12 / √(4r² − 0.12²).
pub fn oblique_exact() -> [f64; 4] {
    let (r, offset): (f64, f64) = (0.1, 0.12);
    let n = [
        (4.0 * r * r - offset * offset).sqrt() / (2.0 * r),
        offset / (2.0 * r),
    ];
    let lost = 0.5 * (1.0 + 0.6) * n[0];
    [1.0 - lost * n[0], -lost * n[1], lost * n[0], lost * n[1]]
}
