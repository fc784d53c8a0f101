//! The one file that a zip archive (`.rexsz`) is read for.
//!
//! By the directory at the end of the archive (APPNOTE 6.3 of PKWARE, sections 4.3.7, 4.3.12 and 4.3.16): stored and
//! deflated entries with their checksums, no encryption, no archive beyond 4 GiB. What unpacks to more than is allowed is refused before it is
//! unpacked, or where it begins to be more.

use miniz_oxide::inflate::decompress_to_vec_with_limit;

const END: &[u8] = b"PK\x05\x06";
const ENTRY: &[u8] = b"PK\x01\x02";
const LOCAL: &[u8] = b"PK\x03\x04";
/// Entries that are looked at.
const MOST_ENTRIES: usize = 10_000;

/// CRC-32 (ISO 3309) of bytes.
fn crc32(bytes: &[u8]) -> u32 {
    let mut table = [0u32; 256];
    for (k, entry) in table.iter_mut().enumerate() {
        *entry = (0..8).fold(k as u32, |x, _| if x & 1 == 1 { x >> 1 ^ 0xedb8_8320 } else { x >> 1 });
    }
    !bytes.iter().fold(!0, |crc, b| crc >> 8 ^ table[(crc as u8 ^ b) as usize])
}

/// Whether it begins as an archive does.
pub fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(LOCAL) || bytes.starts_with(END)
}

/// The first entry whose name has one of these endings, with its name, at most so many bytes.
///
/// # Errors
/// Why there is none.
pub fn unpack(bytes: &[u8], endings: &[&str], most: usize) -> Result<(String, Vec<u8>), String> {
    const BROKEN: &str = "the zip archive is broken";
    let broken = || BROKEN.to_owned();
    let word = |at: usize, n: usize| -> Option<usize> {
        let part = bytes.get(at..at.checked_add(n)?)?;
        Some(part.iter().rev().fold(0, |sum, b| sum << 8 | usize::from(*b)))
    };
    // The end record is 22 bytes and a comment of up to 65535.
    let first = bytes.len().saturating_sub(22 + 0xffff);
    let end =
        (first..bytes.len().saturating_sub(21)).rev().find(|&k| bytes[k..].starts_with(END)).ok_or_else(broken)?;
    let count = word(end + 10, 2).ok_or_else(broken)?;
    let mut at = word(end + 16, 4).ok_or_else(broken)?;
    for _ in 0..count.min(MOST_ENTRIES) {
        if !bytes.get(at..).is_some_and(|b| b.starts_with(ENTRY)) {
            return Err(broken());
        }
        let field = |offset: usize, n: usize| word(at + offset, n).ok_or_else(broken);
        let (flags, method, packed, whole) = (field(8, 2)?, field(10, 2)?, field(20, 4)?, field(24, 4)?);
        let sum = field(16, 4)?;
        let (name, extra, comment, local) = (field(28, 2)?, field(30, 2)?, field(32, 2)?, field(42, 4)?);
        let name = bytes.get(at + 46..at + 46 + name).ok_or_else(broken)?;
        at += 46 + name.len() + extra + comment;
        let name = String::from_utf8_lossy(name).into_owned();
        let lower = name.to_lowercase();
        if !endings.iter().any(|e| lower.ends_with(e)) {
            continue;
        }
        if flags & 1 != 0 {
            return Err(format!("`{name}` in the zip archive is encrypted"));
        }
        if whole > most {
            return Err(format!("`{name}` in the zip archive is larger than {} MiB", most >> 20));
        }
        if !bytes.get(local..).is_some_and(|b| b.starts_with(LOCAL)) {
            return Err(broken());
        }
        let skip = word(local + 26, 2).zip(word(local + 28, 2)).map(|(n, x)| local + 30 + n + x).ok_or_else(broken)?;
        let data = skip.checked_add(packed).and_then(|to| bytes.get(skip..to)).ok_or_else(broken)?;
        let found = match method {
            0 => data.to_vec(),
            8 => decompress_to_vec_with_limit(data, most)
                .map_err(|_| format!("`{name}` in the zip archive is broken, or larger than {} MiB", most >> 20))?,
            _ => return Err(format!("`{name}` in the zip archive is packed by method {method}; it reads deflate")),
        };
        if found.len() != whole {
            return Err(format!("`{name}` in the zip archive is {} bytes, not {whole} as it says", found.len()));
        }
        if crc32(&found) as usize != sum {
            return Err(format!(
                "`{name}` in the zip archive is damaged: its checksum is not the one that the archive tells; get the file \
                 again"
            ));
        }
        return Ok((name, found));
    }
    Err(format!("the zip archive has no file that ends with {}", endings.join(" or ")))
}
