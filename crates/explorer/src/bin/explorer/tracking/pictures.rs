//! Pictures of one frame: features, edges and L-junctions, each as a PNG over the grey image, and its depth.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use edge_slam::depth::DepthImage;
use edge_slam::edge::{
    CannyConfig, EdgeChain, JunctionConfig, LJunction, canny, find_junctions, trace_chains,
};
use edge_slam::feature::{Keypoint, OrbExtractor};
use edge_slam::image::GrayView;
use edge_slam::odometry::OdometryConfig;
use resvg::tiny_skia::{Color, Paint, PathBuilder, Pixmap, Stroke, Transform};

use super::caption::Caption;
use super::depth_picture::depth_picture;
use crate::failure::Failure;

/// Picture pixels for one of the image.
pub(super) const ZOOM: f32 = 2.0;
/// Shortest chain that is drawn, pixels.
const SHORTEST_CHAIN: usize = 20;

/// A frame's place in its sequence.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrameName {
    /// Counted from 0.
    pub(crate) index: usize,
    pub(crate) count: usize,
    /// Seconds.
    pub(crate) time: f64,
}

impl FrameName {
    fn text(&self) -> String {
        let (number, count) = (self.index + 1, self.count);
        format!("frame {number} of {count}, at {:.3} s", self.time)
    }
}

/// Draws features.png, edges.png, junctions.png and, where there is depth, depth.png; without depth an older depth.png goes.
pub(crate) fn draw_frame(
    folder: &Path,
    image: &GrayView<'_>,
    depth: Option<&DepthImage>,
    name: &FrameName,
) -> Result<Vec<&'static str>, Failure> {
    let frame = name.text();
    // Those that tracking uses.
    let features = OrbExtractor::new(OdometryConfig::default().orb)
        .map_err(Failure::internal)?
        .extract(image);
    let edges = canny(image, &CannyConfig::default()).map_err(Failure::internal)?;
    let chains = trace_chains(&edges, SHORTEST_CHAIN);
    let junctions = find_junctions(&edges, &chains, depth, &JunctionConfig::default());
    let mut pictures = vec![
        (
            "features.png",
            features_over(image, &features.keypoints, &frame)?,
        ),
        ("edges.png", edges_over(image, &chains, &frame)?),
        ("junctions.png", junctions_over(image, &junctions, &frame)?),
    ];
    match depth {
        Some(depth) => pictures.push(("depth.png", depth_picture(depth, &frame)?)),
        None => remove_old(&folder.join("depth.png"))?,
    }
    let mut names = Vec::new();
    for (name, picture) in pictures {
        let path = folder.join(name);
        let bytes = picture.encode_png().map_err(Failure::internal)?;
        fs::write(&path, bytes).map_err(|error| Failure::write(&path, &error))?;
        names.push(name);
    }
    Ok(names)
}

/// Removes what an earlier run wrote and this one does not: it would be taken for this one's.
pub(crate) fn remove_old(path: &Path) -> Result<(), Failure> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(Failure::write(path, &error)),
        _ => Ok(()),
    }
}

/// Circles as large as the patch, with the direction, coloured by level.
fn features_over(
    image: &GrayView<'_>,
    keypoints: &[Keypoint],
    frame: &str,
) -> Result<Pixmap, Failure> {
    let mut picture = ground(image, 1.0)?;
    for keypoint in keypoints {
        let radius = 4.0 * 1.2_f32.powi(i32::from(keypoint.octave));
        let (sin, cos) = keypoint.angle.sin_cos();
        let (x, y) = (keypoint.x, keypoint.y);
        let mut path = PathBuilder::new();
        path.push_circle(x, y, radius);
        path.move_to(x, y);
        path.line_to(x + radius * cos, y + radius * sin);
        stroke(&mut picture, path, level_color(keypoint.octave), 0.6);
    }
    let level = |octave: u8| (level_color(octave), format!("{octave}"));
    let caption = Caption {
        colors: (0..LEVELS).map(level).collect(),
        lines: vec![
            "colour: pyramid level; radius grows with it; stroke: direction".to_owned(),
            format!("{} ORB features; {frame}", keypoints.len()),
        ],
    };
    caption.under(&picture)
}

/// Pyramid levels of the default extractor.
const LEVELS: u8 = 8;

fn level_color(octave: u8) -> Color {
    hue(f32::from(octave) / f32::from(LEVELS))
}

