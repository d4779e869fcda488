//! Places of elements in a dataset: for each name of a message the statement that it is about.

use super::row::Record;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// The first statement of each element, by its name in capitals; put together at the first
/// question, since most datasets have nothing to be said about.
#[derive(Clone, Debug, Default)]
pub(super) struct Places(OnceLock<BTreeMap<String, usize>>);

impl Places {
    /// Returns the first statement of an element, or of a setting, among the records of a dataset,
    /// which are always the same.
    pub(super) fn statement<'a>(
        &self,
        records: &'a [Option<Record>],
        element: &str,
    ) -> Option<&'a Record> {
        let places = self.0.get_or_init(|| first_of_each(records));
        let at = places.get(&element.to_ascii_uppercase())?;
        records.get(*at)?.as_ref()
    }
}

/// Returns the index of the first record of each name.
fn first_of_each(records: &[Option<Record>]) -> BTreeMap<String, usize> {
    let mut places = BTreeMap::new();
    for (at, record) in records.iter().enumerate() {
        if let Some(record) = record {
            places.entry(record.element()).or_insert(at);
        }
    }
    places
}
