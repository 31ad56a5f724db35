//! Draws panels on the CPU: for windows without a GPU, and for pictures of the window.

use std::collections::BTreeMap;

use egui::{
    ClippedPrimitive, Color32, ImageData, Mesh, Pos2, Rect, TextureId, TexturesDelta,
    epaint::{Primitive, Vertex},
};

/// Parts of a pixel that corners lie on: edges are then exact, and no pixel belongs to two triangles.
const PARTS: f32 = 16.0;

/// A texture, premultiplied.
#[derive(Clone, Debug, Default)]
struct Texture {
    size: [usize; 2],
    pixels: Vec<Color32>,
}

/// Draws panels on the CPU.
#[derive(Clone, Debug, Default)]
pub(super) struct Rasteriser {
    textures: BTreeMap<TextureId, Texture>,
    size: [usize; 2],
    pixels: Vec<Color32>,
}

impl Rasteriser {
    /// Takes over changes of textures.
    pub(super) fn update(&mut self, delta: &TexturesDelta) {
        for (id, changes) in &delta.set {
            for change in changes {
                let ImageData::Color(image) = &change.image;
                let texture = self.textures.entry(*id).or_default();
                match change.pos {
                    None => *texture = Texture { size: image.size, pixels: image.pixels.clone() },
                    Some([left, top]) => texture.patch(left, top, image),
                }
            }
        }
    }

    /// Forgets textures that are not drawn any more.
    pub(super) fn free(&mut self, delta: &TexturesDelta) {
        for id in &delta.free {
            self.textures.remove(id);
        }
    }

    /// Draws into pixels of the window, rows from top to bottom.
    pub(super) fn paint(
        &mut self,
        size: [usize; 2],
        scale: f32,
        primitives: &[ClippedPrimitive],
    ) -> &[Color32] {
        self.size = size;
        self.pixels.clear();
        self.pixels.resize(size[0] * size[1], Color32::BLACK);
        for ClippedPrimitive { clip_rect, primitive } in primitives {
            let Primitive::Mesh(mesh) = primitive else { continue };
            let Some(texture) = self.textures.get(&mesh.texture_id) else { continue };
            let clip = pixels_of(*clip_rect, scale, size);
            draw_mesh(&mut self.pixels, size[0], clip, scale, mesh, texture);
        }
        &self.pixels
    }
}

impl Texture {
    fn patch(&mut self, left: usize, top: usize, image: &egui::ColorImage) {
        let rows = image.pixels.chunks_exact(image.size[0].max(1)).take(image.size[1]);
        for (row, pixels) in rows.enumerate() {
            let first = (top + row) * self.size[0] + left;
            if let Some(own) = self.pixels.get_mut(first..first + pixels.len()) {
                own.copy_from_slice(pixels);
            }
        }
    }

    /// The colour at a place, between four pixels: sums of products with shares, each 0 to 255.
    fn at(&self, u: f32, v: f32) -> [f32; 4] {
        let [width, height] = self.size;
        if self.pixels.is_empty() {
            return [0.0; 4];
        }
        let place = |at: f32, size: usize| {
            let at = (at * size as f32 - 0.5).clamp(0.0, (size - 1) as f32);
            let low = at as usize;
            (low, (low + 1).min(size - 1), at - low as f32)
        };
        let ((left, right, across), (top, bottom, down)) = (place(u, width), place(v, height));
        let pixel = |x: usize, y: usize| self.pixels[y * width + x].to_array().map(f32::from);
        let (a, b, c, d) = (pixel(left, top), pixel(right, top), pixel(left, bottom), pixel(right, bottom));
        std::array::from_fn(|lane| {
            let (above, below) =
                (a[lane] + (b[lane] - a[lane]) * across, c[lane] + (d[lane] - c[lane]) * across);
            above + (below - above) * down
        })
    }
}

/// First and end of the pixels in a rectangle, along both axes.
fn pixels_of(rect: Rect, scale: f32, size: [usize; 2]) -> [[i64; 2]; 2] {
    let along = |low: f32, high: f32, size: usize| {
        let pixel = |at: f32| ((at * scale).round() as i64).clamp(0, size as i64);
        [pixel(low), pixel(high)]
    };
    [along(rect.min.x, rect.max.x, size[0]), along(rect.min.y, rect.max.y, size[1])]
}

fn draw_mesh(
    pixels: &mut [Color32],
    width: usize,
    clip: [[i64; 2]; 2],
    scale: f32,
    mesh: &Mesh,
    texture: &Texture,
) {
    for corners in mesh.indices.as_chunks::<3>().0 {
        let vertex = |index: u32| mesh.vertices.get(index as usize).copied();
        let [Some(a), Some(b), Some(c)] = corners.map(vertex) else { continue };
        draw_triangle(pixels, width, clip, scale, [a, b, c], texture);
    }
}

