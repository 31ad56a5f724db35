//! Refused questions.

use glam::Vec3;

use super::Ray;

/// Largest coordinate \[m\].
const FARTHEST: f32 = 1000.0;

/// Why a question about the state was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QueryError {
    /// A number is out of range.
    #[error("query {index}: {key} = {value} is out of range {range}")]
    OutOfRange {
        /// Number of the ray or point, from 0.
        index: usize,
        /// What is out of range.
        key: &'static str,
        /// Its value.
        value: String,
        /// What is accepted.
        range: &'static str,
    },
}

fn check_place(index: usize, key: &'static str, place: Vec3) -> Result<(), QueryError> {
    // Refuses NaN as well.
    if place.abs().cmple(Vec3::splat(FARTHEST)).all() {
        return Ok(());
    }
    let range = "-1000 to 1000 m";
    Err(QueryError::OutOfRange { index, key, value: place.to_string(), range })
}

/// Refuses points that are not finite or out of range.
pub(super) fn check_points(points: &[Vec3]) -> Result<(), QueryError> {
    points.iter().enumerate().try_for_each(|(index, point)| check_place(index, "point", *point))
}

/// The rays with directions of unit length.
///
/// # Errors
/// A ray is not finite, has no direction, or a length out of range.
pub(super) fn checked_rays(rays: &[Ray]) -> Result<Vec<Ray>, QueryError> {
    let check = |(index, ray): (usize, &Ray)| {
        check_place(index, "origin", ray.origin)?;
        let Some(direction) = ray.direction.try_normalize() else {
            let (key, value) = ("direction", ray.direction.to_string());
            return Err(QueryError::OutOfRange {
                index,
                key,
                value,
                range: "finite, of any length but zero",
            });
        };
        if !(0.0..=2.0 * FARTHEST).contains(&ray.length) {
            let (key, value) = ("length", ray.length.to_string());
            return Err(QueryError::OutOfRange { index, key, value, range: "0 to 2000 m" });
        }
        Ok(Ray { direction, ..*ray })
    };
    rays.iter().enumerate().map(check).collect()
}

/// The box around points; inverted without any.
pub(super) fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    points.iter().fold(none, |(low, high), point| (low.min(*point), high.max(*point)))
}
