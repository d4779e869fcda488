//! Reading Parquet files: ours to the bit, and flat tables of numbers that others have written.

use super::super::{Column, Kind, Run, Sequence, malformed};
use crate::diagnostic::Diagnostic;
use ::parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use ::parquet::data_type::DataType;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::ParquetMetaData;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use bytes::Bytes;
use serde_json::Value;

/// Rows that are decoded at once.
const BATCH: usize = 8192;

/// Reads a Parquet file; columns that hold no numbers are left out, and what is null is NaN.
///
/// # Errors
/// When the contents are not of this format, or there is no column of numbers.
pub fn read(bytes: &[u8]) -> Result<Run, Diagnostic> {
    let damaged = |_| ParquetError::General("the file is damaged".into());
    // the decoders of columns trust the lengths that pages state
    let read = std::panic::catch_unwind(|| table(bytes)).unwrap_or_else(|e| Err(damaged(e)));
    let mut run = read.map_err(|e| malformed(0, e.to_string()))?;
    if run.columns.is_empty() {
        return Err(malformed(0, "there is no column of numbers"));
    }
    if run.sequences.is_empty() {
        let (kind, rows) = (Kind::Dynamic, 0..run.rows());
        let name = format!("{}_001", kind.name());
        run.sequences.push(Sequence { name, kind, rows });
    }
    Ok(run)
}

fn table(bytes: &[u8]) -> Result<Run, ParquetError> {
    let reader = SerializedFileReader::new(Bytes::copy_from_slice(bytes))?;
    let metadata = reader.metadata();
    let schema = metadata.file_metadata().schema_descr();
    let mut run = Run::default();
    for (index, column) in schema.columns().iter().enumerate() {
        if column.max_rep_level() > 0 {
            continue;
        }
        let mut values = Vec::new();
        let mut is_number = true;
        for group in 0..reader.num_row_groups() {
            let group = reader.get_row_group(group)?;
            let chunk = group.get_column_reader(index)?;
            is_number &= push_numbers(chunk, column.max_def_level(), &mut values)?;
        }
        if is_number {
            run.columns.push(Column {
                name: column.path().string(),
                unit: String::new(),
                values,
                bar_of: None,
            });
        }
    }
    tell(&mut run, metadata);
    Ok(run)
}

/// Appends the values of a column; returns false if they are no numbers.
fn push_numbers(
    column: ColumnReader,
    nullable: i16,
    to: &mut Vec<f64>,
) -> Result<bool, ParquetError> {
    match column {
        ColumnReader::DoubleColumnReader(c) => push(c, nullable, to, |&x| x)?,
        ColumnReader::FloatColumnReader(c) => push(c, nullable, to, |&x| f64::from(x))?,
        ColumnReader::Int32ColumnReader(c) => push(c, nullable, to, |&x| f64::from(x))?,
        ColumnReader::Int64ColumnReader(c) => push(c, nullable, to, |&x| x as f64)?,
        ColumnReader::BoolColumnReader(_)
        | ColumnReader::Int96ColumnReader(_)
        | ColumnReader::ByteArrayColumnReader(_)
        | ColumnReader::FixedLenByteArrayColumnReader(_) => return Ok(false),
    }
    Ok(true)
}

fn push<T: DataType>(
    mut column: ColumnReaderImpl<T>,
    nullable: i16,
    to: &mut Vec<f64>,
    number: impl Fn(&T::T) -> f64,
) -> Result<(), ParquetError> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    loop {
        values.clear();
        levels.clear();
        let levels_read = (nullable > 0).then_some(&mut levels);
        let (records, ..) = column.read_records(BATCH, levels_read, None, &mut values)?;
        if records == 0 {
            return Ok(());
        }
        if nullable == 0 {
            to.extend(values.iter().map(&number));
        } else {
            let mut given = values.iter().map(&number);
            let of_level = |&level: &i16| match level == nullable {
                true => given.next().unwrap_or(f64::NAN),
                false => f64::NAN,
            };
            to.extend(levels.iter().map(of_level));
        }
    }
}

/// Takes names, units and sequences from the metadata of a file of ours.
fn tell(run: &mut Run, metadata: &ParquetMetaData) {
    let pairs = metadata.file_metadata().key_value_metadata();
    let find = |key: &str| {
        let pair = pairs.iter().copied().flatten().find(|p| p.key == key);
        pair.and_then(|p| p.value.clone())
    };
    let document = |key: &str| -> Value {
        let text = find(key).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    };
    run.name = find("cognate.name").unwrap_or_default();
    run.title = find("cognate.title").unwrap_or_default();
    let units = document("cognate.units");
    for column in &mut run.columns {
        column.unit = text(&units[&column.name]).unwrap_or_default();
    }
    let system = document("cognate.unit_system");
    let u = &mut run.units;
    for (name, unit) in [
        ("angle", &mut u.angle),
        ("length", &mut u.length),
        ("mass", &mut u.mass),
        ("time", &mut u.time),
        ("force", &mut u.force),
    ] {
        if let Some(given) = text(&system[name]) {
            *unit = given;
        }
    }
    let sequences = document("cognate.sequences");
    run.sequences = (sequences.as_array().into_iter().flatten())
        .filter_map(|s| sequence(s, run.rows()))
        .collect();
}

fn text(value: &Value) -> Option<String> {
    value.as_str().map(str::to_owned)
}

/// Returns a sequence whose rows are there.
fn sequence(value: &Value, rows: usize) -> Option<Sequence> {
    let kind = text(&value["kind"])?;
    let (kind, ..) = *Kind::NAMES.iter().find(|k| k.1 == kind)?;
    let whole = |key: &str| usize::try_from(value[key].as_u64()?).ok();
    let first = whole("first_row")?;
    let end = first.checked_add(whole("rows")?)?;
    (end <= rows).then_some(Sequence {
        name: text(&value["name"])?,
        kind,
        rows: first..end,
    })
}