/// Twice the area of a triangle in parts of pixels; above 0 in one order of its corners.
fn area(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn draw_triangle(
    pixels: &mut [Color32],
    width: usize,
    clip: [[i64; 2]; 2],
    scale: f32,
    mut corners: [Vertex; 3],
    texture: &Texture,
) {
    let parts = |pos: Pos2| [pos.x, pos.y].map(|at| (at * scale * PARTS).round() as i64);
    let mut places = corners.map(|corner| parts(corner.pos));
    let mut whole = area(places[0], places[1], places[2]);
    if whole < 0 {
        places.swap(1, 2);
        corners.swap(1, 2);
        whole = -whole;
    }
    if whole == 0 {
        return;
    }
    let step = PARTS as i64;
    let bounds = |axis: usize| {
        let own = places.map(|place| place[axis]);
        let (low, high) = (own[0].min(own[1]).min(own[2]), own[0].max(own[1]).max(own[2]));
        low.div_euclid(step).max(clip[axis][0])..(high.div_euclid(step) + 1).min(clip[axis][1])
    };
    // A pixel on an edge belongs to the triangle below or to the right of it.
    let shared = [[1, 2], [2, 0], [0, 1]].map(|[from, to]: [usize; 2]| {
        let [x, y] = [places[to][0] - places[from][0], places[to][1] - places[from][1]];
        i64::from(!(y < 0 || (y == 0 && x > 0)))
    });
    let one_colour = corners[0].color == corners[1].color && corners[1].color == corners[2].color;
    let one_place = corners[0].uv == corners[1].uv && corners[1].uv == corners[2].uv;
    let flat = one_place.then(|| texture.at(corners[0].uv.x, corners[0].uv.y));
    let colours = corners.map(|corner| corner.color.to_array().map(f32::from));
    for y in bounds(1) {
        for x in bounds(0) {
            let middle = [x * step + step / 2, y * step + step / 2];
            let weights = [
                area(places[1], places[2], middle),
                area(places[2], places[0], middle),
                area(places[0], places[1], middle),
            ];
            if weights.iter().zip(shared).any(|(weight, shared)| *weight < shared) {
                continue;
            }
            let shares = weights.map(|weight| weight as f32 / whole as f32);
            let sampled = flat.unwrap_or_else(|| {
                let uv = |axis: fn(&Vertex) -> f32| {
                    corners.iter().zip(shares).map(|(corner, share)| axis(corner) * share).sum::<f32>()
                };
                texture.at(uv(|corner| corner.uv.x), uv(|corner| corner.uv.y))
            });
            let colour: [f32; 4] = if one_colour {
                colours[0]
            } else {
                std::array::from_fn(|lane| (0..3).map(|corner| colours[corner][lane] * shares[corner]).sum())
            };
            let own = &mut pixels[y as usize * width + x as usize];
            *own = over(*own, std::array::from_fn(|lane| sampled[lane] * colour[lane] / 255.0));
        }
    }
}

/// A premultiplied colour over another one.
fn over(below: Color32, above: [f32; 4]) -> Color32 {
    let rest = 1.0 - above[3] / 255.0;
    let below = below.to_array();
    let [red, green, blue, alpha] = std::array::from_fn(|lane| {
        (above[lane] + f32::from(below[lane]) * rest).round().clamp(0.0, 255.0) as u8
    });
    Color32::from_rgba_premultiplied(red, green, blue, alpha)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Shape, TextureOptions, epaint::ImageDelta, vec2};

    #[test]
    fn halves_of_a_rectangle_meet_without_a_gap_or_an_overlap() {
        let mut rasteriser = Rasteriser::default();
        let white = egui::ColorImage::filled([1, 1], Color32::WHITE);
        let mut delta = TexturesDelta::default();
        let image = ImageDelta::full(white, TextureOptions::NEAREST);
        delta.set.entry(TextureId::default()).or_default().push(image);
        rasteriser.update(&delta);
        delta.clear();
        let mut mesh = Mesh::default();
        let half = Color32::from_rgba_premultiplied(64, 64, 64, 128);
        let rect = Rect::from_min_size(Pos2::new(1.0, 2.0), vec2(5.0, 3.0));
        mesh.add_colored_rect(rect, half);
        let clip_rect = Rect::from_min_size(Pos2::ZERO, vec2(4.0, 8.0));
        let Shape::Mesh(mesh) = Shape::mesh(mesh) else { panic!("a mesh") };
        let primitive = Primitive::Mesh((*mesh).clone());
        let pixels = rasteriser.paint([8, 8], 1.0, &[ClippedPrimitive { clip_rect, primitive }]);
        for (index, pixel) in pixels.iter().enumerate() {
            let (x, y) = (index % 8, index / 8);
            let is_in = (1..4).contains(&x) && (2..5).contains(&y);
            assert_eq!(pixel.r(), if is_in { 64 } else { 0 }, "{x} {y}");
        }
    }
}
