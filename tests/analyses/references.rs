//! Problems with trusted solutions: the true error stays in proportion to the request.
//!
//! `tests/data/references` holds datasets with their command files, and solutions good to more digits than are compared.
//! A column of a solution has the expression for its name that the dataset requests; the others are there for the curious.
//! The true error is the largest difference over samples and columns, each column relative to its largest magnitude.

use cognate::dataset::command::Script;
use cognate::model::Model;
use cognate::results::csv;
use requests::expressions;
use running::{Options, begin, obeys, values};
use std::path::Path;

use crate::requests;
use crate::running;

fn distance(reference: &[f64], ours: &[f64]) -> f64 {
    let scale = reference.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let scale = if scale > 0.0 { scale } else { 1.0 };
    reference
        .iter()
        .zip(ours)
        .map(|(a, b)| (a - b).abs() / scale)
        .fold(0.0, f64::max)
}

/// The true error at a requested error, and the largest residual of a row.
fn solve(problem: &str, error: f64) -> (f64, f64) {
    solve_by(problem, error, None)
}

/// The same by a method of the user's choice.
fn solve_by(problem: &str, error: f64, method: Option<&str>) -> (f64, f64) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/references");
    let script = Script::read(folder.join(format!("{problem}.acf"))).unwrap();
    let model = Model::read(script.model_file().unwrap()).unwrap();
    let reference =
        csv::read(&std::fs::read(folder.join(format!("{problem}.csv"))).unwrap()).unwrap();
    let asked = expressions(&model);
    let options = Options {
        error: Some(error),
        columns: asked.clone(),
        method: method.map(str::to_string),
        ..Options::default()
    };
    let mut session = begin(model, problem, options);
    obeys(&mut session, &script);
    let mut worst: f64 = 0.0;
    for expression in &asked {
        let ours = values(&session, expression);
        let theirs = reference
            .column(expression)
            .unwrap_or_else(|| panic!("{problem}: the solution has no column {expression}"));
        assert_eq!(ours.len(), theirs.len(), "{problem}: rows");
        worst = worst.max(distance(theirs, ours));
    }
    assert!(worst > 0.0, "{problem}: nothing was compared");
    (worst, session.run.record.constraint_drift.unwrap_or(0.0))
}

/// At each request the true error is below `factor` times it, and rows hold to 1e-10.
fn stays_in_proportion(problem: &str, requests: &[f64], factor: f64) {
    for &request in requests {
        let (error, drift) = solve(problem, request);
        println!("{problem}: request {request:e}, true error {error:.1e}, rows {drift:.1e}");
        assert!(
            error < factor * request,
            "{problem}: request {request:e}, true error {error:e}"
        );
        assert!(
            drift < 1e-10,
            "{problem}: request {request:e}, rows off by {drift:e}"
        );
    }
}

const REQUESTS: [f64; 5] = [1e-3, 1e-5, 1e-7, 1e-9, 1e-11];

#[test]
fn pendulum() {
    stays_in_proportion("a01_pendulum", &REQUESTS, 100.0);
}
#[test]
fn double_pendulum_which_is_chaotic() {
    stays_in_proportion("double_pendulum", &REQUESTS, 1000.0);
}
#[test]
fn four_bars_pass_their_singular_positions() {
    // below 1e-8 the rounding of nearly dependent rows is what is left: about 1e-7 of true error
    stays_in_proportion("a02_nfourbar_2", &REQUESTS, 100.0);
    stays_in_proportion("a02_nfourbar_10", &REQUESTS, 100.0);
}
#[test]
fn andrews_squeezer() {
    stays_in_proportion("a03_andrews", &REQUESTS, 100.0);
}
#[test]
fn bricard_which_moves_although_it_should_not() {
    stays_in_proportion("a04_bricard", &REQUESTS, 100.0);
}
#[test]
fn heavy_top() {
    stays_in_proportion("heavy_top", &REQUESTS, 100.0);
}
#[test]
fn free_body_that_flips() {
    stays_in_proportion("dzhanibekov", &REQUESTS, 100.0);
}
#[test]
fn driven_slider_crank_with_its_torque() {
    // no error control: positions are solved
    stays_in_proportion("slider_crank_kin", &[1e-11], 100.0);
}
#[test]
fn a_nut_on_a_screw() {
    stays_in_proportion("screw", &REQUESTS, 100.0);
}
#[test]
fn a_pinion_and_its_rack() {
    stays_in_proportion("rack_pinion", &REQUESTS, 100.0);
}
#[test]
fn two_gears() {
    stays_in_proportion("gear_pair", &REQUESTS, 100.0);
}
#[test]
fn chains_of_rods() {
    stays_in_proportion("chain_10", &REQUESTS, 1000.0);
    stays_in_proportion("chain_40", &[1e-4], 1000.0);
}
#[test]
fn ten_masses_in_a_row() {
    stays_in_proportion("spring_mass_chain", &REQUESTS, 100.0);
}

/// What contact is asked at.
const CONTACT_REQUESTS: [f64; 3] = [1e-4, 1e-6, 1e-8];

#[test]
fn balls_that_bounce() {
    for problem in ["bounce_k1e5", "bounce_k1e6", "bounce_k1e7", "bounce_k1e8"] {
        stays_in_proportion(problem, &CONTACT_REQUESTS, 100.0);
    }
}
#[test]
fn a_slider_between_two_stops() {
    stays_in_proportion("bistop_slot", &CONTACT_REQUESTS, 100.0);
}
#[test]
fn a_sphere_that_settles() {
    stays_in_proportion("settle_sphere", &CONTACT_REQUESTS, 100.0);
}
#[test]
fn a_stiff_bushing() {
    stays_in_proportion("stiff_bushing", &CONTACT_REQUESTS, 100.0);
}
#[test]
fn a_governor_with_a_stiff_spring() {
    stays_in_proportion("a05_flyball", &CONTACT_REQUESTS, 100.0);
}

fn both_methods(problem: &str) {
    for method in ["DOP853", "RADAU5"] {
        let mut last = f64::INFINITY;
        for request in [1e-4, 1e-6] {
            let (error, _) = solve_by(problem, request, Some(method));
            println!("{problem} by {method}: request {request:e}, true error {error:.1e}");
            assert!(
                error < 100.0 * request,
                "{method} at {request:e}: {error:e}"
            );
            assert!(error < 0.3 * last, "{method}: {last:e}, then {error:e}");
            last = error;
        }
    }
}
#[test]
fn a_pendulum_by_both_methods() {
    both_methods("a01_pendulum");
}
#[test]
fn a_mechanism_of_loops_by_both_methods() {
    both_methods("a03_andrews");
}
#[test]
fn a_top_by_both_methods() {
    both_methods("heavy_top");
}
