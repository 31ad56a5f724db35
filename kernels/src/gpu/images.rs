//! Images of particles, to a device and back.

use glam::Vec3;

use super::{
    capacities::{Capacities, List},
    cells::Grid,
    error::GpuError,
    image_layout::DeviceImage,
    layout::{ROW_BYTES, Value, WORD_BYTES, place_of},
    resident::Resident,
};
use crate::{
    column::{FAR_ROW, padded},
    columns::{Columns, Fluid},
    divergence::{
        collect::lift,
        image_rows::{IMAGE_RATIO, Images, NO_BODY, along_open_axes},
    },
    grid::neighbors::{ListValues, Neighbors},
    params::Params,
};

impl Resident {
    /// Sends the images of the host.
    pub(super) fn upload_images(&mut self, fluid: &Fluid) -> Result<(), GpuError> {
        let (images, rows) = (&fluid.images, self.rows.fluid);
        let count = images.count();
        let of_particles = |row: usize| images.near.of(row, count).collect::<Vec<u32>>();
        // Without images there are no lists.
        let near: Vec<Vec<u32>> =
            (0..rows).map(|row| if count > 0 { of_particles(row) } else { Vec::new() }).collect();
        let is_in_body = |image: usize| images.has_bodies && images.body[image] != NO_BODY;
        let of_image = |image: usize| images.particles.of(image, rows).collect::<Vec<u32>>();
        let particles: Vec<Vec<u32>> =
            (0..count).map(|image| if is_in_body(image) { of_image(image) } else { Vec::new() }).collect();
        let longest = |lists: &[Vec<u32>]| lists.iter().map(Vec::len).max().unwrap_or(0) as u32;
        let mut needed = Capacities::default();
        for (list, own) in [
            (List::NearImages, longest(&near)),
            (List::ImageParticles, longest(&particles)),
            (List::Images, count as u32),
        ] {
            needed[list as usize] = if own as usize > list.capacity(self.capacities) { own } else { 0 };
        }
        if needed != Capacities::default() {
            self.lengthen(needed)?;
        }
        self.write(
            "image_position",
            bytemuck::cast_slice(&images.position[..count.min(images.position.len())]),
        );
        let words: Vec<u32> = (0..count).flat_map(|image| device_image(fluid, image).words()).collect();
        self.write("images", bytemuck::cast_slice(&words));
        let first = &images.first[..images.first.len().min(rows + 1)];
        self.write("fluid_image_first", bytemuck::cast_slice(first));
        let mut grid = self.grids[3].words();
        grid[place_of::<Grid>("rows")] = count as u32;
        self.write("image_grid", bytemuck::cast_slice(&grid));
        let capacity = List::Images.capacity(self.capacities);
        for (name, lists, lines, which) in [
            ("fluid_near_images", &near, rows, List::NearImages),
            ("image_particles", &particles, capacity, List::ImageParticles),
        ] {
            let mut words = vec![0_u32; which.words(self.rows, self.capacities)];
            for (row, list) in lists.iter().enumerate() {
                words[row] = list.len() as u32;
                list.iter().enumerate().for_each(|(k, target)| words[(k + 1) * lines + row] = *target);
            }
            self.write(name, bytemuck::cast_slice(&words));
        }
        Ok(())
    }

    /// Reads the images back.
    pub(super) fn download_images(&self, columns: &mut Columns) -> Result<(), GpuError> {
        let (rows, lines) = (self.rows.fluid, List::Images.capacity(self.capacities));
        if lines == 0 {
            return Ok(());
        }
        let list = |list: List| list.bytes(self.rows, self.capacities);
        let data = self.read(&[
            ("image_grid", Grid::BYTES),
            ("image_position", ROW_BYTES * lines as u64),
            ("images", DeviceImage::BYTES * lines as u64),
            ("fluid_image_first", WORD_BYTES * (rows as u64 + 1)),
            ("fluid_near_images", list(List::NearImages)),
            ("image_particles", list(List::ImageParticles)),
            ("fluid_position", ROW_BYTES * rows as u64),
        ])?;
        let [grid, position, images, first, near, particles, points] = &data[..] else { return Ok(()) };
        let count = grid[place_of::<Grid>("rows")] as usize;
        let position: &[[f32; 4]] = bytemuck::cast_slice(position);
        let points: &[[f32; 4]] = bytemuck::cast_slice(points);
        let found = &mut columns.fluid.images;
        *found = Images { position: position[..count].to_vec(), ..Images::default() };
        let gravity = along_open_axes(&self.params);
        for (words, at) in images.chunks_exact(DeviceImage::WORDS).zip(&position[..count]) {
            let DeviceImage { foot, source, along, body, between, axes } = DeviceImage::take(words);
            let row = |[x, y, z]: [f32; 3], w: f32| [x, y, z, w];
            found.foot.push(row(foot, 0.0));
            found.along.push(row(along, 0.0));
            found.between.push(row(between, 0.0));
            let vector = |row: &[f32; 4]| Vec3::new(row[0], row[1], row[2]);
            found.lift.push(lift((body, axes), vector(at), &points[source as usize], gravity));
            found.axes.push(axes);
            found.source.push(source);
            found.body.push(body);
        }
        found.has_bodies = found.body.iter().any(|body| *body != NO_BODY);
        found.first = first.clone();
        found.first.resize(padded(rows) + 1, count as u32);
        let to = padded(count);
        found.position.resize(to, FAR_ROW);
        found.axes.resize(to, 0);
        found.lift.resize(to, [0.0; 4]);
        for column in [&mut found.foot, &mut found.along, &mut found.between] {
            column.resize(if found.has_bodies { to } else { 0 }, [0.0; 4]);
        }
        let lists = |words: &[u32], lines: usize, used: usize, of: usize| {
            let list = |row: usize| (1..=words[row] as usize).map(|k| words[k * lines + row]).collect();
            let mut all: Vec<Vec<u32>> = (0..used).map(list).collect();
            all.resize_with(of, Vec::new);
            all
        };
        found.near = Neighbors::from_lists(&lists(near, rows, rows, padded(rows)), count as u32);
        found.pairs =
            values(&self.params, &found.near, (points, &found.position), |_, image| image[IMAGE_RATIO]);
        let of = if found.has_bodies { to } else { 0 };
        found.particles = Neighbors::from_lists(&lists(particles, lines, count.min(of), of), rows as u32);
        found.particle_pairs =
            values(&self.params, &found.particles, (&found.position, points), |image, _| image[IMAGE_RATIO]);
        Ok(())
    }
}

