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

/// Pairs the events of two runs: in order where they have the same number, else each with the
/// nearest one.
pub fn shifts(events: &[f64], others: &[f64]) -> Vec<Shift> {
    let shift = |(&t, &other): (&f64, &f64)| Shift {
        t,
        shift: (t - other).abs(),
    };
    if events.len() == others.len() {
        return events.iter().zip(others).map(shift).collect();
    }
    let nearest = |t: &f64| {
        let k = others.partition_point(|o| o < t);
        let beside = [k.checked_sub(1), Some(k)].into_iter().flatten();
        let distances = beside.filter_map(|k| Some((others.get(k)? - t).abs()));
        distances.fold(f64::INFINITY, f64::min)
    };
    let events = events.iter().map(|t| Shift {
        t: *t,
        shift: nearest(t),
    });
    events.filter(|s| s.shift.is_finite()).collect()
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
}
