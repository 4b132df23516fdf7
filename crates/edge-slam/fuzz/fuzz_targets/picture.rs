//! Any bytes as a picture or a depth image, and what was decoded, or else the bytes as grey values, through the front end: no
//! panic, no more pixels than accepted.

#![no_main]

use edge_slam::camera::{Camera, PinholeCamera};
use edge_slam::edge::{CannyConfig, JunctionConfig, canny, find_junctions, trace_chains};
use edge_slam::feature::{OrbConfig, OrbExtractor};
use edge_slam::image::{GrayImage, ImageError};
use edge_slam::odometry::{Odometry, OdometryConfig};
use edge_slam::sequence::{decode_depth, decode_gray};
use libfuzzer_sys::fuzz_target;
use rand_pcg::Pcg64;

/// Decoding takes any size; what follows is only slow on large pictures.
const MOST_PIXELS: usize = 1 << 14;

fuzz_target!(|data: &[u8]| {
    let depth = decode_depth(data, 5000.0).ok();
    let Ok(image) = decode_gray(data).or_else(|_| as_pixels(data)) else {
        return;
    };
    let (width, height) = (image.width(), image.height());
    assert_eq!(image.pixels().len(), width * height);
    if width * height > MOST_PIXELS {
        return;
    }
    let depth = depth.filter(|depth| (depth.width(), depth.height()) == (width, height));
    if let Ok(extractor) = OrbExtractor::new(OrbConfig::default()) {
        let _ = extractor.extract(&image.view());
    }
    if let Ok(edges) = canny(&image.view(), &CannyConfig::default()) {
        let chains = trace_chains(&edges, 3);
        let _ = find_junctions(&edges, &chains, depth.as_ref(), &JunctionConfig::default());
    }
    let camera = PinholeCamera::new(100.0, 100.0, 8.0, 8.0).map(Camera::ideal);
    let odometry = camera.ok().and_then(|camera| Odometry::new(camera, OdometryConfig::default()).ok());
    let Some(mut odometry) = odometry else { return };
    let rng = &mut Pcg64::new(1, 1);
    for time in [0.0, 0.1, 0.2] {
        let frame = edge_slam::Frame { time, image: image.view(), depth: None };
        let _ = odometry.track(&frame, depth.as_ref(), rng);
    }
});

/// The first byte is the width.
fn as_pixels(data: &[u8]) -> Result<GrayImage, ImageError> {
    let (width, pixels) = data.split_first().unwrap_or((&0, &[]));
    let width = usize::from(*width);
    GrayImage::new(pixels.to_vec(), width, pixels.len() / width.max(1))
}
