//! Laws of results that tests and fuzz targets share: reading never panics, and what was read is written and read back alike.

use cognate::results::format::{self, Style};
use cognate::results::{Run, csv, gra, res};

/// Any bytes, taken as a file of each format of results.
pub fn fuzz_results(bytes: &[u8]) {
    for read in [res::read, gra::read, csv::read] {
        match read(bytes) {
            Ok(run) => {
                check(&run);
                comes_back(&run);
            }
            Err(d) => assert!(
                d.line <= 1 + bytes.iter().filter(|&&b| b == b'\n' || b == b'\r').count(),
                "{d}"
            ),
        }
    }
}

/// All columns have one length, and everything that refers to columns or rows refers to some that are there.
fn check(run: &Run) {
    assert!(run.columns.iter().all(|c| c.values.len() == run.rows()));
    assert!(
        run.entities
            .iter()
            .flat_map(|e| &e.components)
            .all(|c| c.column < run.columns.len())
    );
    assert!(
        run.sequences
            .iter()
            .all(|s| s.rows.start <= s.rows.end && s.rows.end <= run.rows())
    );
}

/// Written as `.res` and read again, the numbers are the same to the bit; a `.csv` of any style has as many rows.
fn comes_back(run: &Run) {
    let text = res::write(run);
    let back = res::read(text.as_bytes()).unwrap_or_else(|d| panic!("{d}\n{text}"));
    assert_eq!(run.columns.len(), back.columns.len());
    assert_eq!(run.rows(), back.rows());
    for (a, b) in run.columns.iter().zip(&back.columns) {
        assert!(
            a.values.iter().zip(&b.values).all(|(a, b)| same(*a, *b)),
            "{}",
            a.name
        );
    }
    let rows = |run: &Run| {
        run.sequences
            .iter()
            .map(|s| s.rows.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(rows(run), rows(&back));
    for (units, decimal_comma) in [(true, false), (true, true), (false, false), (false, true)] {
        let style = Style {
            units,
            decimal_comma,
        };
        let text = format::text(&mut csv::Table::new(style), run);
        let table = csv::read(text.as_bytes()).unwrap_or_else(|d| panic!("{d}\n{text}"));
        assert_eq!(table.rows(), run.table_rows().count(), "{text}");
    }
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}
