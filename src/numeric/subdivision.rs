//! Where something first happens along a stretch of time, shown by bounds instead of looked for at
//! points.
//!
//! ```text
//! [t, t + h]   shown to be free                 →  go on behind it with 2h
//!              shown to hold an event           →  look closely: at its ends
//!              shown to be free for a part      →  go on behind that with h/2
//!              else, longer than the shortest   →  h/2
//!              else                             →  look closely
//! ```
//!
//! A stretch that is shown to be free is so however short an event would be. The question decides
//! how: a value that stays between two levels, a rate that keeps its sign ([`Interval`] over a
//! program).
//!
//! [`Interval`]: crate::scalar::Interval

/// The limits of a search.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    /// longest stretch to begin with, in s
    pub first: f64,
    /// shortest stretch that is divided no further, in s
    pub shortest: f64,
}

/// Stretches that a search looks at, at most: forty halvings to the shortest and back, ten times.
const MOST_STRETCHES: usize = 400;

/// The knowledge of a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shown {
    /// nothing happens in it
    Free,
    /// something does: it need not be divided
    Event,
    /// nothing happens in it before this time, in s
    Until(f64),
    /// neither
    Nothing,
}

impl From<bool> for Shown {
    fn from(is_free: bool) -> Self {
        if is_free { Self::Free } else { Self::Nothing }
    }
}

/// The answer to a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<T> {
    /// nothing happens before this time, in s
    pub free_to: f64,
    /// what happens in the stretch that begins there; `None`: the end was reached, or as many
    /// stretches were looked at as permitted
    pub event: Option<T>,
}

/// Searches from `from` to `end`: `show(a, b)` says what is shown of the stretch between two times,
/// `event(a, b)` what happens in one that is shown to hold an event, or as short as permitted.
pub fn first<C, T, S: Into<Shown>>(
    course: &mut C,
    (from, end): (f64, f64),
    search: Search,
    show: impl Fn(&mut C, f64, f64) -> S,
    event: impl Fn(&mut C, f64, f64) -> Option<T>,
) -> Found<T> {
    let (mut from, mut h) = (from, search.first);
    for _ in 0..MOST_STRETCHES {
        if from >= end {
            break;
        }
        let to = (from + h).min(end);
        h = to - from;
        let shown = show(course, from, to).into();
        if shown == Shown::Free {
            from = to;
            h *= 2.0;
        } else if let (Shown::Until(free), true) = (shown, h > search.shortest) {
            from = free.clamp(from, to);
            h *= 0.5;
        } else if shown == Shown::Nothing && h > search.shortest {
            h *= 0.5;
        } else if let Some(found) = event(course, from, to) {
            return Found {
                free_to: from,
                event: Some(found),
            };
        } else if h > search.shortest {
            h *= 0.5;
        } else {
            from = to;
        }
    }
    Found {
        free_to: from.min(end),
        event: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{Interval, Scalar};

    fn wave<S: Scalar>(t: S) -> S {
        (t.scale(50.0)).sin() + S::constant(1.0 - 1e-6)
    }

    #[test]
    fn a_wave_that_dips_below_zero_by_a_millionth_is_found_and_one_that_does_not_is_shown() {
        let search = Search {
            first: 1.0,
            shortest: 1e-9,
        };
        let find = |above: f64, end: f64| {
            let free = |_: &mut (), a: f64, b: f64| {
                (wave(Interval::between(a, b)) + Interval::constant(above)).lo > 0.0
            };
            let event = |_: &mut (), a: f64, b: f64| (wave(b) + above < 0.0).then_some((a, b));
            first(&mut (), (0.0, end), search, free, event)
        };
        let dips = find(0.0, 1.0);
        let (a, b) = dips.event.expect("it dips");
        let at = (1.5 * std::f64::consts::PI - (1.0f64 - 1e-6).acos().min(1.4142e-3)) / 50.0;
        assert!((a - at).abs() < 1e-4 && b - a <= 1e-9, "{a} {at}");
        let stays = find(2e-6, 1.0);
        assert_eq!((stays.event, stays.free_to), (None, 1.0));
    }

    #[test]
    fn what_takes_too_many_stretches_says_how_far_it_came() {
        let search = Search {
            first: 1.0,
            shortest: 1e-4,
        };
        let found = first(
            &mut (),
            (0.0, 1.0),
            search,
            |(), _, _| false,
            |(), _, _| None::<()>,
        );
        assert!(found.event.is_none());
        assert!(found.free_to > 0.02 && found.free_to < 0.05, "{found:?}");
    }

    #[test]
    fn what_is_free_for_a_part_is_not_looked_at_there_again() {
        let search = Search {
            first: 1.0,
            shortest: 1e-9,
        };
        // falls to zero at 0.7, nowhere faster than by 2: free for half the value
        let looked = std::cell::RefCell::new(Vec::new());
        let show = |_: &mut (), a: f64, _: f64| {
            looked.borrow_mut().push(a);
            Shown::Until(a + 0.5 * (0.7 - a))
        };
        let event = |_: &mut (), a: f64, b: f64| (b > 0.7).then_some((a, b));
        let found = first(&mut (), (0.0, 1.0), search, show, event);
        let (a, b) = found.event.expect("it comes to zero");
        assert!(a <= 0.7 && 0.7 < b && b - a <= 1e-9, "{a} {b}");
        let looked = looked.into_inner();
        assert!(looked.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(looked.len() < 40, "{}", looked.len());
    }
}
