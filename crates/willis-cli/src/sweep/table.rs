//! Rows as bytes, and pieces of a table put together.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::writer::ColumnCloseResult;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesPtr};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};
use willis::study::{ColumnValues, Rows, SweepColumn};
use willis_ask::table::{field, number};

/// What a table is written as, by the end of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Csv,
    JsonLines,
    Parquet,
}

impl Form {
    /// The form that the end of a name means.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_string_lossy().to_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "jsonl" | "ndjson" => Some(Self::JsonLines),
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::JsonLines => "jsonl",
            Self::Parquet => "parquet",
        }
    }

    /// Rows as a piece of the table.
    pub fn encode(self, columns: &[SweepColumn], rows: &Rows) -> Result<Vec<u8>, String> {
        match self {
            Self::Csv => Ok(csv(rows).into_bytes()),
            Self::JsonLines => Ok(json_lines(columns, rows).into_bytes()),
            Self::Parquet => parquet(columns, rows).map_err(words),
        }
    }

    /// Puts pieces together into a table.
    pub fn join(self, columns: &[SweepColumn], told: &str, pieces: &[PathBuf], out: File) -> Result<(), String> {
        if self == Self::Parquet {
            return join_parquet(columns, told, pieces, out).map_err(words);
        }
        let mut out = BufWriter::with_capacity(1 << 20, out);
        let run = |out: &mut BufWriter<File>| -> std::io::Result<()> {
            if self == Self::Csv {
                let mut header = String::new();
                for (k, column) in columns.iter().enumerate() {
                    header.push_str(if k > 0 { "," } else { "" });
                    field(&mut header, &column.name);
                }
                header.push('\n');
                out.write_all(header.as_bytes())?;
            }
            let mut buffer = vec![0; 1 << 20];
            for piece in pieces {
                let mut from = File::open(piece)?;
                loop {
                    let n = from.read(&mut buffer)?;
                    if n == 0 {
                        break;
                    }
                    out.write_all(&buffer[..n])?;
                }
            }
            out.flush()?;
            out.get_ref().sync_all()
        };
        run(&mut out).map_err(|e| e.to_string())
    }
}

fn csv(rows: &Rows) -> String {
    let n = rows.len();
    let mut out = String::with_capacity(n * rows.columns.len() * 12);
    for i in 0..n {
        for (k, cells) in rows.columns.iter().enumerate() {
            if k > 0 {
                out.push(',');
            }
            match cells {
                ColumnValues::Numbers(all) => number(&mut out, all[i]),
                ColumnValues::Integers(all) => drop(write!(out, "{}", all[i])),
                ColumnValues::Texts(all) => field(&mut out, &all[i]),
            }
        }
        out.push('\n');
    }
    out
}

fn json_lines(columns: &[SweepColumn], rows: &Rows) -> String {
    let keys: Vec<String> = columns.iter().map(|c| serde_json::to_string(&c.name).expect("a text")).collect();
    let n = rows.len();
    let mut out = String::with_capacity(n * rows.columns.len() * 28);
    for i in 0..n {
        for (k, cells) in rows.columns.iter().enumerate() {
            out.push(if k == 0 { '{' } else { ',' });
            out.push_str(&keys[k]);
            out.push(':');
            match cells {
                ColumnValues::Numbers(all) if all[i].is_nan() => out.push_str("null"),
                ColumnValues::Numbers(all) => number(&mut out, all[i]),
                ColumnValues::Integers(all) => drop(write!(out, "{}", all[i])),
                ColumnValues::Texts(all) => out.push_str(&serde_json::to_string(&all[i]).expect("a text")),
            }
        }
        out.push_str("}\n");
    }
    out
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

fn properties() -> WriterPropertiesPtr {
    let properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        // Pieces are joined column by column; indices of pages would be lost.
        .set_offset_index_disabled(true)
        .set_created_by(concat!("willis ", env!("CARGO_PKG_VERSION")).to_owned());
    Arc::new(properties.build())
}

fn parquet(columns: &[SweepColumn], rows: &Rows) -> Result<Vec<u8>, ParquetError> {
    let mut writer = SerializedFileWriter::new(Vec::new(), schema(columns)?, properties())?;
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

fn join_parquet(columns: &[SweepColumn], told: &str, pieces: &[PathBuf], out: File) -> Result<(), ParquetError> {
    let mut writer = SerializedFileWriter::new(BufWriter::with_capacity(1 << 20, out), schema(columns)?, properties())?;
    for piece in pieces {
        let file = File::open(piece)?;
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
    let file = out.into_inner().map_err(|e| ParquetError::External(Box::new(e.into_error())))?;
    file.sync_all()?;
    Ok(())
}

fn words(e: ParquetError) -> String {
    match e {
        ParquetError::External(e) => e.to_string(),
        other => other.to_string(),
    }
}
