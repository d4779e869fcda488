//! Laws of datasets and command files on random statements and hostile bytes.

use crate::models;

use models::{TARGETS, commands, dataset, fuzz_command, fuzz_dataset, fuzz_model, fuzz_view};
use proptest::prelude::*;
use std::time::{Duration, Instant};

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_read_written_and_read_again_is_the_same_model(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        fuzz_model(&bytes);
    }

    #[test]
    fn commands_are_read_and_applied_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        fuzz_command(&bytes);
    }

    #[test]
    fn any_bytes_are_read_without_harm(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        fuzz_dataset(&bytes);
        fuzz_command(&bytes);
        fuzz_view(&bytes);
    }

    /// Texts that were right before some of their bytes were changed, lost or doubled.
    #[test]
    fn damaged_datasets_are_read_without_harm(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4usize), 1..12),
    ) {
        for mut text in [dataset(&bytes).into_bytes(), commands(&bytes).into_bytes()] {
            for (place, byte, what) in &damage {
                let at = place.index(text.len());
                match what {
                    0 => text[at] = *byte,
                    1 => text[at] = b",=/\\:!&\n(\"'"[usize::from(*byte) % 11],
                    2 => drop(text.drain(at..(at + usize::from(*byte) % 20).min(text.len()))),
                    _ => text.insert(at, *byte),
                }
                if text.is_empty() {
                    break;
                }
            }
            fuzz_dataset(&text);
            fuzz_command(&text);
        }
    }
}

#[test]
fn inputs_that_once_failed_keep_the_laws() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/fuzz");
    for (target, law) in TARGETS {
        let found = std::fs::read_dir(format!("{folder}/{target}"));
        for entry in found.into_iter().flatten().flatten() {
            println!("{}", entry.path().display());
            law(&std::fs::read(entry.path()).unwrap());
        }
    }
}

/// Two joints and one scale mean a scale of 1 before it, also beside a mistake.
#[test]
fn what_follows_from_arguments_follows_beside_a_mistake() {
    let text = "a title\nCOUPLER/4, JOINTS=1,2, SCALES=3, TYPO\nEND\n";
    models::laws_of_datasets(text);
    let model = cognate::dataset::read_text(text).model;
    assert_eq!(model.couplers[&4].scales, [1.0, 3.0]);
}

/// A dataset ten times as long takes about ten times as long; twice that is allowed for what the machine does besides.
#[test]
fn reading_takes_time_in_proportion_to_the_dataset() {
    let bytes: Vec<u8> = (0u32..40_000)
        .map(|k| (k.wrapping_mul(2_654_435_761) >> 13) as u8)
        .collect();
    let part = dataset(&bytes[..400]);
    let statements = part.trim_end_matches("END\n");
    let whole = |n: usize| format!("{}END\n", statements.repeat(n));
    let taken = |text: &str| {
        let once = |()| {
            let start = Instant::now();
            let _ = cognate::dataset::read_text(text);
            start.elapsed()
        };
        [(); 3].map(once).into_iter().min().unwrap_or_default()
    };
    let (short, long) = (taken(&whole(10)), taken(&whole(100)));
    assert!(
        long < 20 * short + Duration::from_millis(50),
        "{short:?} and {long:?}"
    );
}
