//! Outputs and events of two runs that belong together.

/// An event that both runs have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// its time in the run, in s
    pub t: f64,
    /// how much earlier or later it is in the other, in s
    pub shift: f64,
}

/// Times of outputs that are the same but for rounding, relative to the larger.
const SAME_TIME: f64 = 1e-12;

/// Finds the output of another run that belongs to each output of a run: the one at the same time,
/// or, for outputs that events made, the next one of the other run before the next common time.
pub fn partners(times: &[f64], others: &[f64]) -> Vec<Option<usize>> {
    let same = |a: f64, b: f64| (a - b).abs() <= SAME_TIME * a.abs().max(b.abs());
    let mut found = vec![None; times.len()];
    let mut common = Vec::new();
    let mut from = 0;
    for (k, &t) in times.iter().enumerate() {
        let later = others[from..].partition_point(|&o| o < t && !same(o, t));
        if others.get(from + later).is_some_and(|&o| same(o, t)) {
            found[k] = Some(from + later);
            common.push((k, from + later));
            from += later + 1;
        }
    }
    // between common times: in order
    let ends = (times.len(), others.len());
    let mut last = (0, 0);
    for (k, l) in common.into_iter().chain([ends]) {
        let (own, other) = (last.0..k, last.1..l);
        for (k, l) in own.zip(other) {
            found[k] = Some(l);
        }
        last = (k + 1, l + 1);
    }
    found
}

/// Pairs the events of two runs: in order where they have the same number, else those of which each
/// is the nearest of the other. An event that one run has alone is that of a branch which is hardly
/// touched, and says nothing of times.
pub fn shifts(events: &[f64], others: &[f64]) -> Vec<Shift> {
    let shift = |(&t, &other): (&f64, &f64)| Shift {
        t,
        shift: (t - other).abs(),
    };
    if events.len() == others.len() {
        return events.iter().zip(others).map(shift).collect();
    }
    let mutual = events.iter().enumerate().filter_map(|(k, t)| {
        let l = nearest(others, *t)?;
        (nearest(events, others[l])? == k).then(|| shift((t, &others[l])))
    });
    mutual.collect()
}

/// Returns the index of the time that is nearest to `t`, the earlier one of two.
fn nearest(times: &[f64], t: f64) -> Option<usize> {
    let k = times.partition_point(|o| *o < t);
    let distance = |k: &usize| (times[*k] - t).abs();
    let beside = [k.checked_sub(1), (k < times.len()).then_some(k)];
    let beside = beside.into_iter().flatten();
    beside.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_that_events_made_belong_together_between_common_times() {
        let (own, other) = ([0.0, 0.31, 1.0, 2.0], [0.0, 0.30, 0.33, 1.0, 2.0]);
        let found = partners(&own, &other);
        assert_eq!(found, [Some(0), Some(1), Some(3), Some(4)]);
        assert_eq!(
            partners(&[0.0, 1.0, 2.0], &[0.0, 1.0]),
            [Some(0), Some(1), None]
        );
    }

    #[test]
    fn events_are_paired_in_order_or_with_the_nearest() {
        let same = shifts(&[1.0, 2.0], &[1.5, 2.5]);
        assert!(same.iter().all(|s| s.shift == 0.5));
        let more = shifts(&[1.0, 2.0], &[0.9, 1.8, 2.1]);
        assert!((more[0].shift - 0.1).abs() < 1e-12 && (more[1].shift - 0.1).abs() < 1e-12);
        assert!(shifts(&[1.0], &[]).is_empty());
    }

    #[test]
    fn an_event_that_one_run_has_alone_shifts_nothing() {
        let of = |t: f64| Shift { t, shift: 0.125 };
        let found = shifts(&[1.0, 1.5, 2.0], &[1.125, 2.125]);
        assert_eq!(found, [of(1.0), of(2.0)]);
    }
}
