//! The Arrow C stream interface: a table as one batch, for every program that reads Arrow.
//!
//! Structures and their meaning: <https://arrow.apache.org/docs/format/CDataInterface.html> and
//! <https://arrow.apache.org/docs/format/CStreamInterface.html>. What is handed out owns its memory and is freed by who
//! takes it.
#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr::{null, null_mut};

use pyo3::prelude::*;
use pyo3::types::PyCapsule;

use crate::table::{CellValues, Column, Table};

const NULLABLE: i64 = 2;

#[repr(C)]
struct Schema {
    format: *const c_char,
    name: *const c_char,
    metadata: *const c_char,
    flags: i64,
    n_children: i64,
    children: *mut *mut Schema,
    dictionary: *mut Schema,
    release: Option<unsafe extern "C" fn(*mut Schema)>,
    private_data: *mut c_void,
}

#[repr(C)]
struct Array {
    length: i64,
    null_count: i64,
    offset: i64,
    n_buffers: i64,
    n_children: i64,
    buffers: *mut *const c_void,
    children: *mut *mut Array,
    dictionary: *mut Array,
    release: Option<unsafe extern "C" fn(*mut Array)>,
    private_data: *mut c_void,
}

#[repr(C)]
struct Stream {
    get_schema: Option<unsafe extern "C" fn(*mut Stream, *mut Schema) -> c_int>,
    get_next: Option<unsafe extern "C" fn(*mut Stream, *mut Array) -> c_int>,
    get_last_error: Option<unsafe extern "C" fn(*mut Stream) -> *const c_char>,
    release: Option<unsafe extern "C" fn(*mut Stream)>,
    private_data: *mut c_void,
}

// SAFETY: what it points to is owned by it alone and has no ties to a thread.
unsafe impl Send for Stream {}

/// What a schema points to.
struct OfSchema {
    _texts: [CString; 2],
    _metadata: Vec<u8>,
    children: Vec<*mut Schema>,
}

/// What an array points to.
struct OfArray {
    _memory: Vec<Vec<u64>>,
    _pointers: Vec<*const c_void>,
    children: Vec<*mut Array>,
}

/// What a stream gives: the schema as often as asked, the batch once.
struct OfStream {
    table: Table,
    is_read: bool,
}

fn schema(format: &str, name: &str, unit: &str, children: Vec<Schema>) -> Schema {
    // A name may hold anything that text does, but for what ends a text of C.
    let text = |s: &str| CString::new(s.replace('\0', "")).unwrap_or_default();
    let mut metadata = vec![];
    if !unit.is_empty() {
        metadata.extend(1i32.to_ne_bytes());
        for part in ["unit", unit] {
            metadata.extend((part.len() as i32).to_ne_bytes());
            metadata.extend(part.as_bytes());
        }
    }
    let children: Vec<*mut Schema> = children.into_iter().map(|c| Box::into_raw(Box::new(c))).collect();
    let mut own = Box::new(OfSchema { _texts: [text(format), text(name)], _metadata: metadata, children });
    Schema {
        format: own._texts[0].as_ptr(),
        name: own._texts[1].as_ptr(),
        metadata: if own._metadata.is_empty() { null() } else { own._metadata.as_ptr().cast() },
        flags: if own.children.is_empty() { NULLABLE } else { 0 },
        n_children: own.children.len() as i64,
        children: own.children.as_mut_ptr(),
        dictionary: null_mut(),
        release: Some(release_schema),
        private_data: Box::into_raw(own).cast(),
    }
}

unsafe extern "C" fn release_schema(this: *mut Schema) {
    // SAFETY: called once by who took the structure, as the interface says; `private_data` is what `schema` made.
    unsafe {
        let own = Box::from_raw((*this).private_data.cast::<OfSchema>());
        for child in &own.children {
            let mut child = Box::from_raw(*child);
            if let Some(release) = child.release {
                release(&mut *child);
            }
        }
        (*this).release = None;
    }
}

/// Bytes in memory that is aligned as Arrow wants numbers to be.
fn aligned(bytes: &[u8]) -> Vec<u64> {
    let word = |part: &[u8]| {
        let mut word = [0; 8];
        word[..part.len()].copy_from_slice(part);
        u64::from_ne_bytes(word)
    };
    bytes.chunks(8).map(word).collect()
}

fn bits(all: impl Iterator<Item = bool>) -> Vec<u64> {
    let mut words = vec![];
    for (k, bit) in all.enumerate() {
        if k % 64 == 0 {
            words.push(0u64);
        }
        words[k / 64] |= u64::from(bit) << (k % 64);
    }
    // Bits are counted within bytes.
    words.into_iter().map(|w| u64::from_ne_bytes(w.to_le_bytes())).collect()
}