fn device_image(fluid: &Fluid, image: usize) -> DeviceImage {
    let images = &fluid.images;
    let vector = |row: &[f32; 4]| [row[0], row[1], row[2]];
    // Without bodies there are no maps.
    let of_body = |rows: &[[f32; 4]], without: [f32; 4]| vector(rows.get(image).unwrap_or(&without));
    DeviceImage {
        foot: of_body(&images.foot, fluid.position[images.source[image] as usize]),
        source: images.source[image],
        along: of_body(&images.along, [1.0; 4]),
        body: images.body[image],
        between: of_body(&images.between, [0.0; 4]),
        axes: images.axes[image],
    }
}

/// The values of lists, which devices compute where they need them.
fn values(
    params: &Params,
    lists: &Neighbors,
    (queries, targets): (&[[f32; 4]], &[[f32; 4]]),
    ratio: impl Fn(&[f32; 4], &[f32; 4]) -> f32,
) -> ListValues {
    let (smoothing, volume) = (&params.fluid.smoothing, params.fluid.rest_volume());
    let mut values = ListValues::default();
    values.fill(lists, |query, target| {
        let (Some(a), Some(b)) = (queries.get(query), targets.get(target)) else { return 0.0 };
        let apart = Vec3::new(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        let apart = params.periodic.map_or(apart, |periodic| periodic.nearest(apart));
        volume * smoothing.gradient_at(apart.length()) * ratio(a, b)
    });
    values
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        columns::Column,
        divergence,
        gpu::Gpu,
        grid,
        tests::{
            gpu::LIMITS,
            scene::{FULL, Options, Scene},
        },
    };

    /// The images of a scene with room for `room` of everything; as much as is usual without.
    fn found(room: Option<u32>) -> (Images, Capacities) {
        let options = Options { incompressible: true, divergence: true, sponges: false, ..FULL };
        let scene = Scene::new(options);
        let fail = |error: GpuError| -> ! { panic!("{error}") };
        let gpu = Arc::new(Gpu::new().unwrap_or_else(|error| fail(error)));
        let mut columns = scene.columns.clone();
        let mut resident =
            Resident::new(&gpu, &columns, &scene.params, LIMITS).unwrap_or_else(|error| fail(error));
        for which in [List::NearImages, List::ImageParticles, List::Images].map(|list| list as usize) {
            resident.capacities[which] = room.unwrap_or(resident.capacities[which]);
        }
        resident.fill_params();
        let kernels =
            [&grid::sort_fluid::KERNEL, &grid::fluid_neighbors::KERNEL, &divergence::images::KERNEL];
        // The lists of neighbours are made on the device.
        let mut reads: Vec<Column> = kernels.iter().flat_map(|kernel| kernel.reads).copied().collect();
        reads.retain(|column| *column != Column::FluidNeighbors);
        resident.upload(&mut columns, &reads, false).unwrap_or_else(|error| fail(error));
        let before = resident.capacities;
        let mut program = resident.program(&kernels).unwrap_or_else(|error| fail(error));
        resident.run_kernels(&mut program, 1e-4).unwrap_or_else(|error| fail(error));
        resident.download(&mut columns, &[Column::FluidImages]).unwrap_or_else(|error| fail(error));
        assert!(room.is_none() || resident.capacities != before, "nothing grew");
        (columns.fluid.images, resident.capacities)
    }

    #[test]
    fn there_is_room_for_more_images_when_they_do_not_fit() {
        let words = |images: &Images| {
            let mut words = Vec::new();
            crate::column::ColumnData::visit_words(images, 0, &mut |word| words.push(word));
            words
        };
        let (usual, capacities) = found(None);
        let (grown, others) = found(Some(8));
        assert!(usual.count() > 100 && usual.has_bodies);
        assert_ne!(capacities, others);
        assert!(words(&usual) == words(&grown), "{} and {} images", usual.count(), grown.count());
    }
}
