//! What every pass knows of a picture.

use glam::Vec3;

use super::layout::uniform;
use super::mesh::Bodies;
use crate::render::{
    View,
    rays::{COARSE, Ground, added, key_direction, texels},
    stage::Stage,
    water::Grid,
};

/// Stands for infinity, which WGSL does not have.
pub(super) const FAR_AWAY: f32 = 1e30;

uniform! {
    /// The picture, its camera, and where things are in buffers. Numbers that answer a question are 0 for no.
    struct Scene {
        eye: Vec3,
        inverse_focal: f32,
        right: Vec3,
        width: u32,
        up: Vec3,
        height: u32,
        forward: Vec3,
        /// Words of a row of the picture.
        row_words: u32,
        /// Places of the rays that a pixel at an edge gets, and whether there are two.
        added: [f32; 4],
        more_added: u32,
        /// Corners of the container (m).
        has_container: u32,
        low: Vec3,
        /// Middle and diagonal of the box that the scene is in, and side of a pixel at a distance of 1 m (m).
        size: f32,
        high: Vec3,
        pixel: f32,
        centre: Vec3,
        /// Side of a tile of the floor (m).
        pitch: f32,
        absorption: Vec3,
        /// Distance that a new ray starts from a surface of water (m).
        nudge: f32,
        scatter: Vec3,
        /// Distance of particles at rest (m).
        spacing: f32,
        /// Towards the brightest window, and two directions across.
        light: Vec3,
        texel: f32,
        light_across: Vec3,
        texels: u32,
        light_along: Vec3,
        light_reach: f32,
        /// Box around what can hold the light up (m).
        lit_low: Vec3,
        has_floor: u32,
        lit_high: Vec3,
        hills: u32,
        ground_corner: Vec3,
        /// Whether sponges have the colours of a map.
        is_map: u32,
        has_tree: u32,
        triangles_at: u32,
        nodes_at: u32,
        nodes: u32,
        /// Bodies that rays end at come first, then those that they pass, then a floor.
        opaque_bodies: u32,
        seen_bodies: u32,
        all_bodies: u32,
        surfels: u32,
        surfel_low: Vec3,
        surfel_inverse: f32,
        surfel_sides: [u32; 3],
        has_field: u32,
        field_origin: Vec3,
        /// Shortest side of a cell (m).
        cell: f32,
        field_cell: Vec3,
        has_floor_node: u32,
        field_inverse: Vec3,
        floor_node: u32,
        field_last: Vec3,
        has_balls: u32,
        field_sides: [u32; 3],
        particles: u32,
        brick_sides: [u32; 3],
        /// Points that are sorted into cells, rows of each, and where the list of a cell begins.
        points: u32,
        cell_low: Vec3,
        cell_side: f32,
        cell_sides: [u32; 3],
        cell_list: u32,
        cell_count: u32,
        cell_pages: u32,
        point_rows: u32,
        has_interior: u32,
        /// Middle of the particles of an open scene, and how far lost ones are from it (m).
        middle: Vec3,
        lost: f32,
        sample_pace: u32,
        /// Number of the view, lowest and highest value of a colour map, speed of the palest water (m/s).
        view: u32,
        lowest: f32,
        highest: f32,
        section_point: Vec3,
        fastest: f32,
        section_normal: Vec3,
        radius: f32,
        has_velocities: u32,
        has_pressures: u32,
        focal: f32,
        nearest: f32,
        screen_width: u32,
        screen_height: u32,
        screen_focal: f32,
        screen_inverse_focal: f32,
    }
}