fn array(length: usize, nulls: usize, memory: Vec<Option<Vec<u64>>>, children: Vec<Array>) -> Array {
    let children: Vec<*mut Array> = children.into_iter().map(|c| Box::into_raw(Box::new(c))).collect();
    let pointers = memory.iter().map(|m| m.as_ref().map_or(null(), |m| m.as_ptr().cast())).collect();
    let memory = memory.into_iter().flatten().collect();
    let mut own = Box::new(OfArray { _memory: memory, _pointers: pointers, children });
    Array {
        length: length as i64,
        null_count: nulls as i64,
        offset: 0,
        n_buffers: own._pointers.len() as i64,
        n_children: own.children.len() as i64,
        buffers: own._pointers.as_mut_ptr(),
        children: own.children.as_mut_ptr(),
        dictionary: null_mut(),
        release: Some(release_array),
        private_data: Box::into_raw(own).cast(),
    }
}

unsafe extern "C" fn release_array(this: *mut Array) {
    // SAFETY: as for a schema. A child that was taken out on its own has been released by then.
    unsafe {
        let own = Box::from_raw((*this).private_data.cast::<OfArray>());
        for child in &own.children {
            let mut child = Box::from_raw(*child);
            if let Some(release) = child.release {
                release(&mut *child);
            }
        }
        (*this).release = None;
    }
}

fn schema_of(column: &Column) -> Schema {
    let format = match column.cells {
        CellValues::Numbers(_) => "g",
        CellValues::Integers(_) => "l",
        // Offsets of 64 bits: no table is too long.
        CellValues::Texts(_) => "U",
        CellValues::Flags(_) => "b",
    };
    schema(format, &column.name, &column.unit, vec![])
}

fn array_of(cells: &CellValues, rows: usize) -> Array {
    fn valid<T>(all: &[Option<T>]) -> (usize, Option<Vec<u64>>) {
        let nulls = all.iter().filter(|x| x.is_none()).count();
        (nulls, (nulls > 0).then(|| bits(all.iter().map(Option::is_some))))
    }
    match cells {
        CellValues::Numbers(all) => {
            let nulls = all.iter().filter(|x| x.is_nan()).count();
            let valid = (nulls > 0).then(|| bits(all.iter().map(|x| !x.is_nan())));
            let values = all.iter().map(|x| x.to_bits()).collect();
            array(rows, nulls, vec![valid, Some(values)], vec![])
        }
        CellValues::Integers(all) => {
            let (nulls, valid) = valid(all);
            let values = all.iter().map(|x| x.unwrap_or(0) as u64).collect();
            array(rows, nulls, vec![valid, Some(values)], vec![])
        }
        CellValues::Flags(all) => {
            let (nulls, valid) = valid(all);
            let values = bits(all.iter().map(|x| x.unwrap_or(false)));
            array(rows, nulls, vec![valid, Some(values)], vec![])
        }
        CellValues::Texts(all) => {
            let (nulls, valid) = valid(all);
            let (mut offsets, mut bytes) = (vec![0u64], vec![]);
            for text in all {
                bytes.extend(text.as_deref().unwrap_or_default().as_bytes());
                offsets.push(bytes.len() as u64);
            }
            array(rows, nulls, vec![valid, Some(offsets), Some(aligned(&bytes))], vec![])
        }
    }
}

unsafe extern "C" fn get_schema(this: *mut Stream, out: *mut Schema) -> c_int {
    // SAFETY: the caller gives room for a schema; `private_data` is what `stream` made.
    unsafe {
        let own = &*(*this).private_data.cast::<OfStream>();
        let columns = own.table.columns.iter().map(schema_of).collect();
        out.write(schema("+s", "", "", columns));
    }
    0
}

unsafe extern "C" fn get_next(this: *mut Stream, out: *mut Array) -> c_int {
    // SAFETY: likewise; an array that is released already says that there is no more.
    unsafe {
        let own = &mut *(*this).private_data.cast::<OfStream>();
        let rows = own.table.rows;
        let columns: &[Column] = if own.is_read { &[] } else { &own.table.columns };
        let mut next = array(rows, 0, vec![None], columns.iter().map(|c| array_of(&c.cells, rows)).collect());
        if own.is_read {
            release_array(&mut next);
        }
        own.is_read = true;
        out.write(next);
    }
    0
}

unsafe extern "C" fn get_last_error(_: *mut Stream) -> *const c_char {
    null()
}

unsafe extern "C" fn release_stream(this: *mut Stream) {
    // SAFETY: as for a schema.
    unsafe {
        drop(Box::from_raw((*this).private_data.cast::<OfStream>()));
        (*this).release = None;
    }
}

/// A capsule with the stream of a table.
pub fn stream<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyCapsule>> {
    let own = Box::new(OfStream { table: table.clone(), is_read: false });
    let stream = Stream {
        get_schema: Some(get_schema),
        get_next: Some(get_next),
        get_last_error: Some(get_last_error),
        release: Some(release_stream),
        private_data: Box::into_raw(own).cast(),
    };
    PyCapsule::new_with_value_and_destructor(py, stream, c"arrow_array_stream", |mut stream: Stream, _| {
        // Who took the stream out left it released.
        if let Some(release) = stream.release {
            // SAFETY: nobody took it.
            unsafe { release(&mut stream) }
        }
    })
}
