//! A picture as a mesh: cells between pixel centres, torn where depths part.

use super::sheet::{Cover, Sheet};
use super::{GridSettings, Landing, PixelMap};
use crate::image::Image;
use glam::{DVec2, DVec4, Vec4};
use rayon::prelude::*;
use std::ops::{Add, Div};

/// Side of a block of cells.
const BLOCK: usize = 16;

/// The cells between the pixels of a picture and a ring of transparent pixels around it.
pub(super) struct Cells<'a> {
    map: &'a PixelMap,
    image: &'a Image,
    settings: GridSettings,
    /// Largest inverse depth that the wanted view shows, 1/m.
    nearest: f64,
    /// Width and height in cells: one more than in pixels.
    size: [usize; 2],
    /// Of each pixel and the ring, row by row; those of the ring have the depth of the pixel next to them.
    vertices: Vec<Vertex>,
}

#[derive(Debug, Clone, Copy)]
struct Vertex {
    /// One over the depth in the shown view, 1/m; 0 where nothing was hit.
    inverse_depth: f64,
    landing: Option<Landing>,
}

impl<'a> Cells<'a> {
    pub(super) fn new(map: &'a PixelMap, image: &'a Image, settings: GridSettings, near_m: f64) -> Self {
        let size = [image.width as usize + 1, image.height as usize + 1];
        let nearest = 1.0 / near_m.max(f64::MIN_POSITIVE);
        let mut cells = Self { map, image, settings, nearest, size, vertices: Vec::new() };
        let columns = size[0] + 1;
        cells.vertices = (0..columns * (size[1] + 1))
            .into_par_iter()
            .map(|index| {
                let (column, row) = (index % columns, index / columns);
                let x = column.clamp(1, columns - 2) - 1;
                let y = row.clamp(1, size[1] - 1) - 1;
                let inverse_depth = inverse(image.depth_m[y * image.width as usize + x]);
                Vertex { inverse_depth, landing: cells.landing(position(column, row), inverse_depth) }
            })
            .collect();
        cells
    }

    /// Squares of cells that are drawn together.
    pub(super) fn blocks(&self) -> usize {
        self.size.map(|cells| cells.div_ceil(BLOCK)).iter().product()
    }

    /// What is to be drawn of a block of cells.
    pub(super) fn for_each_sheet_of_block(&self, block: usize, mut draw: impl FnMut(&Sheet)) {
        let across = self.size[0].div_ceil(BLOCK);
        let (left, top) = (block % across * BLOCK, block / across * BLOCK);
        for row in top..(top + BLOCK).min(self.size[1]) {
            for column in left..(left + BLOCK).min(self.size[0]) {
                let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| (column + x, row + y));
                let colors = corners.map(|(x, y)| self.color(x, y));
                if colors != [DVec4::ZERO; 4] {
                    self.for_each_sheet(corners, colors, &mut draw);
                }
            }
        }
    }

    fn for_each_sheet(
        &self,
        corners: [(usize, usize); 4],
        colors: [DVec4; 4],
        draw: &mut impl FnMut(&Sheet),
    ) {
        let vertices = corners.map(|(x, y)| self.vertices[y * (self.size[0] + 1) + x]);
        let depths = vertices.map(|vertex| vertex.inverse_depth);
        let nearest = depths.into_iter().fold(0.0, f64::max);
        let furthest = depths.into_iter().fold(f64::INFINITY, f64::min);
        let positions = corners.map(|(x, y)| position(x, y));
        let parting_px = self.parting_px(positions[0] + 0.5, nearest, furthest);
        if parting_px <= self.settings.tear_px {
            if let Some(corners) = all(vertices.map(|vertex| vertex.landing)) {
                draw(&Sheet { corners, colors, cover: Cover::Quarters([true; 4]) });
            }
            return;
        }
        let is_near = depths.map(|depth| depth > 0.5 * (nearest + furthest));
        for side in [is_near, is_near.map(|near| !near)] {
            let depths = carried_on(depths, side);
            let landings = [0, 1, 2, 3].map(|i| self.landing(positions[i], depths[i]));
            if let Some(corners) = all(landings) {
                draw(&Sheet { corners, colors: carried_on(colors, side), cover: Cover::Quarters(side) });
            }
        }
        if parting_px <= self.settings.close_px {
            self.draw_behind(positions, depths, colors, is_near, draw);
        }
    }

    /// The far side, stretched to where the near side ends.
    fn draw_behind(
        &self,
        positions: [DVec2; 4],
        depths: [f64; 4],
        colors: [DVec4; 4],
        is_near: [bool; 4],
        draw: &mut impl FnMut(&Sheet),
    ) {
        let is_far = is_near.map(|near| !near);
        let colors = carried_on(colors, is_far);
        let far_depths = carried_on(depths, is_far);
        let corners = [0, 1, 2, 3].map(|i| {
            let edge = self.landing(positions[i], depths[i])?;
            let behind = self.landing(positions[i], far_depths[i])?;
            Some(Landing { position: edge.position, ..behind })
        });
        if let Some(corners) = all(corners)
            && colors != [DVec4::ZERO; 4]
        {
            draw(&Sheet { corners, colors, cover: Cover::Holes });
        }
    }

    /// How far apart in the wanted picture two inverse depths of a shown position are, pixels.
    fn parting_px(&self, position: DVec2, nearest: f64, furthest: f64) -> f64 {
        if nearest == furthest {
            return 0.0;
        }
        let ends = [nearest, furthest].map(|depth| self.map.at(position, depth));
        let [Some(near), Some(far)] = ends else { return f64::INFINITY };
        near.position.distance(far.position)
    }

    /// Where a point lands if the wanted view shows it.
    fn landing(&self, position: DVec2, inverse_depth: f64) -> Option<Landing> {
        self.map.at(position, inverse_depth).filter(|landing| landing.inverse_depth <= self.nearest)
    }

    /// Colour of a vertex; transparent on the ring.
    fn color(&self, column: usize, row: usize) -> DVec4 {
        let is_pixel = (1..self.size[0]).contains(&column) && (1..self.size[1]).contains(&row);
        if !is_pixel {
            return DVec4::ZERO;
        }
        Vec4::from(self.image.color[(row - 1) * self.image.width as usize + column - 1]).as_dvec4()
    }
}

/// Pixel position of a vertex.
fn position(column: usize, row: usize) -> DVec2 {
    DVec2::new(column as f64 - 0.5, row as f64 - 0.5)
}

/// One over a depth; 0 for what is no depth in front of the eye.
fn inverse(depth_m: f32) -> f64 {
    if depth_m > 0.0 { 1.0 / f64::from(depth_m) } else { 0.0 }
}

fn all<T: Copy>(corners: [Option<T>; 4]) -> Option<[T; 4]> {
    let [Some(a), Some(b), Some(c), Some(d)] = corners else { return None };
    Some([a, b, c, d])
}

/// Values of a side of a torn cell at all its corners: elsewhere the mean of those next to a corner, or else the opposite.
fn carried_on<T: Copy + Add<Output = T> + Div<f64, Output = T>>(
    values: [T; 4],
    is_side: [bool; 4],
) -> [T; 4] {
    [0, 1, 2, 3].map(|corner| {
        let (across, along) = (corner ^ 1, corner ^ 2);
        match (is_side[corner], is_side[across], is_side[along]) {
            (true, _, _) => values[corner],
            (_, true, true) => (values[across] + values[along]) / 2.0,
            (_, true, false) => values[across],
            (_, false, true) => values[along],
            (_, false, false) => values[corner ^ 3],
        }
    })
}
