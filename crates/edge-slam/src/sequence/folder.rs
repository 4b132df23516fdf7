//! A recorded sequence in a folder, in either of two layouts.
//!
//! ```text
//! TUM    rgb.txt, depth.txt (optional): "timestamp filename" lines; depth 5000 units per metre
//! plain  color/ (or image/, rgb/, gray/), depth/ (optional): files paired by name; times from timestamps.txt (one per line)
//!        or 1/30 s apart; depth 1000 units per metre
//! both   camera-intrinsics.txt (optional): the 3x3 matrix K; without it a TUM folder has the benchmark's camera
//! ```

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::bounded::{MOST_LIST_BYTES, MOST_PICTURE_BYTES, read_at_most};
use super::calibration::{read_intrinsics, tum_camera};
use super::listing::{Entry, pair, parse_list, parse_times};
use super::{DecodeError, decode_depth, decode_gray};
use crate::camera::Camera;
use crate::depth::DepthImage;
use crate::image::GrayImage;

/// Why a sequence cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// A file or folder cannot be read, or is larger than a picture (128 MiB) or a list (64 MiB) may be.
    #[error("{} cannot be read", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// An image cannot be decoded.
    #[error("{} cannot be decoded", path.display())]
    Image {
        /// Which.
        path: PathBuf,
        /// Why.
        source: DecodeError,
    },
    /// A line of a list is not "timestamp filename" (or a timestamp, or three numbers).
    #[error("line {line} of {name} is not understood")]
    Line {
        /// File name.
        name: &'static str,
        /// Counted from 1.
        line: usize,
    },
    /// The folder is no sequence.
    #[error("{} has neither rgb.txt nor a folder color, image, rgb or gray with PNG or JPEG files", path.display())]
    NotASequence {
        /// The folder.
        path: PathBuf,
    },
}

/// A sequence: times and files. Images are read one at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageSequence {
    frames: Vec<FrameFiles>,
    /// The camera that the folder names, or, in the TUM layout, the one that the benchmark publishes for a folder of
    /// this name (`fr1`, `freiburg2`...; its default camera else).
    pub camera: Option<Camera>,
    /// Whether the folder itself names the camera.
    pub names_camera: bool,
    /// Depth readings per metre; set by the layout, change before loading when the recording differs.
    pub depth_units_per_metre: f32,
}

#[derive(Debug, Clone, PartialEq)]
struct FrameFiles {
    time: f64,
    image: PathBuf,
    depth: Option<PathBuf>,
}

/// A frame in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedFrame {
    /// Seconds.
    pub time: f64,
    /// The image.
    pub image: GrayImage,
    /// Its depth, if recorded.
    pub depth: Option<DepthImage>,
}

impl LoadedFrame {
    /// The form that trackers take.
    #[must_use]
    pub fn frame(&self) -> crate::Frame<'_> {
        crate::Frame {
            time: self.time,
            image: self.image.view(),
            depth: self.depth.as_ref(),
        }
    }
}

/// Image and depth stamps of a TUM sequence belong together up to this many seconds apart.
const PAIRING: f64 = 0.02;

impl ImageSequence {
    /// Opens a folder in either layout; reads its lists, no image yet.
    ///
    /// # Errors
    /// [`SequenceError`] for missing files and lines that are not understood.
    pub fn open(folder: &Path) -> Result<Self, SequenceError> {
        let own = read_intrinsics(folder)?;
        let (frames, depth_units_per_metre, published) = match optional_text(folder, "rgb.txt")? {
            Some(list) => (tum_frames(folder, &list)?, 5000.0, tum_camera(folder)),
            None => (plain_frames(folder)?, 1000.0, None),
        };
        Ok(Self {
            frames,
            names_camera: own.is_some(),
            camera: own.or(published),
            depth_units_per_metre,
        })
    }

    /// Number of frames.
    #[must_use]
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// The frames' times in their order, seconds.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.frames.iter().map(|frame| frame.time)
    }

    /// Whether any frame has recorded depth.
    #[must_use]
    pub fn has_depth(&self) -> bool {
        self.frames.iter().any(|frame| frame.depth.is_some())
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Reads and decodes frame `index`; `None` past the end.
    ///
    /// # Errors
    /// [`SequenceError`] when its files cannot be read or decoded.
    pub fn load(&self, index: usize) -> Result<Option<LoadedFrame>, SequenceError> {
        let Some(files) = self.frames.get(index) else {
            return Ok(None);
        };
        let decoded = |path: &Path, source| SequenceError::Image {
            path: path.to_owned(),
            source,
        };
        let image = decode_gray(&read(&files.image)?).map_err(|e| decoded(&files.image, e))?;
        let depth = match &files.depth {
            None => None,
            Some(path) => Some(
                decode_depth(&read(path)?, self.depth_units_per_metre)
                    .map_err(|e| decoded(path, e))?,
            ),
        };
        Ok(Some(LoadedFrame {
            time: files.time,
            image,
            depth,
        }))
    }
}

fn read(path: &Path) -> Result<Vec<u8>, SequenceError> {
    read_at_most(path, MOST_PICTURE_BYTES).map_err(|source| SequenceError::File {
        path: path.to_owned(),
        source,
    })
}