/// Chains, neighbours in different colours.
fn edges_over(image: &GrayView<'_>, chains: &[EdgeChain], frame: &str) -> Result<Pixmap, Failure> {
    let mut picture = ground(image, 0.45)?;
    for (index, chain) in chains.iter().enumerate() {
        let mut path = PathBuilder::new();
        for (k, point) in chain.points.iter().enumerate() {
            let (x, y) = (point.x as f32, point.y as f32);
            if k == 0 {
                path.move_to(x, y);
            } else {
                path.line_to(x, y);
            }
        }
        // The golden ratio spreads the hues.
        stroke(&mut picture, path, hue(index as f32 * 0.618_034), 0.9);
    }
    let caption = Caption {
        lines: vec![
            "colours only tell neighbouring chains apart".to_owned(),
            format!(
                "{} chains of {SHORTEST_CHAIN} pixels or more; {frame}",
                chains.len()
            ),
        ],
        ..Caption::default()
    };
    caption.under(&picture)
}

/// Of an L-junction's arms and vertex.
const ARM: (u8, u8, u8) = (255, 196, 0);
const VERTEX: (u8, u8, u8) = (235, 40, 50);

fn junctions_over(
    image: &GrayView<'_>,
    junctions: &[LJunction],
    frame: &str,
) -> Result<Pixmap, Failure> {
    let [arm_color, vertex_color] = [ARM, VERTEX].map(|(r, g, b)| Color::from_rgba8(r, g, b, 255));
    let mut picture = ground(image, 0.7)?;
    for junction in junctions {
        let [x, y] = junction.vertex.map(|value| value as f32);
        let mut arms = PathBuilder::new();
        for arm in 0..2 {
            let [dx, dy] = junction.directions[arm].map(|value| value as f32);
            let length = junction.lengths[arm] as f32;
            arms.move_to(x, y);
            arms.line_to(x + dx * length, y + dy * length);
        }
        stroke(&mut picture, arms, arm_color, 1.4);
        let mut vertex = PathBuilder::new();
        vertex.push_circle(x, y, 3.0);
        stroke(&mut picture, vertex, vertex_color, 1.4);
    }
    let caption = Caption {
        colors: vec![
            (arm_color, "arm, as long as it is supported".to_owned()),
            (vertex_color, "vertex".to_owned()),
        ],
        lines: vec![format!("{} L-junctions; {frame}", junctions.len())],
    };
    caption.under(&picture)
}

/// The image, darkened by a factor so that what is drawn over it stands out.
fn ground(image: &GrayView<'_>, brightness: f32) -> Result<Pixmap, Failure> {
    paint(image.width(), image.height(), |x, y| {
        Some([(f32::from(image.get(x, y)?) * brightness) as u8; 3])
    })
}

/// A picture of so many image pixels; black where there is no colour.
pub(super) fn paint(
    width: usize,
    height: usize,
    color: impl Fn(usize, usize) -> Option<[u8; 3]>,
) -> Result<Pixmap, Failure> {
    let zoom = ZOOM as usize;
    let side = |length: usize| u32::try_from(length * zoom).unwrap_or(u32::MAX);
    let mut picture = Pixmap::new(side(width), side(height))
        .ok_or_else(|| Failure::internal(format!("{width} x {height} is no picture size")))?;
    for (index, pixel) in picture.data_mut().chunks_exact_mut(4).enumerate() {
        let (x, y) = (index % (width * zoom) / zoom, index / (width * zoom) / zoom);
        let [red, green, blue] = color(x, y).unwrap_or_default();
        pixel.copy_from_slice(&[red, green, blue, 255]);
    }
    Ok(picture)
}

fn stroke(picture: &mut Pixmap, path: PathBuilder, color: Color, width: f32) {
    let Some(path) = path.finish() else { return };
    let mut paint = Paint::default();
    paint.set_color(color);
    paint.anti_alias = true;
    let stroke = Stroke {
        width,
        ..Stroke::default()
    };
    // A pixel's centre lies half a pixel from its corner.
    let transform = Transform::from_scale(ZOOM, ZOOM).pre_translate(0.5, 0.5);
    picture.stroke_path(&path, &paint, &stroke, transform, None);
}

/// A full colour of the circle; whole numbers are red.
pub(super) fn hue(turn: f32) -> Color {
    let channel = |shift: f32| {
        let distance = ((turn + shift).rem_euclid(1.0) * 6.0 - 3.0).abs() - 1.0;
        distance.clamp(0.0, 1.0)
    };
    let [red, green, blue] = [channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)];
    Color::from_rgba(red, green, blue, 1.0).unwrap_or(Color::WHITE)
}
