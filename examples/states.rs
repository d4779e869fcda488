//! States: saved as a text, looked at by names, changed, and gone on from.
//!
//! `cargo run --example states`

use cognate::analysis::session::state::Saved;
use cognate::{Analysis, Model, Options, Session};

fn main() -> Result<(), cognate::Error> {
    let model = Model::read("examples/slider_crank.adm")?;
    let mut session = Session::new(model, "crank", Options::default());
    session.run_to(Analysis::Dynamic, 0.5, 50)?;
    let text = session.save();
    println!("{} bytes", text.len());

    let there = Saved::read(text.as_bytes())?;
    for (name, value) in there.values() {
        println!("{name} = {value}");
    }
    // another session goes on from there, to the same bits
    let mut other = Session::new(there.model().clone(), "crank", Options::default());
    other.set_state(&there)?;
    for session in [&mut session, &mut other] {
        session.run_to(Analysis::Dynamic, 1.0, 50)?;
    }
    let same = session.state().values().eq(other.state().values());
    println!("the same state: {same}");
    assert!(same);
    Ok(())
}
