//! The scene as the 3-D view's script reads it: z up, centred, few bytes.

use exit_finder::AffinePlane;

use super::input::ViewerScene;
use super::number::{digits, flat, nested};

/// Most voxels that the view draws; of more, every second, third and so on.
const MAX_VOXELS: usize = 9_000;

/// The scene as JSON. Coordinates are turned so that the third is the height.
pub(super) fn json(scene: &ViewerScene) -> String {
    let plane = AffinePlane::from_up(scene.up, [0.0; 3]).ok();
    let turn = |point: &[f64; 3]| {
        let Some(plane) = &plane else { return *point };
        let [x, y] = plane.project(*point);
        [x, y, plane.height(*point)]
    };
    let all = |points: &[[f64; 3]]| points.iter().map(turn).collect::<Vec<_>>();
    let kept = all(&scene.kept);
    let digits = digits(spread(&kept));
    let step = scene.free.len().div_ceil(MAX_VOXELS).max(1);
    let free: Vec<[f64; 3]> = scene.free.iter().step_by(step).map(turn).collect();
    let paths = |paths: &[Vec<[f64; 3]>]| {
        nested(
            &paths.iter().map(|path| all(path)).collect::<Vec<_>>(),
            digits,
        )
    };
    let (vertices, triangles) = obstacles(scene, turn);
    let unit = &scene.unit;
    format!(
        "{{\"unit\":\"{unit}\",\"voxel\":{},\"voxelStep\":{step},\"kept\":{},\"removed\":{},\
         \"vertices\":{},\"triangles\":{triangles:?},\"free\":{},\"exits\":{},\"raw\":{},\
         \"paths\":{},\"flown\":{}}}",
        if scene.voxel.is_finite() {
            scene.voxel
        } else {
            0.0
        },
        flat(&kept, digits),
        flat(&all(&scene.removed), digits),
        flat(&vertices, digits),
        flat(&free, digits),
        flat(&all(&scene.exits), digits),
        paths(&scene.raw_paths),
        paths(&scene.paths),
        flat(&all(&scene.flown), digits),
    )
}

/// All hulls as one list of corners and one of corner numbers.
fn obstacles(
    scene: &ViewerScene,
    turn: impl Fn(&[f64; 3]) -> [f64; 3],
) -> (Vec<[f64; 3]>, Vec<usize>) {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for mesh in &scene.obstacles {
        let first = vertices.len();
        vertices.extend(mesh.vertices.iter().map(&turn));
        let known = mesh
            .triangles
            .iter()
            .flatten()
            .filter(|corner| **corner < mesh.vertices.len());
        triangles.extend(known.map(|corner| first + corner));
    }
    (vertices, triangles)
}

fn spread(points: &[[f64; 3]]) -> f64 {
    let values = points.iter().flatten().filter(|x| x.is_finite());
    values.fold(0.0_f64, |largest, x| largest.max(x.abs()))
}
