//! The tables of the language reference: malformed texts give the stated kind and column.

use cognate::expr::{Profile, ast::Dialect, parse};

#[test]
fn malformed_texts_give_the_stated_kind_and_column() {
    let table = include_str!("data/conformance/errors.tsv");
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split('\t').collect();
        let profile = if cells[3].starts_with("compat limits on") {
            Profile::Ideas
        } else {
            Profile::Adams
        };
        match parse(&cells[0].replace("\\n", "\n"), Dialect::Function, profile) {
            Ok(_) => assert_eq!(cells[1], "domain", "{line}"),
            Err(e) => assert_eq!(
                (e.code, e.column.to_string().as_str()),
                (cells[1], cells[2]),
                "{line}"
            ),
        }
    }
}
