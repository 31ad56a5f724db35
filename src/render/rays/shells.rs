//! The view of superimposed surfaces: sponges and water as shells that let light through, one over the other.

use super::matter::Arrival;
use super::path::Signature;
use super::room::{self, KEY, hemisphere, key_direction};
use super::setting::{Matter, NEAR, Setting};
use super::skin::facet;
use crate::render::colour::smooth;
use glam::Vec3;

/// Most shells of a ray.
const SHELLS: usize = 12;
const WATER: Vec3 = Vec3::new(0.05, 0.28, 0.62);
const SPONGE_DRY: Vec3 = Vec3::new(0.90, 0.62, 0.20);
const SPONGE_SOAKED: Vec3 = Vec3::new(0.46, 0.22, 0.05);
/// Share of the light that a shell holds back where it is seen at a right angle.
const WATER_COVER: f32 = 0.28;
const SPONGE_COVER: f32 = 0.5;
/// A shell nearer in front of a solid than this is that solid (m): the wall under the water and the floor.
const TOUCHING: f32 = 1e-5;

#[cfg(feature = "gpu")]
shared_with_shaders!(SHELLS: SHELLS, WATER, SPONGE_DRY, SPONGE_SOAKED, WATER_COVER, SPONGE_COVER, TOUCHING);

/// A shell that a ray meets.
struct Shell {
    distance: f32,
    normal: Vec3,
    colour: Vec3,
    cover: f32,
    code: u32,
}

impl Setting<'_> {
    /// Light along a ray through the shells, and its signature.
    pub(super) fn superimposed(&self, origin: Vec3, direction: Vec3) -> (Vec3, Signature) {
        let mut signature = Signature::default();
        let mut shells = self.water_shells(origin, direction);
        shells.extend(self.sponge_shells(origin, direction));
        shells.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let end = self.behind_shells(origin, direction);
        let limit = end.as_ref().map_or(f32::INFINITY, |(distance, _)| *distance);
        let (mut light, mut through) = (Vec3::ZERO, 1.0);
        for shell in shells.iter().filter(|shell| shell.distance < limit - TOUCHING) {
            signature.meet(shell.code);
            let normal = if shell.normal.dot(direction) > 0.0 { -shell.normal } else { shell.normal };
            let slant = 1.0 + direction.dot(normal);
            let cover = shell.cover + (0.9 - shell.cover) * smooth(0.3, 1.0, slant);
            let lit = KEY * normal.dot(key_direction()).max(0.0) + hemisphere(normal);
            light += shell.colour * lit * (cover * through);
            through *= 1.0 - cover;
        }
        let behind = match end {
            None => room::background(direction),
            Some((distance, matter)) => {
                let point = origin + direction * distance;
                let arrival = Arrival { point, direction, way: distance, film: false, wet: false };
                self.shine(&matter, &arrival, &mut signature)
            }
        };
        (light + behind * through, signature)
    }

    /// What the shells are in front of: bodies and the floor.
    fn behind_shells(&self, origin: Vec3, direction: Vec3) -> Option<(f32, Matter)> {
        let mut start = 0.0;
        // Sponges are shells here.
        for _ in 0..SHELLS {
            let (distance, matter) = self.solid(origin + direction * start, direction, f32::INFINITY)?;
            start += distance;
            if !matches!(matter, Matter::Sponge(_)) {
                return Some((start, matter));
            }
            start += self.nudge;
        }
        None
    }

    fn sponge_shells(&self, origin: Vec3, direction: Vec3) -> Vec<Shell> {
        let (mut shells, mut start) = (Vec::new(), 0.0);
        while shells.len() < SHELLS
            && let Some(hit) = self.tree.hit(origin + direction * start, direction, f32::INFINITY)
        {
            start += hit.distance;
            let (wetness, normal) = facet(&self.stage.sponge, &hit);
            let colour = SPONGE_DRY.lerp(SPONGE_SOAKED, smooth(0.03, 0.75, wetness));
            shells.push(Shell { distance: start, normal, colour, cover: SPONGE_COVER, code: 6 });
            start += self.nudge;
        }
        shells
    }

    fn water_shells(&self, origin: Vec3, direction: Vec3) -> Vec<Shell> {
        let mut shells = Vec::new();
        let Some(field) = &self.field else { return shells };
        let container = self.stage.container;
        let passage = container.and_then(|(low, high)| super::setting::boxed(low, high, origin, direction));
        let (enter, leave) = match (container, passage) {
            (Some(_), None) => return shells,
            (_, passage) => passage.unwrap_or((0.0, f32::INFINITY)),
        };
        let shell = |distance: f32, normal: Vec3, code: u32| Shell {
            distance,
            normal,
            colour: WATER,
            cover: WATER_COVER,
            code,
        };
        let mut start = enter.max(0.0);
        let mut wet = field.value(origin + direction * start) > 0.0;
        if wet && enter > NEAR {
            shells.push(shell(enter, self.face(origin + direction * enter), 12));
        }
        while shells.len() < SHELLS
            && let Some(distance) = field.march(origin, direction, (start, leave), wet)
        {
            let normal = field.normal(origin + direction * distance);
            shells.push(shell(distance, normal, 10 + u32::from(wet)));
            wet = !wet;
            start = distance + self.nudge;
        }
        if wet && leave.is_finite() {
            shells.push(shell(leave, self.face(origin + direction * leave), 13));
        }
        shells
    }
}
