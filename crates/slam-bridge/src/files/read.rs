//! From a path to a map: the name picks the reader, gzip is recognised by its first bytes.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use super::{MapFileError, folder};
use crate::{Map, ReadError, read_pcd, read_ply, read_xyz};

/// Reads a map from a file (.ply, .pcd, .csv, .xyz, .txt, each also gzip-compressed with .gz) or from
/// a folder (see [`read_map_folder`](crate::read_map_folder), newest map).
///
/// # Errors
/// [`MapFileError`]: always names the path; a map without points is
/// [`ReadError::NoPoints`].
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

/// Opens a file, unpacks it when it is gzip, and hands it to a reader.
pub(super) fn open<T>(
    path: &Path,
    read: impl FnOnce(Box<dyn BufRead>) -> Result<T, ReadError>,
) -> Result<T, MapFileError> {
    let file = File::open(path).map_err(|error| MapFileError::io(path, error))?;
    let mut reader = BufReader::new(file);
    let start = reader
        .fill_buf()
        .map_err(|error| MapFileError::io(path, error))?;
    let content: Box<dyn BufRead> = if start.starts_with(&[0x1f, 0x8b]) {
        Box::new(BufReader::new(MultiGzDecoder::new(reader)))
    } else {
        Box::new(reader)
    };
    read(content).map_err(|source| MapFileError::read(path, source))
}
