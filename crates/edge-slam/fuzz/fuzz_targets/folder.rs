//! Any bytes in the files of a recorded folder, in both layouts: a sequence or an error, no panic.

#![no_main]

use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

use edge_slam::sequence::ImageSequence;
use libfuzzer_sys::fuzz_target;

/// One folder of each layout for each process, written over every time.
static FOLDERS: LazyLock<[PathBuf; 2]> = LazyLock::new(|| {
    let root = std::env::temp_dir().join(format!("edge-slam-fuzz-{}", std::process::id()));
    let folders = ["tum", "plain"].map(|name| root.join(name));
    fs::create_dir_all(folders[1].join("color")).expect("a folder");
    fs::create_dir_all(folders[1].join("depth")).expect("a folder");
    fs::create_dir_all(&folders[0]).expect("a folder");
    folders
});

fuzz_target!(|data: &[u8]| {
    // The files are separated by a byte that is no UTF-8.
    let mut parts = data.split(|byte| *byte == 0xFF);
    let mut next = || parts.next().unwrap_or_default();
    let (images, depths, camera, times, picture) = (next(), next(), next(), next(), next());
    let [tum, plain] = &*FOLDERS;
    // A file without bytes is left out: most may be absent.
    let write = |path: PathBuf, bytes: &[u8]| {
        let _ = fs::remove_file(&path);
        if !bytes.is_empty() {
            fs::write(path, bytes).expect("a file");
        }
    };
    write(tum.join("rgb.txt"), images);
    write(tum.join("depth.txt"), depths);
    write(tum.join("0.png"), picture);
    write(plain.join("timestamps.txt"), times);
    for name in ["color", "depth"] {
        write(plain.join(name).join("0.png"), picture);
    }
    for folder in [tum, plain] {
        write(folder.join("camera-intrinsics.txt"), camera);
        if let Ok(sequence) = ImageSequence::open(folder) {
            assert!(sequence.times().all(f64::is_finite));
            // A list may name any file; only the first few are opened.
            for index in 0..sequence.len().min(3) {
                let _ = sequence.load(index);
            }
        }
    }
});
