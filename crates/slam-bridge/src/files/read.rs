//! From a path to a map: the name picks the reader, gzip is recognised by its first bytes.

use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use super::bounded::Bounded;
use super::{MapFileError, folder};
use crate::{Map, ReadError, read_pcd, read_ply, read_xyz};

/// Most bytes that are read of a file of a map, unpacked: 2 GiB, some ten million points with their observations as text. What is
/// larger, a small file that unpacks to it included, is [`MapFileError::TooLarge`].
pub const MOST_MAP_BYTES: u64 = 1 << 31;

/// Reads a map from a file (.ply, .pcd, .csv, .xyz, .txt, each also gzip-compressed with .gz) or from
/// a folder (see [`read_map_folder`](crate::read_map_folder), newest map).
///
/// # Errors
/// [`MapFileError`]: always names the path; a map without points is
/// [`ReadError::NoPoints`], a file of more than [`MOST_MAP_BYTES`] [`MapFileError::TooLarge`].
pub fn read_map(path: impl AsRef<Path>) -> Result<Map, MapFileError> {
    let path = path.as_ref();
    let metadata = std::fs::metadata(path).map_err(|error| MapFileError::io(path, error))?;
    if metadata.is_dir() {
        return folder::read_map_folder(path, None);
    }
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
    let map = match extension {
        "ply" => open(path, read_ply)?,
        "pcd" => open(path, read_pcd)?,
        "csv" | "xyz" | "txt" => open(path, read_xyz)?,
        _ => return Err(MapFileError::UnknownExtension { path: path.into() }),
    };
    match map.points.is_empty() {
        true => Err(MapFileError::read(path, ReadError::NoPoints)),
        false => Ok(map),
    }
}

/// Opens a file, unpacks it when it is gzip, and hands it to a reader; [`MOST_MAP_BYTES`] at most.
pub(super) fn open<T>(
    path: &Path,
    read: impl FnOnce(Box<dyn BufRead>) -> Result<T, ReadError>,
) -> Result<T, MapFileError> {
    open_at_most(path, MOST_MAP_BYTES, read)
}

fn open_at_most<T>(
    path: &Path,
    most: u64,
    read: impl FnOnce(Box<dyn BufRead>) -> Result<T, ReadError>,
) -> Result<T, MapFileError> {
    let file = File::open(path).map_err(|error| MapFileError::io(path, error))?;
    let mut reader = BufReader::new(file);
    let start = reader
        .fill_buf()
        .map_err(|error| MapFileError::io(path, error))?;
    let content: Box<dyn BufRead> = if start.starts_with(&[0x1f, 0x8b]) {
        let unpacked = BufReader::new(MultiGzDecoder::new(reader));
        Box::new(Bounded::new(unpacked, most))
    } else {
        Box::new(Bounded::new(reader, most))
    };
    read(content).map_err(|source| match source {
        ReadError::Io(error) if error.kind() == ErrorKind::FileTooLarge => {
            let path = path.into();
            MapFileError::TooLarge { path, most }
        }
        source => MapFileError::read(path, source),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{read_keyframes, read_observations};
    use flate2::{Compression, write::GzEncoder};
    use std::io::Write as _;

    type Reader = fn(Box<dyn BufRead>) -> Result<(), ReadError>;

    const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\n\
                       property float z\nend_header\n";
    const PCD: &str = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 9\nHEIGHT 1\n\
                       POINTS 9\nDATA ascii\n";

    fn packed(content: &[u8]) -> Vec<u8> {
        let mut packed = GzEncoder::new(Vec::new(), Compression::best());
        packed.write_all(content).unwrap();
        packed.finish().unwrap()
    }

    #[test]
    fn no_reader_goes_past_the_limit() {
        let name = format!("slam-bridge bounded {}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let readers: [(&str, Reader); 5] = [
            (PLY, |reader| read_ply(reader).map(drop)),
            (PCD, |reader| read_pcd(reader).map(drop)),
            ("", |reader| read_xyz(reader).map(drop)),
            ("", |reader| read_keyframes(reader).map(drop)),
            ("", |reader| {
                read_observations(reader, &mut Map::default()).map(drop)
            }),
        ];
        for (index, (begin, read)) in readers.into_iter().enumerate() {
            // A line that goes on and on.
            let content = format!("{begin}{:60000}", "");
            for content in [packed(content.as_bytes()), content.into_bytes()] {
                std::fs::write(&path, content).unwrap();
                let result = |most| open_at_most(&path, most, read);
                let is_refused = |most| matches!(result(most), Err(MapFileError::TooLarge { .. }));
                assert!(is_refused(50_000) && !is_refused(200_000), "{index}");
            }
        }
        std::fs::remove_file(&path).unwrap();
    }
}
