//! Map folders: `map.ply`, `keyframes.csv` and `observations.csv.gz`, or a growing map's `map_N.ply`
//! with `keyframes_N.csv` and `observations_N.csv.gz`.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use flate2::{Compression, write::GzEncoder};

use super::{MapFileError, read::open};
use crate::{
    Map, ReadError, read_keyframes, read_observations, read_ply, write_keyframes,
    write_observations, write_ply,
};

/// Reads a map folder. `version` picks `map_N.ply`; without it, `map.ply` or else the largest N.
///
/// Every file but the map itself may be missing, and may be gzip-compressed with `.gz` at its name's
/// end. Observations by keyframes that the folder does not hold are left out.
///
/// # Errors
/// [`MapFileError`], naming the file at fault.
pub fn read_map_folder(
    folder: impl AsRef<Path>,
    version: Option<u64>,
) -> Result<Map, MapFileError> {
    let folder = folder.as_ref();
    let suffix = match version {
        Some(number) => format!("_{number}"),
        None => newest_suffix(folder)?,
    };
    let find = |stem: &str, extension: &str| {
        let plain = folder.join(format!("{stem}{suffix}.{extension}"));
        let packed = folder.join(format!("{stem}{suffix}.{extension}.gz"));
        [plain, packed].into_iter().find(|path| path.is_file())
    };
    let none = || MapFileError::NoMapInFolder {
        path: folder.into(),
    };
    let path = find("map", "ply").ok_or_else(none)?;
    let mut map = open(&path, read_ply)?;
    if map.points.is_empty() {
        return Err(MapFileError::read(path, ReadError::NoPoints));
    }
    if let Some(path) = find("keyframes", "csv") {
        map.keyframes = open(&path, read_keyframes)?;
    }
    if let Some(path) = find("observations", "csv") {
        open(&path, |reader| read_observations(reader, &mut map))?;
    }
    Ok(map)
}

/// Writes a map folder that [`read_map_folder`] reads back as the same map, making the folder when
/// needed and replacing files of the same names.
///
/// # Errors
/// [`MapFileError::Io`], naming the file.
pub fn write_map_folder(map: &Map, folder: impl AsRef<Path>) -> Result<(), MapFileError> {
    let folder = folder.as_ref();
    fs::create_dir_all(folder).map_err(|error| MapFileError::io(folder, error))?;
    write_file(folder.join("map.ply"), |file| write_ply(map, file))?;
    write_file(folder.join("keyframes.csv"), |file| {
        write_keyframes(&map.keyframes, file)
    })?;
    write_file(folder.join("observations.csv.gz"), |file| {
        let mut packed = GzEncoder::new(file, Compression::default());
        write_observations(map, &mut packed)?;
        packed.finish()?.flush()
    })
}

fn write_file(
    path: PathBuf,
    write: impl FnOnce(BufWriter<File>) -> io::Result<()>,
) -> Result<(), MapFileError> {
    let written = File::create(&path).and_then(|file| write(BufWriter::new(file)));
    written.map_err(|error| MapFileError::io(path, error))
}

/// "" for `map.ply`, else `_N` of the largest N.
fn newest_suffix(folder: &Path) -> Result<String, MapFileError> {
    let entries = fs::read_dir(folder).map_err(|error| MapFileError::io(folder, error))?;
    let mut newest = None;
    for entry in entries {
        let entry = entry.map_err(|error| MapFileError::io(folder, error))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let stem = name
            .strip_suffix(".gz")
            .unwrap_or(&name)
            .strip_suffix(".ply");
        match stem.and_then(|stem| stem.strip_prefix("map")) {
            Some("") => return Ok(String::new()),
            Some(rest) => {
                let number = rest
                    .strip_prefix('_')
                    .and_then(|number| number.parse::<u64>().ok());
                newest = newest.max(number);
            }
            None => {}
        }
    }
    let none = MapFileError::NoMapInFolder {
        path: folder.into(),
    };
    newest.map(|number| format!("_{number}")).ok_or(none)
}
