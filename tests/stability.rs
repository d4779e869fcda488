//! Scenes of known answer, in families from stiff to circular: each comes out right, or stops with its reason.
//!
//! `cargo test --test stability -- --nocapture` prints the table; `STABILITY=word` runs only scenes whose family or name has the word.
#![cfg(feature = "solver")]

#[path = "stability/families/mod.rs"]
mod families;
#[path = "stability/laws.rs"]
mod laws;
#[path = "common/running.rs"]
mod running;
#[path = "stability/scene.rs"]
mod scene;

use scene::Outcome;
use std::collections::BTreeMap;

#[test]
fn every_scene_of_known_answer_comes_out_right() {
    let word = std::env::var("STABILITY").unwrap_or_default();
    let mut counts: BTreeMap<&str, [usize; 5]> = BTreeMap::new();
    let mut wrong = Vec::new();
    for one in families::all() {
        if !one.family.contains(&word) && !one.name.contains(&word) {
            continue;
        }
        let found = one.run_at(one.error, one.method, None);
        let (outcome, sentence, steps) = (found.outcome, found.sentence, found.steps);
        counts.entry(one.family).or_default()[outcome as usize] += 1;
        let line = format!(
            "{:<14} {:<46} at {:e} {outcome:?}: {sentence}; {steps} steps",
            one.family, one.name, one.error
        );
        println!("{line}");
        if outcome != Outcome::Right {
            wrong.push(line);
        }
    }
    for (family, [right, stopped, told, limited, wrong]) in &counts {
        println!(
            "{family:<14} {right} right, {stopped} stopped, {told} told, {limited} at a limit, {wrong} wrong"
        );
    }
    assert!(
        wrong.is_empty(),
        "{} scenes:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}