impl Scene {
    /// What is known of a picture before any pass.
    pub(super) fn new(stage: &Stage<'_>, bodies: &Bodies) -> Self {
        let (picture, raster) = (stage.picture, &stage.raster);
        let (low, high) = stage.around;
        let flag = u32::from;
        let light = key_direction();
        let across = Vec3::Y.cross(light).normalize();
        let (container, section) = (stage.container.unwrap_or_default(), picture.section.unwrap_or_default());
        let ground = stage.ground();
        let side = texels(picture.view);
        let maps =
            Ground::new((ground.map_or(low.y, |(height, _)| height), ground.is_some()), side, (low, high));
        let screen = raster.coarser(COARSE);
        let added = added(picture.view);
        let place = |ray: usize| added.get(ray).copied().unwrap_or_default();
        Self {
            eye: raster.eye,
            inverse_focal: raster.inverse_focal,
            right: raster.right,
            width: raster.width as u32,
            up: raster.up,
            height: raster.height as u32,
            forward: raster.forward,
            row_words: (raster.width as u32).next_multiple_of(64),
            added: [place(0).0, place(0).1, place(1).0, place(1).1],
            more_added: flag(added.len() > 1),
            has_container: flag(stage.container.is_some()),
            low: container.0,
            size: (high - low).length(),
            high: container.1,
            pixel: 1.0 / raster.focal,
            centre: (low + high) * 0.5,
            pitch: stage.pitch(),
            absorption: picture.absorption,
            nudge: 0.06 * stage.radius.max(1e-4),
            scatter: picture.scatter,
            spacing: 2.0 * stage.radius,
            light,
            texel: maps.texel,
            light_across: across,
            texels: side as u32,
            light_along: light.cross(across),
            has_floor: flag(ground.is_some()),
            ground_corner: maps.corner,
            is_map: flag(picture.view == View::Saturation),
            opaque_bodies: bodies.opaque,
            seen_bodies: bodies.seen,
            all_bodies: bodies.all,
            lost: FAR_AWAY,
            sample_pace: 1,
            point_rows: 1,
            view: picture.view as u32,
            lowest: picture.range.0,
            highest: picture.range.1,
            section_point: section.0,
            fastest: stage.fast,
            section_normal: section.1,
            radius: stage.radius,
            focal: raster.focal,
            nearest: raster.near,
            screen_width: screen.width as u32,
            screen_height: screen.height as u32,
            screen_focal: screen.focal,
            screen_inverse_focal: screen.inverse_focal,
            ..Self::default()
        }
    }

    /// Takes over the grid of the density.
    pub(super) fn set_grid(&mut self, grid: &Grid) {
        let sides = grid.sides.map(|nodes| nodes as u32);
        self.has_field = 1;
        self.cell = grid.cell.min_element();
        self.nudge = 0.06 * self.cell;
        (self.field_origin, self.field_cell, self.field_inverse) = (grid.origin, grid.cell, grid.inverse);
        self.field_sides = sides;
        self.field_last = Vec3::from(grid.sides.map(|nodes| nodes as f32 - 2.01));
        self.brick_sides = grid.bricks().map(|bricks| bricks as u32);
        self.has_floor_node = u32::from(grid.floor.is_some());
        self.floor_node = grid.floor.unwrap_or_default() as u32;
    }

    /// Nodes of the grid of the density.
    pub(super) fn field_nodes(&self) -> u64 {
        self.field_sides.iter().map(|side| u64::from(*side)).product()
    }

    /// Bricks of that grid.
    pub(super) fn bricks(&self) -> u64 {
        self.brick_sides.iter().map(|side| u64::from(*side)).product()
    }

    /// A grid of cells of at least a side (m) over points in a box.
    pub(super) fn set_cells(
        &mut self,
        (low, high): (Vec3, Vec3),
        side: f32,
        points: u32,
        rows: u32,
        most: f32,
    ) {
        let cells = ((high - low) / side + 1.0).max(Vec3::ONE).element_product();
        let side = side * libm::cbrtf((cells / most).max(1.0));
        self.cell_low = low;
        self.cell_side = side;
        self.cell_sides =
            ((high - low) / side).to_array().map(|length| (length.max(0.0) as u32).saturating_add(1));
        self.cell_count = self.cell_sides.iter().product();
        self.cell_list = self.cell_count + 1;
        self.cell_pages =
            self.cell_count.div_ceil(super::declarations::PAGE_THREADS * super::declarations::PAGE_SHARE);
        (self.points, self.point_rows) = (points, rows);
    }
}
