//! CONTACT of tori and curves with solids: what lies along a solid rests, what is tilted touches first at its lowest place, and nothing jumps between.

use crate::running;

use cognate::internals::physics::contact::{Question, Solid, TOUCH_NUMBERS};
use running::{Analysis, Session, first, go, last, refused, session};

const RING: &str = "TORUS, CM=2, MAJOR_RADIUS=1, MINOR_RADIUS=0.2";
const HOOP: &str = "CIRCLE, CM=2, RADIUS=1";
const PLANE: &str = "PLANE, RM=1";
const BOX: &str = "BOX, CORNER=9, X=6, Y=6, Z=1";
const LAW: &str = "IMPACT, STIFFNESS=1E5, EXPONENT=1.5, DAMPING=300, DMAX=1E-3";

fn over(ground: &str, body: &str, at: &str, law: &str, columns: &[&str], end: f64) -> Session {
    let text = format!(
        "PART/2, MASS=1, CM=2, IP=0.5,0.5,1, {at}\nMARKER/2, PART=2\nMARKER/9, PART=1, QP=-3,-3,-1\n\
         GRAPHICS/1, {ground}\nGRAPHICS/2, {body}\nACCGRAV/KGRAV=-10\nCONTACT/1, IGEOM=2, JGEOM=1, {law}\n"
    );
    let mut s = session(&text, columns, 1e-8);
    go(&mut s, Analysis::Dynamic, end, 10);
    s
}

#[test]
fn a_ring_dropped_level_comes_to_rest_as_deep_as_four_springs_are() {
    for (body, thick) in [(RING, 0.2), (HOOP, 0.0)] {
        for ground in [PLANE, BOX] {
            let at = format!("QG=0,0,{:?}", thick + 0.05);
            let s = over(ground, body, &at, LAW, &["DZ(2)", "VM(2)", "WM(2)"], 1.5);
            // 4 k δ^1.5 = m g
            let depth = (10.0 / 4e5_f64).powf(1.0 / 1.5);
            let off = last(&s, "DZ(2)") - (thick - depth);
            // damping is c/(6 k √δ) of the stiffness' time: e^(−ζωt) of 0.05 is below the request
            assert!(off.abs() < 1e-7, "{body} on {ground}: {off:e}");
            assert!(last(&s, "WM(2)") < 1e-6 && last(&s, "VM(2)") < 1e-5);
            // 150 when this was written; what lies along an arc took 40 s
            let steps = s.run.record.counts.steps;
            assert!(steps < 1000, "{body} on {ground}: {steps}");
        }
    }
}

#[test]
fn a_tilted_ring_begins_to_touch_when_its_lowest_place_arrives() {
    let tilt = 0.4f64;
    for (body, thick) in [(RING, 0.2), (HOOP, 0.0)] {
        for ground in [PLANE, BOX] {
            // 0.3 above: 10 t²/2 = 0.3
            let z = tilt.sin() + thick + 0.3;
            let at = format!("QG=0.1,0.2,{z:?}, REULER=0.7,{tilt:?},0.3");
            let t = 0.06f64.sqrt();
            for (end, touches) in [(t - 1e-7, false), (t + 1e-7, true)] {
                let s = over(ground, body, &at, LAW, &["CONTACT(1,0,4,0)"], end);
                assert_eq!(
                    last(&s, "CONTACT(1,0,4,0)") > 0.0,
                    touches,
                    "{body} {ground}"
                );
            }
        }
    }
}

/// Force and torque about the middle of a torus (ring 1, tube 0.2) of linear springs of stiffness 1 in the frame of a box
/// from −2 to 2 (below z = 0), or of a cylinder of radius 1.5.
fn springs(solid: &Solid, place: [f64; 3], tilt: [f64; 2]) -> [f64; 6] {
    let torus = Solid::Torus {
        ring: 1.0,
        tube: 0.2,
    };
    let Some(Question::Wire(wire)) = Question::wire(&torus, solid) else {
        panic!("a wire");
    };
    let ([sa, ca], [sb, cb]) = (
        [tilt[0].sin(), tilt[0].cos()],
        [tilt[1].sin(), tilt[1].cos()],
    );
    // about x, then about the new y
    let axes = [
        [cb, sa * sb, -ca * sb],
        [0.0, ca, sa],
        [sb, -sa * cb, ca * cb],
    ];
    let pose: Vec<f64> = [place, axes[0], axes[1], axes[2]].concat();
    let mut out = vec![0.0; wire.touches() * TOUCH_NUMBERS];
    wire.ask(&pose, &mut out);
    let mut sum = [0.0; 6];
    for touch in out.chunks(TOUCH_NUMBERS) {
        let on_i = [0, 1, 2].map(|k| (0..3).map(|a| axes[a][k] * touch[a]).sum::<f64>());
        let gap: f64 = (0..3)
            .map(|k| (place[k] + on_i[k] - touch[3 + k]) * touch[6 + k])
            .sum();
        let force = (-gap - touch[9]).max(0.0) * touch[10];
        let f = [0, 1, 2].map(|k| force * touch[6 + k]);
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            sum[k] += f[k];
            sum[3 + k] += on_i[a] * f[b] - on_i[b] * f[a];
        }
    }
    sum
}

