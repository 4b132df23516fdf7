//! Reading whole files without trusting their size: a list may name a device that never ends.

use std::fs::File;
use std::io::{self, ErrorKind, Read as _};
use std::path::Path;

/// Most bytes of a picture's file: what 2^25 pixels of four bytes take without compression.
pub(super) const MOST_PICTURE_BYTES: u64 = 1 << 27;
/// Most bytes of a list, of times or of a camera: a million lines of a list.
pub(super) const MOST_LIST_BYTES: u64 = 1 << 26;

/// All bytes of a file of at most `most` bytes. What the file system says of its size is not asked: devices say 0.
///
/// # Errors
/// Those of opening and reading; [`ErrorKind::FileTooLarge`] once `most` bytes were read and there are more.
pub fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut part = File::open(path)?.take(most.saturating_add(1));
    part.read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let text = format!("it has more than the {most} bytes that are read");
        return Err(io::Error::new(ErrorKind::FileTooLarge, text));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn the_last_byte_that_fits_is_read_and_one_more_is_refused() {
        let path = std::env::temp_dir().join(format!("edge-slam bounded {}", std::process::id()));
        fs::write(&path, [7; 100]).unwrap();
        assert_eq!(read_at_most(&path, 100).unwrap(), [7; 100]);
        assert_eq!(read_at_most(&path, u64::MAX).unwrap().len(), 100);
        for most in [0, 99] {
            let error = read_at_most(&path, most).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::FileTooLarge);
            assert!(error.to_string().contains(&most.to_string()), "{error}");
        }
        fs::remove_file(&path).unwrap();
        assert_eq!(
            read_at_most(&path, 9).unwrap_err().kind(),
            ErrorKind::NotFound
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_device_that_never_ends_is_refused() {
        let error = read_at_most(Path::new("/dev/zero"), 1 << 16).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::FileTooLarge);
    }
}
