//! Rows as Parquet: a column of doubles each, in row groups of bounded size.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use willis::dynamics::{Column, ColumnKind, RunReport};

/// Rows in a group, unless there are many columns.
const ROWS: usize = 65_536;
/// Values in a group: 32 MiB.
const VALUES: usize = 1 << 22;

/// Null where a value is not determined. The file's metadata has `willis.complete`, `willis.ended_s`
/// and, of a run that ended before its scenario, `willis.outcome`.
pub struct Rows<W: Write + Send> {
    out: Option<W>,
    writer: Option<SerializedFileWriter<W>>,
    columns: Vec<Column>,
    /// By column.
    values: Vec<Vec<f64>>,
    room: usize,
}

impl<W: Write + Send> Rows<W> {
    pub fn new(out: W) -> Self {
        Self { out: Some(out), writer: None, columns: vec![], values: vec![], room: ROWS }
    }

    pub fn columns(&mut self, columns: &[Column]) -> Result<(), String> {
        self.room = (VALUES / columns.len().max(1)).clamp(1024, ROWS);
        self.columns = columns.to_vec();
        self.values = vec![vec![]; columns.len()];
        self.start().map_err(words)
    }

    fn start(&mut self) -> Result<(), ParquetError> {
        let field = |c: &Column| {
            let repetition = if c.kind == ColumnKind::Time { Repetition::REQUIRED } else { Repetition::OPTIONAL };
            Type::primitive_type_builder(&c.name, Physical::DOUBLE).with_repetition(repetition).build().map(Arc::new)
        };
        let fields = self.columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
        let schema = Type::group_type_builder("run").with_fields(fields).build()?;
        let properties = WriterProperties::builder()
            .set_compression(Compression::ZSTD(ZstdLevel::default()))
            .set_created_by(concat!("willis ", env!("CARGO_PKG_VERSION")).to_owned())
            .build();
        let out = self.out.take().expect("columns come once");
        self.writer = Some(SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?);
        Ok(())
    }

    pub fn row(&mut self, values: &[f64]) -> Result<(), String> {
        for (column, v) in self.values.iter_mut().zip(values) {
            column.push(*v);
        }
        if self.values[0].len() < self.room {
            return Ok(());
        }
        self.group().map_err(words)
    }

    fn group(&mut self) -> Result<(), ParquetError> {
        let writer = self.writer.as_mut().expect("columns came first");
        let mut group = writer.next_row_group()?;
        let (mut defined, mut levels) = (Vec::new(), Vec::new());
        for (column, values) in self.columns.iter().zip(&mut self.values) {
            let mut out = group.next_column()?.expect("as many as in the schema");
            let typed = out.typed::<DoubleType>();
            if column.kind == ColumnKind::Time {
                typed.write_batch(values, None, None)?;
            } else {
                defined.clear();
                defined.extend(values.iter().copied().filter(|v| !v.is_nan()));
                levels.clear();
                levels.extend(values.iter().map(|v| i16::from(!v.is_nan())));
                typed.write_batch(&defined, Some(&levels), None)?;
            }
            out.close()?;
            values.clear();
        }
        group.close()?;
        Ok(())
    }

    pub fn finish(mut self, report: &RunReport, early: Option<&str>) -> Result<(), String> {
        if self.writer.is_none() {
            return Err("the run had no columns".into());
        }
        if self.values.first().is_some_and(|v| !v.is_empty()) {
            self.group().map_err(words)?;
        }
        let mut writer = self.writer.take().expect("looked at above");
        let columns = serde_json::to_string(&self.columns).expect("plain data");
        let mut tell = |key: &str, value: String| {
            writer.append_key_value_metadata(KeyValue::new(format!("willis.{key}"), value));
        };
        tell("format", report.format.to_string());
        tell("train", report.train.clone());
        tell("scenario", report.scenario.clone());
        tell("columns", columns);
        tell("complete", early.is_none().to_string());
        tell("ended_s", report.end_s.to_string());
        if let Some(why) = early {
            tell("outcome", why.to_owned());
        }
        writer.close().map(drop).map_err(words)
    }
}

fn words(e: ParquetError) -> String {
    match e {
        ParquetError::External(e) => e.to_string(),
        other => other.to_string(),
    }
}
