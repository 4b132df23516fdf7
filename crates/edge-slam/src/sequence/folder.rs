//! A recorded sequence in a folder, in either of two layouts.
//!
//! ```text
//! TUM    rgb.txt, depth.txt (optional): "timestamp filename" lines; depth 5000 units per metre
//! plain  color/ (or image/, rgb/, gray/, or the images by themselves), depth/ (optional): files in the order in which their names count (2 before 10),
//!        paired by name; times from timestamps.txt (one line for each image) or 1/30 s apart; depth 1000 units per metre
//! both   camera-intrinsics.txt (optional): the 3x3 matrix K; without it a TUM folder has the benchmark's camera
//! ```

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::bounded::{MOST_LIST_BYTES, MOST_PICTURE_BYTES, read_at_most};
use super::calibration::{read_intrinsics, tum_camera};
use super::listing::{Entry, pair, parse_list, parse_times};
use super::order::sort_as_counted;
use super::{DecodeError, SequenceError, decode_depth, decode_gray};
use crate::camera::Camera;
use crate::depth::DepthImage;
use crate::image::GrayImage;

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
        let path = || folder.to_owned();
        match fs::metadata(folder) {
            Err(source) => {
                let path = path();
                return Err(SequenceError::File { path, source });
            }
            Ok(found) if !found.is_dir() => {
                return Err(SequenceError::NotASequence { path: path() });
            }
            Ok(_) => {}
        }
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

    /// The same sequence without its depth images: they are then neither read nor checked.
    #[must_use]
    pub fn without_depth(mut self) -> Self {
        self.frames.iter_mut().for_each(|frame| frame.depth = None);
        self
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
    /// [`SequenceError`] when its files cannot be read or decoded, or are not of one size.
    pub fn load(&self, index: usize) -> Result<Option<LoadedFrame>, SequenceError> {
        let Some(files) = self.frames.get(index) else {
            return Ok(None);
        };
        let image = decode_gray(&read(&files.image)?).map_err(undecodable(&files.image))?;
        let depth = match &files.depth {
            None => None,
            Some(path) => Some(self.load_depth(path, [image.width(), image.height()])?),
        };
        Ok(Some(LoadedFrame {
            time: files.time,
            image,
            depth,
        }))
    }

    /// The depth image of an image of this size.
    fn load_depth(&self, path: &Path, image: [usize; 2]) -> Result<DepthImage, SequenceError> {
        let found = decode_depth(&read(path)?, self.depth_units_per_metre);
        let found = found.map_err(undecodable(path))?;
        let depth = [found.width(), found.height()];
        if depth == image {
            return Ok(found);
        }
        Err(SequenceError::DepthSize {
            path: path.to_owned(),
            depth,
            image,
        })
    }
}

fn undecodable(path: &Path) -> impl Fn(DecodeError) -> SequenceError {
    move |source| SequenceError::Image {
        path: path.to_owned(),
        source,
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
        .map(|name| folder.join(name))
        .iter()
        .map(PathBuf::as_path)
        .chain([folder])
        .map(image_files)
        .find(|files| !files.is_empty());
    let images = images.ok_or_else(|| SequenceError::NotASequence {
        path: folder.to_owned(),
    })?;
    let times = read_times(folder)?;
    if let Some(times) = times.as_ref().filter(|times| times.len() != images.len()) {
        return Err(SequenceError::Times {
            times: times.len(),
            images: images.len(),
        });
    }
    let times = times.unwrap_or_default();
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
    sort_as_counted(&mut files);
    files
}

fn read_times(folder: &Path) -> Result<Option<Vec<f64>>, SequenceError> {
    let text = optional_text(folder, "timestamps.txt")?;
    text.map(|text| parse_times(&text)).transpose()
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

    fn png(width: u32, height: u32, depth: png::BitDepth) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_depth(depth);
        let size = (width * height) as usize * (depth as usize / 8);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&vec![7; size]).unwrap();
        drop(writer);
        bytes
    }

    #[test]
    fn depth_of_another_size_is_refused_and_can_be_left_out() {
        let place = folder("depth size");
        fs::create_dir(place.join("depth")).unwrap();
        let write = |file: &str, bytes| fs::write(place.join(file), bytes).unwrap();
        write("gray/1.png", png(4, 2, png::BitDepth::Eight));
        write("depth/1.png", png(2, 4, png::BitDepth::Sixteen));
        let sequence = ImageSequence::open(&place).unwrap();
        let error = sequence.load(0).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("1.png is 2 x 4, but its image 4 x 2"),
            "{error}"
        );
        write("depth/1.png", png(4, 2, png::BitDepth::Sixteen));
        assert!(sequence.load(0).unwrap().unwrap().depth.is_some());
        write("depth/1.png", b"no picture".to_vec());
        assert!(sequence.load(0).is_err());
        let alone = sequence.without_depth();
        assert!(!alone.has_depth() && alone.load(0).unwrap().unwrap().depth.is_none());
        fs::remove_dir_all(&place).unwrap();
    }

    #[test]
    fn every_image_has_its_time_or_none_has() {
        let place = folder("times");
        for k in [2, 10] {
            fs::write(place.join(format!("gray/{k}.png")), "not read").unwrap();
        }
        let times = |text: &str| {
            fs::write(place.join("timestamps.txt"), text).unwrap();
            ImageSequence::open(&place).map(|s| s.times().collect::<Vec<_>>())
        };
        assert_eq!(times("# times\n5\n6\n9.5\n").unwrap(), [5.0, 6.0, 9.5]);
        for (text, count) in [("", 0), ("5\n6\n", 2), ("5\n6\n7\n8\n", 4)] {
            let error = times(text).unwrap_err();
            let said = format!("{count} times for 3 images");
            assert!(error.to_string().contains(&said), "{error}");
        }
        fs::remove_file(place.join("timestamps.txt")).unwrap();
        let sequence = ImageSequence::open(&place).unwrap();
        let files: Vec<_> = sequence
            .frames
            .iter()
            .map(|f| f.image.file_stem())
            .collect();
        assert_eq!(files, ["1", "2", "10"].map(|name| Some(name.as_ref())));
        fs::remove_dir_all(&place).unwrap();
    }

    #[test]
    fn images_by_themselves_are_a_sequence_too() {
        let place = folder("by themselves");
        let alone = place.join("gray");
        fs::create_dir(alone.join("depth")).unwrap();
        for file in ["10.jpg", "2.JPEG", "notes.txt", "depth/2.png"] {
            fs::write(alone.join(file), "not read").unwrap();
        }
        let sequence = ImageSequence::open(&alone).unwrap();
        let files: Vec<_> = sequence.frames.iter().map(|f| &f.image).collect();
        let expected = ["1.png", "2.JPEG", "10.jpg"].map(|name| alone.join(name));
        assert_eq!(files, expected.each_ref());
        let with_depth: Vec<_> = sequence.frames.iter().map(|f| f.depth.is_some()).collect();
        assert_eq!(with_depth, [false, true, false]);
        fs::remove_dir_all(&place).unwrap();
    }

    #[test]
    fn what_is_no_folder_is_named() {
        let place = folder("no folder");
        let error = complaint(&place.join("absent"), "absent");
        assert!(matches!(error, SequenceError::File { .. }), "{error:?}");
        let error = complaint(&place.join("gray/1.png"), "1.png");
        assert!(
            matches!(error, SequenceError::NotASequence { .. }),
            "{error:?}"
        );
        fs::remove_dir_all(&place).unwrap();
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
