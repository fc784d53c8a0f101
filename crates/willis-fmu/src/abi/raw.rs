//! Reading and writing where a host's pointers lead.

use std::ffi::{CStr, CString, c_char};
use std::path::PathBuf;

use crate::instance::{Fail, error};

/// More values than any host asks for at once.
const MOST: usize = 1 << 26;

fn checked<T>(at: *const T, count: usize, what: &str) -> Result<(), Fail> {
    if at.is_null() || !at.is_aligned() {
        return Err(error(format!("the pointer to {what} leads nowhere")));
    }
    if count > MOST {
        return Err(error(format!("{count} {what} are asked for at once")));
    }
    Ok(())
}

/// What a host wrote.
///
/// # Safety
/// If it is not null, so many values can be read there, and nobody writes them during the call.
pub(super) unsafe fn read<'a, T>(at: *const T, count: usize, what: &str) -> Result<&'a [T], Fail> {
    if count == 0 {
        return Ok(&[]);
    }
    checked(at, count, what)?;
    // SAFETY: not null, aligned, and by the contract of the standard as long as the host says.
    Ok(unsafe { std::slice::from_raw_parts(at, count) })
}

/// Where a host wants values.
///
/// # Safety
/// If it is not null, so many values can be written there, and nobody else reads or writes them during the call.
pub(super) unsafe fn room<'a, T>(at: *mut T, count: usize, what: &str) -> Result<&'a mut [T], Fail> {
    if count == 0 {
        return Ok(&mut []);
    }
    checked(at, count, what)?;
    // SAFETY: not null, aligned, and by the contract of the standard as long as the host says.
    Ok(unsafe { std::slice::from_raw_parts_mut(at, count) })
}

/// Writes one value.
///
/// # Safety
/// If it is not null, a value can be written there.
pub(super) unsafe fn put<T>(at: *mut T, value: T, what: &str) -> Result<(), Fail> {
    checked(at, 1, what)?;
    // SAFETY: not null, aligned, and by the contract of the standard a place for one value.
    unsafe { at.write(value) };
    Ok(())
}

/// A text of a host; none where it gives none.
///
/// # Safety
/// If it is not null, it leads to bytes that end with a zero and stay during the call.
pub(super) unsafe fn text(at: *const c_char) -> Option<String> {
    if at.is_null() {
        return None;
    }
    // SAFETY: not null, and by the contract of the standard closed by a zero.
    Some(unsafe { CStr::from_ptr(at) }.to_string_lossy().into_owned())
}

/// A text for a host.
pub(super) fn closed(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// The folder of the resources, of an address or a path.
pub(super) fn folder(text: &str) -> Result<PathBuf, Fail> {
    let Some(rest) = text.strip_prefix("file:") else { return Ok(PathBuf::from(text)) };
    // file:/a, file:///a, file://host/a
    let path = match rest.strip_prefix(['/']).and_then(|rest| rest.strip_prefix(['/'])) {
        Some(rest) => &rest[rest.find('/').unwrap_or(rest.len())..],
        None => rest,
    };
    let mut bytes = Vec::with_capacity(path.len());
    let all = path.as_bytes();
    let mut k = 0;
    while k < all.len() {
        let hex = |at: usize| all.get(at).and_then(|b| char::from(*b).to_digit(16));
        match (all[k], hex(k + 1), hex(k + 2)) {
            (b'%', Some(high), Some(low)) => {
                bytes.push((16 * high + low) as u8);
                k += 3;
            }
            (byte, ..) => {
                bytes.push(byte);
                k += 1;
            }
        }
    }
    let path =
        String::from_utf8(bytes).map_err(|_| error(format!("the address of the resources, {text}, is no text")))?;
    // file:///C:/a
    let drive = path.as_bytes();
    let path = if cfg!(windows) && drive.get(2) == Some(&b':') { &path[1..] } else { &path[..] };
    Ok(PathBuf::from(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_of_every_spelling() {
        for text in ["file:///a b/c", "file:/a%20b/c", "file://localhost/a%20b/c", "/a b/c"] {
            assert_eq!(folder(text).unwrap(), PathBuf::from("/a b/c"), "{text}");
        }
        assert_eq!(folder("file:///100%").unwrap(), PathBuf::from("/100%"));
    }
}
