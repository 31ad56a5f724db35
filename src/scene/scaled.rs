//! A scene at another resolution.

use glam::UVec3;

use super::{Scene, SceneError, Sponge};

/// Factors by which a scene can be refined.
const RESOLUTIONS: (f32, f32) = (0.1, 8.0);

impl Scene {
    /// The same geometry with particles and lattice cells `resolution` times as fine. Twice the resolution has about 8 times
    /// the particles and nodes. Range 0.1 to 8; 1 changes nothing.
    ///
    /// A sponge keeps its length along x exactly. The other two are rounded to whole cells, with its bottom and its middle
    /// along z in place.
    ///
    /// # Errors
    /// [`SceneError::Resolution`] for a factor outside the range, [`SceneError::Invalid`] where the finer scene is too
    /// large or a coarse sponge no longer fits its container.
    #[expect(clippy::float_cmp, reason = "exactly 1 must give back the same bits")]
    pub fn scaled(&self, resolution: f32) -> Result<Self, SceneError> {
        let (minimum, maximum) = RESOLUTIONS;
        if !(minimum..=maximum).contains(&resolution) {
            return Err(SceneError::Resolution { value: resolution, minimum, maximum });
        }
        let mut scene = self.clone();
        if resolution != 1.0 {
            if let Some(fluid) = &mut scene.fluid {
                fluid.spacing /= resolution;
            }
            for sponge in &mut scene.sponges {
                refine(sponge, resolution);
            }
        }
        scene.validate()?;
        Ok(scene)
    }
}

/// Replaces the lattice of a sponge; its cells stay cubes.
fn refine(sponge: &mut Sponge, resolution: f32) {
    let size = sponge.size();
    let along_x = whole_cells(sponge.cells.x as f32 * resolution);
    sponge.edge = size.x / along_x as f32;
    sponge.cells = UVec3::new(along_x, whole_cells(size.y / sponge.edge), whole_cells(size.z / sponge.edge));
    sponge.position.z += (size.z - sponge.size().z) / 2.0;
}

/// Nearest number of cells, at least 2: with fewer the lattice has no tets across.
#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, and validation bounds the cells")]
#[expect(clippy::cast_sign_loss, reason = "at least 2")]
fn whole_cells(cells: f32) -> u32 {
    cells.round().max(2.0) as u32
}
