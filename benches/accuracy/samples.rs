//! Errors beside their bars, and what is said of many of them.

/// Errors and bars of one run or of many.
#[derive(Clone, Default)]
pub struct Samples {
    /// errors over their bars
    over_bar: Vec<f64>,
    /// bars over their errors
    widths: Vec<f64>,
    /// bars that are not numbers
    unknown: usize,
    /// time of the further run over that of the run, for each run
    costs: Vec<f64>,
}

impl Samples {
    /// Begins with a run whose further run takes a part of its time.
    pub fn of_run(cost: f64) -> Self {
        Samples {
            costs: vec![cost],
            ..Samples::default()
        }
    }

    /// Takes a value, its bar and the exact value, which may be off by `trust`.
    pub fn take(&mut self, value: f64, bar: f64, exact: f64, trust: f64) {
        let error = (value - exact).abs();
        if bar.is_nan() {
            self.unknown += 1;
            return;
        }
        self.over_bar.push((error - trust).max(0.0) / bar);
        // a number has no more digits than it has; what is zero in both has no width
        let least = error.max(f64::EPSILON * exact.abs()).max(trust);
        if least > 0.0 {
            self.widths.push(bar / least);
        }
    }

    pub fn add(&mut self, other: &Samples) {
        self.over_bar.extend(&other.over_bar);
        self.widths.extend(&other.widths);
        self.unknown += other.unknown;
        self.costs.extend(&other.costs);
    }

    pub fn count(&self) -> usize {
        self.over_bar.len() + self.unknown
    }

    /// The share of errors within their bars; a bar that is no number holds nothing.
    pub fn held(&self) -> f64 {
        let held = self.over_bar.iter().filter(|r| **r <= 1.0).count();
        held as f64 / self.count().max(1) as f64
    }

    /// The median of bar over error.
    pub fn width(&self) -> f64 {
        quantile(&self.widths, 0.5)
    }

    /// The part of the bars that would hold 99 % of the errors.
    pub fn needed(&self) -> f64 {
        quantile(&self.over_bar, 0.99)
    }

    /// The time of the further run over that of the run: the median, and what nine in ten stay below.
    pub fn cost(&self) -> [f64; 2] {
        [0.5, 0.9].map(|part| quantile(&self.costs, part))
    }

    /// All of it in a line.
    pub fn line(&self) -> String {
        let [cost, most] = self.cost();
        format!(
            "{:7} samples   held {:.4}   bar/error {:9.1}   99 % need {:6.2} of the bar   {} unknown   cost {cost:.2} to {most:.2}",
            self.count(),
            self.held(),
            self.width(),
            self.needed(),
            self.unknown,
        )
    }
}

/// The value below which a part of the values lie; NaN of none.
fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = (part * sorted.len() as f64) as usize;
    sorted
        .get(at)
        .or(sorted.last())
        .copied()
        .unwrap_or(f64::NAN)
}
