//! Sorting of what is sorted seldom: places are sorted, by one function for all types.
//!
//! A sort of the standard library is compiled for each type and each order anew, 6 kB of machine
//! code. Here these supply a comparison and a swap alone. The order is the same: equal ones stay in
//! the order that they have.

use std::cmp::Ordering;

/// Lists that are put in order.
pub(crate) trait Arrange<T> {
    /// Sorts as [`slice::sort_by`].
    fn arrange_by(&mut self, compare: impl FnMut(&T, &T) -> Ordering);

    /// Sorts as [`slice::sort`].
    #[cfg(feature = "solver")]
    fn arrange(&mut self)
    where
        T: Ord,
    {
        self.arrange_by(T::cmp);
    }

    /// Sorts as [`slice::sort_by_key`].
    fn arrange_by_key<K: Ord>(&mut self, mut key: impl FnMut(&T) -> K) {
        self.arrange_by(|a, b| key(a).cmp(&key(b)));
    }
}

impl<T> Arrange<T> for [T] {
    fn arrange_by(&mut self, mut compare: impl FnMut(&T, &T) -> Ordering) {
        let mut order = in_order(self.len(), &mut |a, b| compare(&self[a], &self[b]));
        exchange(&mut order, &mut |a, b| self.swap(a, b));
    }
}

/// Returns the places of things in their order.
fn in_order(n: usize, compare: &mut dyn FnMut(usize, usize) -> Ordering) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| compare(a, b));
    order
}

/// Brings to each place what belongs there, by swaps: `order` says from where.
fn exchange(order: &mut [usize], swap: &mut dyn FnMut(usize, usize)) {
    for first in 0..order.len() {
        let mut place = first;
        while order[place] != first {
            let from = order[place];
            swap(place, from);
            order[place] = place;
            place = from;
        }
        order[place] = place;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_arranged_is_sorted_and_equal_ones_stay_in_order() {
        let mut x = 1_u32;
        for n in 0..200 {
            let list: Vec<(u32, usize)> = (0..n)
                .map(|k| {
                    x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    (x >> 28, k)
                })
                .collect();
            let (mut want, mut got) = (list.clone(), list);
            want.sort_by_key(|e| e.0);
            got.arrange_by_key(|e| e.0);
            assert_eq!(got, want);
            want.sort_by(|a, b| b.cmp(a));
            got.arrange_by(|a, b| b.cmp(a));
            assert_eq!(got, want);
        }
    }
}
