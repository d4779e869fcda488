//! Reading Parquet files: ours to the bit, and flat tables of numbers that others have written.

use super::super::{Column, Kind, Run, Sequence, malformed, no_row};
use crate::diagnostic::{Diagnostic, counted};
use ::parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use ::parquet::data_type::DataType;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::ParquetMetaData;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use bytes::Bytes;
use serde_json::Value;

/// The first and the last bytes of a file.
const MAGIC: &[u8] = b"PAR1";
/// Bytes that numbers may take in memory, whatever the file has; and for each of its bytes. What a
/// file says of its rows costs it nothing: a few bytes may stand for any number of equal values.
const MOST_EXPANDED: u64 = 1 << 31;
const MOST_EXPANSION: u64 = 64;
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
    // the end of the file tells where its columns are
    let is_cut = bytes.len() < 3 * MAGIC.len() || !bytes.ends_with(MAGIC);
    let mut run = read.map_err(|e| match is_cut {
        true => no_row(
            malformed(0, "its end is cut off, without which no row can be read"),
            0,
        ),
        false => malformed(0, e.to_string()),
    })?;
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
    let groups = metadata.row_groups().iter();
    let n_rows = groups.map(|group| u64::try_from(group.num_rows()).unwrap_or(u64::MAX));
    let n_rows = n_rows.fold(0, u64::saturating_add);
    if expands_too_far(n_rows, schema.columns().len(), bytes.len()) {
        let what = format!(
            "it claims to have {}, too many for its {}",
            counted(n_rows, "row"),
            counted(bytes.len(), "byte")
        );
        return Err(ParquetError::General(what));
    }
    let most = usize::try_from(n_rows).unwrap_or(usize::MAX);
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
            if values.len() > most {
                let what = "a column has more values than the file has rows";
                return Err(ParquetError::General(what.into()));
            }
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

/// Returns whether numbers in so many rows and columns take more memory than a file of so many
/// bytes may ask for.
fn expands_too_far(n_rows: u64, n_columns: usize, n_bytes: usize) -> bool {
    let expanded = n_rows.saturating_mul(8 * n_columns as u64);
    expanded > MOST_EXPANDED.max(MOST_EXPANSION.saturating_mul(n_bytes as u64))
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

#[cfg(test)]
mod tests {
    use super::*;
    use ::parquet::basic::Compression;
    use ::parquet::data_type::{DoubleType, Int64Type};
    use ::parquet::file::properties::WriterProperties;
    use ::parquet::file::writer::SerializedFileWriter;
    use ::parquet::schema::parser::parse_message_type;
    use std::sync::Arc;

    /// A table as others write it: columns that may be null, dictionaries, a compression.
    fn table_of(compression: Compression) -> Vec<u8> {
        let schema = "message m { required double t; optional double x; required int64 n; }";
        let schema = Arc::new(parse_message_type(schema).unwrap());
        let properties = WriterProperties::builder()
            .set_compression(compression)
            .build();
        let mut writer =
            SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties)).unwrap();
        for k in 0..2 {
            let mut group = writer.next_row_group().unwrap();
            let t: Vec<f64> = (0..500).map(|i| 0.1 * f64::from(500 * k + i)).collect();
            let mut column = group.next_column().unwrap().unwrap();
            column
                .typed::<DoubleType>()
                .write_batch(&t, None, None)
                .unwrap();
            column.close().unwrap();
            let levels: Vec<i16> = (0..500).map(|i| i % 2).collect();
            let mut column = group.next_column().unwrap().unwrap();
            column
                .typed::<DoubleType>()
                .write_batch(&[7.5; 250], Some(&levels), None)
                .unwrap();
            column.close().unwrap();
            let mut column = group.next_column().unwrap().unwrap();
            column
                .typed::<Int64Type>()
                .write_batch(&[3; 500], None, None)
                .unwrap();
            column.close().unwrap();
            group.close().unwrap();
        }
        writer.into_inner().unwrap()
    }

    #[test]
    fn tables_are_read_whatever_they_are_compressed_with() {
        let all = [
            Compression::UNCOMPRESSED,
            Compression::SNAPPY,
            Compression::GZIP(Default::default()),
            Compression::ZSTD(Default::default()),
            Compression::LZ4_RAW,
        ];
        for compression in all {
            let run = read(&table_of(compression)).unwrap();
            assert_eq!((run.columns.len(), run.rows()), (3, 1000), "{compression}");
            assert_eq!(run.columns[0].values[999], 0.1 * 999.0);
            assert!(run.columns[1].values[0].is_nan() && run.columns[1].values[1] == 7.5);
            assert_eq!(run.columns[2].values[500], 3.0);
        }
    }

    #[test]
    fn a_damaged_compressed_table_is_an_error_or_a_table_and_never_a_panic() {
        for compression in [Compression::SNAPPY, Compression::ZSTD(Default::default())] {
            let good = table_of(compression);
            for at in 0..good.len() {
                let mut bad = good.clone();
                bad[at] ^= 0x55;
                let _ = read(&bad);
            }
        }
    }

    #[test]
    fn a_file_cannot_ask_for_any_memory() {
        assert!(!expands_too_far(10_000_000, 20, 1000));
        assert!(expands_too_far(u64::MAX, 1, 1000));
        assert!(expands_too_far(1 << 40, 1, 1000));
        assert!(!expands_too_far(1 << 30, 8, 1 << 31));
    }
}
