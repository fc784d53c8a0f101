//! Rows of a sweep as Parquet, and pieces of a table put together without reading their values.

use std::borrow::Cow;
use std::fs::File;
use std::io::BufWriter;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::writer::ColumnCloseResult;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesPtr};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnPath, Type, TypePtr};
use willis::study::{ColumnValues, Rows, SweepColumn};

use super::piece::Piece;
use crate::input;

/// Rows as a piece of the table.
pub fn encode(columns: &[SweepColumn], rows: &Rows) -> Result<Vec<u8>, String> {
    encoded(columns, rows).map_err(words)
}

/// Puts pieces together into a table; `told` of the sweep goes into its metadata.
pub fn join(columns: &[SweepColumn], told: &str, pieces: &[Piece], out: File) -> Result<(), String> {
    joined(columns, told, pieces, out).map_err(words)
}

fn schema(columns: &[SweepColumn]) -> Result<TypePtr, ParquetError> {
    let field = |c: &SweepColumn| {
        let physical = if c.is_text { Physical::BYTE_ARRAY } else { Physical::DOUBLE };
        let mut field = Type::primitive_type_builder(&c.name, physical);
        if c.is_text {
            field = field.with_logical_type(Some(LogicalType::String));
        }
        let repetition = if c.is_text { Repetition::REQUIRED } else { Repetition::OPTIONAL };
        field.with_repetition(repetition).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    Ok(Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?))
}

fn properties(columns: &[SweepColumn]) -> WriterPropertiesPtr {
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        // Pieces are joined column by column; indices of pages would be lost.
        .set_offset_index_disabled(true)
        .set_created_by(concat!("willis ", env!("CARGO_PKG_VERSION")).to_owned());
    // Texts have a dictionary, which says more than the first and the last of them, and those are looked for row by row.
    for c in columns.iter().filter(|c| c.is_text) {
        properties =
            properties.set_column_statistics_enabled(ColumnPath::new(vec![c.name.clone()]), EnabledStatistics::None);
    }
    Arc::new(properties.build())
}

fn encoded(columns: &[SweepColumn], rows: &Rows) -> Result<Vec<u8>, ParquetError> {
    let mut writer = SerializedFileWriter::new(Vec::new(), schema(columns)?, properties(columns))?;
    let mut group = writer.next_row_group()?;
    for cells in &rows.columns {
        let mut out = group.next_column()?.expect("as many as in the schema");
        match cells {
            ColumnValues::Numbers(all) => {
                let typed = out.typed::<DoubleType>();
                let levels: Vec<i16> = all.iter().map(|v| i16::from(!v.is_nan())).collect();
                if levels.contains(&0) {
                    let defined: Vec<f64> = all.iter().copied().filter(|v| !v.is_nan()).collect();
                    typed.write_batch(&defined, Some(&levels), None)?;
                } else {
                    typed.write_batch(all, Some(&levels), None)?;
                }
            }
            ColumnValues::Integers(_) => unreachable!("no column of a sweep counts"),
            ColumnValues::Texts(all) => {
                let bytes = |t: &Cow<'static, str>| match t {
                    Cow::Borrowed(t) => ByteArray::from(*t),
                    Cow::Owned(t) => ByteArray::from(t.as_str()),
                };
                // Neighbours are mostly alike: one buffer for all of them.
                let mut last: Option<(&str, ByteArray)> = None;
                let values: Vec<ByteArray> = (all.iter())
                    .map(|t| match &last {
                        Some((text, bytes)) if text == t => bytes.clone(),
                        _ => {
                            let made = bytes(t);
                            last = Some((t, made.clone()));
                            made
                        }
                    })
                    .collect();
                out.typed::<ByteArrayType>().write_batch(&values, None, None)?;
            }
        }
        out.close()?;
    }
    group.close()?;
    writer.into_inner()
}

fn joined(columns: &[SweepColumn], told: &str, pieces: &[Piece], out: File) -> Result<(), ParquetError> {
    let mut writer =
        SerializedFileWriter::new(BufWriter::with_capacity(1 << 20, out), schema(columns)?, properties(columns))?;
    for piece in pieces {
        let file = input::regular(&piece.path)?;
        let reader = SerializedFileReader::new(file.try_clone()?)?;
        for group in reader.metadata().row_groups() {
            let mut own = writer.next_row_group()?;
            for column in group.columns() {
                let close = ColumnCloseResult {
                    bytes_written: column.compressed_size() as u64,
                    rows_written: group.num_rows() as u64,
                    metadata: column.clone(),
                    bloom_filter: None,
                    column_index: None,
                    offset_index: None,
                };
                own.append_column(&file, close)?;
            }
            own.close()?;
        }
    }
    writer.append_key_value_metadata(KeyValue::new("willis.sweep".to_owned(), told.to_owned()));
    let out = writer.into_inner()?;
    out.into_inner().map_err(|e| ParquetError::External(Box::new(e.into_error())))?;
    Ok(())
}

fn words(e: ParquetError) -> String {
    match e {
        ParquetError::External(e) => e.to_string(),
        other => other.to_string(),
    }
}
