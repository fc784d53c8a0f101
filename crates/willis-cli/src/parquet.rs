//! A table as Parquet.

use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;
use willis_ask::table::{Cell, Column, Kind, Table};

/// The bytes of a file with one row group; a unit is told in the metadata of the file, under `willis.unit.COLUMN`.
pub fn of(table: &Table) -> Result<Vec<u8>, String> {
    write(table).map_err(|e| format!("{}: {e}\n", table.name))
}

fn write(table: &Table) -> Result<Vec<u8>, ParquetError> {
    let field = |c: &Column| {
        let physical = match c.kind {
            Kind::Text => Physical::BYTE_ARRAY,
            Kind::Number => Physical::DOUBLE,
            Kind::Integer => Physical::INT64,
            Kind::Flag => Physical::BOOLEAN,
        };
        let field = Type::primitive_type_builder(&c.name, physical).with_repetition(Repetition::OPTIONAL);
        let text = (c.kind == Kind::Text).then_some(LogicalType::String);
        field.with_logical_type(text).build().map(Arc::new)
    };
    let fields = table.columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Arc::new(Type::group_type_builder(&table.name).with_fields(fields).build()?);
    let units = table.columns.iter().filter(|c| !c.unit.is_empty());
    let units =
        units.map(|c| parquet::file::metadata::KeyValue::new(format!("willis.unit.{}", c.name), c.unit.clone()));
    let properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .set_key_value_metadata(Some(units.collect()))
        .set_created_by(concat!("willis ", env!("CARGO_PKG_VERSION")).to_owned());
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties.build()))?;
    let mut group = writer.next_row_group()?;
    for (k, column) in table.columns.iter().enumerate() {
        let mut out = group.next_column()?.expect("as many as in the schema");
        cells(&mut out, column.kind, table.rows.iter().map(|row| &row[k]))?;
        out.close()?;
    }
    group.close()?;
    writer.into_inner()
}

fn cells<'a>(
    out: &mut SerializedColumnWriter<'_>,
    kind: Kind,
    all: impl Iterator<Item = &'a Cell> + Clone,
) -> Result<(), ParquetError> {
    // An empty cell is a row without a value.
    let levels: Vec<i16> = all.clone().map(|c| i16::from(*c != Cell::Empty)).collect();
    match kind {
        Kind::Text => {
            let values: Vec<ByteArray> =
                all.filter_map(|c| if let Cell::Text(t) = c { Some(t.as_str().into()) } else { None }).collect();
            out.typed::<ByteArrayType>().write_batch(&values, Some(&levels), None)?;
        }
        Kind::Number => {
            let values: Vec<f64> = all.filter_map(|c| if let Cell::Number(x) = c { Some(*x) } else { None }).collect();
            out.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
        }
        Kind::Integer => {
            let values: Vec<i64> = all.filter_map(|c| if let Cell::Integer(x) = c { Some(*x) } else { None }).collect();
            out.typed::<Int64Type>().write_batch(&values, Some(&levels), None)?;
        }
        Kind::Flag => {
            let values: Vec<bool> = all.filter_map(|c| if let Cell::Flag(x) = c { Some(*x) } else { None }).collect();
            out.typed::<BoolType>().write_batch(&values, Some(&levels), None)?;
        }
    }
    Ok(())
}
