//! The table.

use std::io::{self, Write};

use crate::arguments::Arguments;
use crate::map::AlignedMap;
use crate::measure::{HULLS_CLEARANCE, Measured, Open, Setting};
use crate::planner::Planner;
use crate::truth::Surface;

pub(crate) fn introduction(
    out: &mut impl Write,
    map: &AlignedMap,
    surface: &Surface,
    arguments: &Arguments,
) -> io::Result<()> {
    let (points, rays) = (map.points.len(), map.all_rays().len());
    let (matches, residual) = (map.matches, map.residual);
    writeln!(
        out,
        "map: {points} points, {rays} rays, {matches} keyframes {residual:.3} m (RMS) off the reference"
    )?;
    let (voxels, edge, images) = (surface.len(), surface.voxel, surface.images);
    writeln!(
        out,
        "truth: {voxels} surface voxels of {edge} m in {images} depth images"
    )?;
    let radius = arguments.radius;
    writeln!(
        out,
        "open: surface voxels that the centre of a ball of {radius} m may enter; places: voxels that it may be in at all\n"
    )?;
    writeln!(
        out,
        "| view | clearance, m | depth ratio | triangles up to, rad | points dropped | voxel centres in the ball: open | places | voxels the ball touches: open | places |"
    )?;
    writeln!(
        out,
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    )
}

/// The hulls' view has no places to count: it goes on for ever.
pub(crate) fn hulls(out: &mut impl Write, open: usize, surface: usize) -> io::Result<()> {
    let open = counted(open, surface);
    writeln!(
        out,
        "| hulls | {HULLS_CLEARANCE} | - | - | 0 | {open} | - | - | - |"
    )
}

pub(crate) fn row(
    out: &mut impl Write,
    setting: &Setting,
    measured: &Measured,
    surface: usize,
) -> io::Result<()> {
    let (config, dropped) = (&setting.config, measured.dropped);
    let (clearance, ratio) = (config.clearance, config.max_depth_ratio);
    let triangles = match config.max_triangle_angle {
        0.0 => "rays only".to_owned(),
        angle => angle.to_string(),
    };
    let pair = |open: Open| format!("{} | {}", counted(open.surface, surface), open.places);
    let (centers, touch) = (pair(measured.by_centers), pair(measured.by_touch));
    writeln!(
        out,
        "| proven free | {clearance} | {ratio} | {triangles} | {dropped} | {centers} | {touch} |"
    )
}

/// Only what a motion check says: a planner asks for nothing else.
pub(crate) fn planner(out: &mut impl Write, planner: &Planner, surface: usize) -> io::Result<()> {
    let (clearance, ratio) = (planner.config.clearance, planner.config.max_depth_ratio);
    let (triangles, dropped) = (planner.config.max_triangle_angle, planner.dropped);
    let (hulls, proven) = (
        counted(planner.hulls, surface),
        counted(planner.proven.surface, surface),
    );
    writeln!(
        out,
        "| plan, hulls only | - | - | - | {dropped} | - | - | {hulls} | - |"
    )?;
    let places = planner.proven.places;
    writeln!(
        out,
        "| plan, proven free | {clearance} | {ratio} | {triangles} | {dropped} | - | - | {proven} | {places} |"
    )
}

fn counted(open: usize, surface: usize) -> String {
    format!("{open} ({:.2} %)", 100.0 * open as f64 / surface as f64)
}