/// The largest change of a force along a way, between places that are a part of it apart.
fn largest_jump(solid: &Solid, way: impl Fn(f64) -> ([f64; 3], [f64; 2]), parts: u32) -> f64 {
    let at = |k: u32| {
        let (place, tilt) = way(f64::from(k) / f64::from(parts));
        springs(solid, place, tilt)
    };
    (0..parts)
        .flat_map(|k| {
            let (a, b) = (at(k), at(k + 1));
            (0..6).map(move |c| (a[c] - b[c]).abs())
        })
        .fold(0.0, f64::max)
}

#[test]
fn the_force_on_a_ring_does_not_jump_while_it_tilts_slides_or_turns() {
    let cuboid = Solid::Box {
        low: [-2.0, -2.0, -1.0],
        high: [2.0, 2.0, 0.0],
    };
    let cylinder = Solid::Frustum {
        z: [-1.0, 0.0],
        radius: [1.5, 1.5],
    };
    let ellipsoid = Solid::Ellipsoid {
        semi: [1.6, 1.1, 0.7],
    };
    let depth = 0.01;
    type Way = fn(f64) -> ([f64; 3], [f64; 2]);
    let ways: [(&str, Way); 5] = [
        ("tilts", |u| ([0.0, 0.0, 0.19], [0.04 * u - 0.02, 0.005])),
        ("slides off", |u| ([1.0 + 2.0 * u, 0.1, 0.19], [0.0, 0.0])),
        ("slides off tilted", |u| {
            ([1.0 + 2.0 * u, 0.1, 0.195], [0.003, 0.02])
        }),
        ("sinks tilted", |u| {
            ([0.9, 0.0, 0.25 - 0.1 * u], [0.02, 0.01])
        }),
        ("rolls", |u| {
            let a = 0.1 * u;
            ([1.1 * a, 0.0, 1.1], [1.2, a])
        }),
    ];
    for solid in [&cuboid, &cylinder, &ellipsoid] {
        for (name, way) in ways {
            let [coarse, fine] = [400, 4000].map(|n| largest_jump(solid, way, n));
            // parts are shorter than the way on which a place that slides off an edge is let go. What is continuous changes by less over a shorter way: ten times less where it has a slope; jumps of what touches by no more than a
            // part in 1e5 of what it carries are not felt
            assert!(
                fine < 0.35 * coarse || fine < 1e-5 * depth,
                "{name} {solid:?}: {coarse:e} {fine:e}"
            );
        }
    }
}

#[test]
fn a_ring_half_on_a_box_is_carried_by_that_half() {
    let cuboid = Solid::Box {
        low: [-2.0, -2.0, -1.0],
        high: [2.0, 2.0, 0.0],
    };
    let on = springs(&cuboid, [0.0, 0.0, 0.19], [0.0; 2]);
    assert!((on[2] - 0.04).abs() < 1e-12 && on[3].abs() < 1e-12 && on[4].abs() < 1e-12);
    let half = springs(&cuboid, [2.0, 0.0, 0.19], [0.0; 2]);
    // twelve places of which five to seven are on it; the middle of a half circle is at 2/π
    assert!((half[2] - 0.02).abs() < 0.004, "{half:?}");
    let arm = half[4] / half[2];
    assert!((arm - 2.0 / std::f64::consts::PI).abs() < 0.1, "{half:?}");
}

#[test]
fn what_never_touches_is_refused_with_what_to_draw_instead() {
    for (i, j, advice) in [
        ("PLANE, RM=2", "PLANE, RM=1", "BOX"),
        ("POINT, RM=2", "POINT, RM=1", "ELLIPSOID"),
    ] {
        let text = format!(
            "PART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\nGRAPHICS/1, {j}\nGRAPHICS/2, {i}\nCONTACT/1, IGEOM=2, JGEOM=1, {LAW}\n"
        );
        let error = refused(&text, Analysis::Dynamic);
        let said = error.to_string();
        assert_eq!(error.code, "unsupported");
        for part in ["GRAPHICS/1", "GRAPHICS/2", advice] {
            assert!(said.contains(part), "{said}");
        }
    }
}

#[test]
fn a_hoop_rolls_on_a_box_as_on_a_plane() {
    // upright, v = ω r: nothing slips
    let friction = format!(
        "{LAW}\n, COULOMB_FRICTION=ON, MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=1E-3, FRICTION_TRANSITION_VELOCITY=1E-2"
    );
    let depth = (10.0 / 1e5_f64).powf(1.0 / 1.5);
    let at = format!("QG=-1,0,{:?}, REULER=0,90D,0, VX=1.5, WZ=-1.5", 1.0 - depth);
    let columns = ["DX(2)", "DZ(2)"];
    for ground in [PLANE, BOX] {
        let s = over(ground, HOOP, &at, &friction, &columns, 1.0);
        // the arm of friction is shorter than the radius by half the depth: 1e-3 of 1.5
        let way = last(&s, "DX(2)") - first(&s, "DX(2)");
        assert!((way - 1.5).abs() < 1e-3, "{ground} {way}");
        assert!((last(&s, "DZ(2)") - (1.0 - depth)).abs() < 1e-6, "{ground}");
    }
}
