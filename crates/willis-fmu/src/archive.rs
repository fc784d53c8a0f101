//! Files as one archive in the ZIP format (APPNOTE 6.3): the same bytes for the same files, without times or owners.

use miniz_oxide::deflate::compress_to_vec;

/// A file of an archive.
pub(crate) struct Entry {
    /// With folders, `/` between them.
    pub name: String,
    pub bytes: Vec<u8>,
}

/// 1 January 1980, the first day that the format knows.
const NO_DAY: u16 = 0x21;
/// Version of the format that compression takes.
const VERSION: u16 = 20;
/// How thoroughly is compressed, from 0 to 10.
const LEVEL: u8 = 6;
/// UNIX, and a file that all may read and run.
const MADE_BY: u16 = 3 << 8 | VERSION;
const PERMISSIONS: u32 = 0o100_755 << 16;

/// CRC-32 (ISO 3309) of bytes.
fn crc32(bytes: &[u8]) -> u32 {
    let mut table = [0u32; 256];
    for (k, entry) in table.iter_mut().enumerate() {
        *entry = (0..8).fold(k as u32, |x, _| if x & 1 == 1 { x >> 1 ^ 0xedb8_8320 } else { x >> 1 });
    }
    !bytes.iter().fold(!0, |crc, b| crc >> 8 ^ table[(crc as u8 ^ b) as usize])
}

/// The archive; none if it were too large for the format, 4 GiB.
pub(crate) fn zip(entries: &[Entry]) -> Option<Vec<u8>> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for entry in entries {
        let offset = u32::try_from(out.len()).ok()?;
        let packed = compress_to_vec(&entry.bytes, LEVEL);
        let smaller = packed.len() < entry.bytes.len();
        let (method, body) = if smaller { (8u16, &packed) } else { (0, &entry.bytes) };
        let mut common = Vec::new();
        // Names in UTF-8.
        for x in [VERSION, 1 << 11, method, 0, NO_DAY] {
            common.extend(x.to_le_bytes());
        }
        for x in [crc32(&entry.bytes), u32::try_from(body.len()).ok()?, u32::try_from(entry.bytes.len()).ok()?] {
            common.extend(x.to_le_bytes());
        }
        common.extend(u16::try_from(entry.name.len()).ok()?.to_le_bytes());
        common.extend(0u16.to_le_bytes());
        out.extend(b"PK\x03\x04");
        out.extend(&common);
        out.extend(entry.name.as_bytes());
        out.extend(body);
        directory.extend(b"PK\x01\x02");
        directory.extend(MADE_BY.to_le_bytes());
        directory.extend(&common);
        directory.extend([0; 6]);
        directory.extend(PERMISSIONS.to_le_bytes());
        directory.extend(offset.to_le_bytes());
        directory.extend(entry.name.as_bytes());
    }
    let (offset, size) = (u32::try_from(out.len()).ok()?, u32::try_from(directory.len()).ok()?);
    let count = u16::try_from(entries.len()).ok()?.to_le_bytes();
    out.extend(&directory);
    out.extend(b"PK\x05\x06\0\0\0\0");
    out.extend(count);
    out.extend(count);
    out.extend(size.to_le_bytes());
    out.extend(offset.to_le_bytes());
    out.extend([0; 2]);
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check value of the polynomial, as every catalogue of them prints it.
    #[test]
    fn val_crc_of_nine_digits() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }
}
