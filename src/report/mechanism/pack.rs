//! Columns of numbers as few bytes: rounded to a quantum, predicted from the numbers before, the
//! differences as variable-length integers.
//!
//! ```text
//! n_k = round(x_k / quantum)
//! d_k = n_k − n_{k−1}                     order 1
//! d_k = n_k − 2 n_{k−1} + n_{k−2}         order 2; numbers before the first are 0
//! ```
//!
//! `d` is folded to a natural number (0, −1, 1, −2 … become 0, 1, 2, 3 …) and written in groups of
//! seven bits, the lowest first, all but the last with the eighth bit set. Of the two orders the
//! shorter one is taken. Values that are not finite repeat the number before; where they are stands
//! beside.

use serde_json::{Value, json};

/// Largest integer that a column is rounded to: sums of four still are exact in a double.
const LARGEST: f64 = (1u64 << 50) as f64;

/// Packed columns, one after the other.
#[derive(Debug, Default)]
pub struct Packed {
    bytes: Vec<u8>,
    /// for each column: offset, quantum, order, gaps
    columns: Vec<Value>,
}

impl Packed {
    /// Adds a column whose values keep an error of half a quantum at most; returns its index.
    pub fn push(&mut self, values: impl Iterator<Item = f64>, quantum: f64) -> usize {
        let values: Vec<f64> = values.collect();
        let largest = values
            .iter()
            .filter(|x| x.is_finite())
            .fold(0.0_f64, |a, x| a.max(x.abs()));
        let least = (largest / LARGEST).max(f64::MIN_POSITIVE);
        let quantum = if quantum > least { quantum } else { least };
        let mut gaps: Vec<[usize; 2]> = Vec::new();
        let mut last = 0;
        let mut numbers = Vec::with_capacity(values.len());
        for (k, x) in values.iter().enumerate() {
            if x.is_finite() {
                last = (x / quantum).round() as i64;
            } else if let Some(gap) = gaps.last_mut().filter(|gap| gap[1] == k) {
                gap[1] = k + 1;
            } else {
                gaps.push([k, k + 1]);
            }
            numbers.push(last);
        }
        let [first, second] = [1, 2].map(|order| differences(&numbers, order));
        let (order, bytes) = if second.len() < first.len() {
            (2, second)
        } else {
            (1, first)
        };
        let mut column = json!([self.bytes.len(), quantum, order]);
        if let Some(list) = column.as_array_mut().filter(|_| !gaps.is_empty()) {
            list.push(json!(gaps));
        }
        self.columns.push(column);
        self.bytes.extend(bytes);
        self.columns.len() - 1
    }

    /// Returns the number of bytes so far.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Returns the descriptions of the columns, and their bytes.
    pub fn finish(self) -> (Vec<Value>, Vec<u8>) {
        (self.columns, self.bytes)
    }
}

/// Returns the bytes of the differences of an order.
fn differences(numbers: &[i64], order: usize) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(2 * numbers.len());
    let (mut before, mut slope) = (0, 0);
    for &n in numbers {
        let difference = n - before - slope;
        if order == 2 {
            slope = n - before;
        }
        before = n;
        let mut folded = ((difference << 1) ^ (difference >> 63)) as u64;
        while folded >= 0x80 {
            bytes.push(folded as u8 | 0x80);
            folded >>= 7;
        }
        bytes.push(folded as u8);
    }
    bytes
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Reads a column back, as the page does.
    pub(in super::super) fn read(column: &Value, bytes: &[u8], n: usize) -> Vec<f64> {
        let mut at = column[0].as_u64().unwrap() as usize;
        let (quantum, order) = (column[1].as_f64().unwrap(), column[2].as_u64().unwrap());
        let (mut before, mut slope) = (0.0, 0.0);
        (0..n)
            .map(|_| {
                let (mut folded, mut factor) = (0.0, 1.0);
                loop {
                    folded += f64::from(bytes[at] & 127) * factor;
                    factor *= 128.0;
                    at += 1;
                    if bytes[at - 1] < 128 {
                        break;
                    }
                }
                let half = (folded / 2.0_f64).floor();
                let difference = if folded % 2.0 == 0.0 {
                    half
                } else {
                    -half - 1.0
                };
                let now = before + slope + difference;
                if order == 2 {
                    slope = now - before;
                }
                before = now;
                now * quantum
            })
            .collect()
    }

    #[test]
    fn columns_come_back_within_half_a_quantum() {
        let n = 500;
        let smooth = |k: usize| (k as f64 * 0.01).sin() * 1e3;
        let rough = |k: usize| ((k * 7919) % 1000) as f64 - 500.0;
        let far = |k: usize| 1e9 + k as f64 * 1e-3;
        let mut packed = Packed::default();
        let all: [&dyn Fn(usize) -> f64; 3] = [&smooth, &rough, &far];
        let quanta = [1e-4, 1e-3, 1e-5];
        for (f, quantum) in all.iter().zip(quanta) {
            packed.push((0..n).map(f), quantum);
        }
        let (columns, bytes) = packed.finish();
        for ((f, quantum), column) in all.iter().zip(quanta).zip(&columns) {
            let largest = column[1].as_f64().unwrap().max(quantum);
            for (k, x) in read(column, &bytes, n).into_iter().enumerate() {
                assert!((x - f(k)).abs() <= 0.51 * largest, "{k}: {x} {}", f(k));
            }
        }
    }

    #[test]
    fn a_smooth_column_takes_little_more_than_a_byte_a_value() {
        let mut packed = Packed::default();
        packed.push((0..10_000).map(|k| (f64::from(k) * 1e-3).sin()), 1e-5);
        assert!(packed.len() < 11_000, "{}", packed.len());
    }

    #[test]
    fn gaps_are_told() {
        let mut packed = Packed::default();
        packed.push(
            [1.0, f64::NAN, f64::NAN, 2.0, f64::INFINITY].into_iter(),
            0.5,
        );
        let (columns, _) = packed.finish();
        assert_eq!(columns[0][3], json!([[1, 3], [4, 5]]));
    }
}