/// The text of a file that may be absent, but not unreadable.
pub(super) fn optional_text(folder: &Path, name: &str) -> Result<Option<String>, SequenceError> {
    let path = folder.join(name);
    let text = read_at_most(&path, MOST_LIST_BYTES).and_then(|bytes| {
        String::from_utf8(bytes).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
    });
    match text {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(SequenceError::File { path, source }),
    }
}

fn tum_frames(folder: &Path, list: &str) -> Result<Vec<FrameFiles>, SequenceError> {
    let images = parse_list(list, "rgb.txt")?;
    let depths = match optional_text(folder, "depth.txt")? {
        Some(list) => parse_list(&list, "depth.txt")?,
        None => Vec::new(),
    };
    let partners = pair(&images, &depths, PAIRING);
    let frame = |(image, partner): (&Entry, Option<usize>)| FrameFiles {
        time: image.time,
        image: folder.join(&image.file),
        depth: partner.map(|k| folder.join(&depths[k].file)),
    };
    Ok(images.iter().zip(partners).map(frame).collect())
}

fn plain_frames(folder: &Path) -> Result<Vec<FrameFiles>, SequenceError> {
    let images = ["color", "image", "rgb", "gray"]
        .iter()
        .map(|name| image_files(&folder.join(name)))
        .find(|files| !files.is_empty());
    let images = images.ok_or_else(|| SequenceError::NotASequence {
        path: folder.to_owned(),
    })?;
    let times = read_times(folder)?;
    let frame = |(index, image): (usize, PathBuf)| {
        let depth = image
            .file_stem()
            .map(|stem| folder.join("depth").join(stem).with_extension("png"));
        #[expect(clippy::cast_precision_loss, reason = "frame numbers are small")]
        let time = times.get(index).copied().unwrap_or(index as f64 / 30.0);
        FrameFiles {
            time,
            image,
            depth: depth.filter(|path| path.is_file()),
        }
    };
    Ok(images.into_iter().enumerate().map(frame).collect())
}

fn image_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let is_image = |path: &PathBuf| {
        let extension = path
            .extension()
            .and_then(|e| e.to_str())
            .map(str::to_ascii_lowercase);
        matches!(extension.as_deref(), Some("png" | "jpg" | "jpeg"))
    };
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(is_image)
        .collect();
    files.sort();
    files
}

fn read_times(folder: &Path) -> Result<Vec<f64>, SequenceError> {
    match optional_text(folder, "timestamps.txt")? {
        Some(text) => parse_times(&text),
        None => Ok(Vec::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of this test's own below the system's one for temporary files.
    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("edge-slam {name} {}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("gray")).unwrap();
        fs::write(folder.join("gray/1.png"), "not read").unwrap();
        folder
    }

    /// What is said of the file, which must be named.
    fn complaint(folder: &Path, file: &str) -> SequenceError {
        let error = ImageSequence::open(folder).unwrap_err();
        let text = error.to_string();
        assert!(text.contains(file), "{text}");
        error
    }

    #[test]
    fn lists_that_are_there_but_unreadable_are_not_taken_for_absent() {
        for file in [
            "depth.txt",
            "timestamps.txt",
            "rgb.txt",
            "camera-intrinsics.txt",
        ] {
            let place = folder(file);
            if file == "depth.txt" {
                fs::write(place.join("rgb.txt"), "1.0 gray/1.png\n").unwrap();
            }
            assert_eq!(ImageSequence::open(&place).unwrap().len(), 1, "{file}");
            fs::write(place.join(file), b"1.0 \xFF\xFE.png\n").unwrap();
            let error = complaint(&place, file);
            assert!(matches!(error, SequenceError::File { .. }), "{error:?}");
            fs::remove_file(place.join(file)).unwrap();
            fs::create_dir(place.join(file)).unwrap();
            let error = complaint(&place, file);
            assert!(matches!(error, SequenceError::File { .. }), "{error:?}");
            fs::remove_dir_all(&place).unwrap();
        }
    }

    #[cfg(unix)]
    #[test]
    fn what_never_ends_is_refused_and_named() {
        let refused = |error: SequenceError, name: &str| match error {
            SequenceError::File { path, source } => {
                assert!(path.ends_with(name), "{path:?}");
                assert_eq!(source.kind(), io::ErrorKind::FileTooLarge);
            }
            other => panic!("{other:?}"),
        };
        for list in ["rgb.txt", "timestamps.txt", "camera-intrinsics.txt"] {
            let place = folder(&format!("endless {list}"));
            std::os::unix::fs::symlink("/dev/zero", place.join(list)).unwrap();
            refused(ImageSequence::open(&place).unwrap_err(), list);
            fs::remove_dir_all(&place).unwrap();
        }
        let place = folder("endless picture");
        let line = "1.0 /dev/zero\n";
        fs::write(place.join("rgb.txt"), line).unwrap();
        let sequence = ImageSequence::open(&place).unwrap();
        refused(sequence.load(0).unwrap_err(), "zero");
        fs::remove_dir_all(&place).unwrap();
    }
}
