//! Cameras that move.

use std::str::FromStr;

use sorb::{
    glam::{Quat, Vec3},
    render::Camera,
};

/// A camera at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Key {
    /// Simulated time \[s\].
    time: f32,
    eye: Vec3,
    target: Vec3,
}

/// The camera of a film.
#[derive(Debug)]
pub(crate) struct Flight {
    /// The camera of the scene.
    base: Camera,
    /// In the order of their times.
    keys: Vec<Key>,
    /// Whole angle of the circle around the target \[rad\].
    orbit: f32,
}

impl FromStr for Key {
    type Err = String;

    /// Reads `TIME:X,Y,Z:X,Y,Z`.
    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || "expected TIME:EYE:TARGET, as in 1.5:0.3,0.2,0.4:0,0.05,0".to_owned();
        let number = |text: &str| text.trim().parse::<f32>().ok().filter(|number| number.abs() <= 1e4);
        let point = |text: &str| {
            let mut numbers = text.split(',').map(number);
            let point = Vec3::new(numbers.next()??, numbers.next()??, numbers.next()??);
            numbers.next().is_none().then_some(point)
        };
        let parts: Vec<&str> = text.split(':').collect();
        let [time, eye, target] = parts[..] else { return Err(expected()) };
        let read = || Some(Self { time: number(time)?, eye: point(eye)?, target: point(target)? });
        let key = read().ok_or_else(expected)?;
        if key.eye == key.target { Err("the eye is at its target".to_owned()) } else { Ok(key) }
    }
}

impl Flight {
    pub(crate) fn new(base: Camera, mut keys: Vec<Key>, orbit_degrees: f32) -> Self {
        keys.sort_by(|a, b| a.time.total_cmp(&b.time));
        Self { base, keys, orbit: orbit_degrees.to_radians() }
    }

    /// The camera at a simulated time \[s\], at a share of the film from 0 to 1.
    pub(crate) fn at(&self, time: f32, share: f32) -> Camera {
        let (eye, target) = self.between(time);
        let turned = Quat::from_rotation_y(self.orbit * share) * (eye - target);
        Camera { eye: target + turned, target, ..self.base }
    }

    /// Eye and target between the keys, with a smooth start and end of every way.
    fn between(&self, time: f32) -> (Vec3, Vec3) {
        let after = self.keys.iter().position(|key| key.time > time);
        let (first, second) = match (after, self.keys.as_slice()) {
            (_, []) => return (self.base.eye, self.base.target),
            (Some(0), [first, ..]) => return (first.eye, first.target),
            (None, [.., last]) => return (last.eye, last.target),
            (Some(after), keys) => (keys[after - 1], keys[after]),
        };
        let share = (time - first.time) / (second.time - first.time).max(1e-6);
        let share = share * share * (3.0 - 2.0 * share);
        (first.eye.lerp(second.eye, share), first.target.lerp(second.target, share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_and_passed_through() {
        let base = Camera::framing(Vec3::ZERO, Vec3::ONE);
        let keys = ["2:1,2,3:0,0,0", "1:3,2,1:0,1,0"].map(|text| text.parse::<Key>().expect("a key"));
        let flight = Flight::new(base, keys.to_vec(), 0.0);
        assert_eq!(flight.at(1.0, 0.0).eye, Vec3::new(3.0, 2.0, 1.0));
        assert_eq!(flight.at(1.5, 0.5).eye, Vec3::new(2.0, 2.0, 2.0));
        assert_eq!(flight.at(0.0, 0.0).eye, flight.at(1.0, 0.0).eye);
        assert_eq!(flight.at(9.0, 1.0).target, Vec3::ZERO);
        for bad in
            ["", "1", "1:2,3:4,5,6", "1:1,2,3:4,5,6,7", "x:1,2,3:4,5,6", "1:1,2,3:1,2,3", "1:1,2,nan:0,0,0"]
        {
            assert!(bad.parse::<Key>().is_err(), "{bad}");
        }
    }

    #[test]
    fn an_orbit_ends_where_it_began() {
        let base = Camera::framing(Vec3::ZERO, Vec3::ONE);
        let flight = Flight::new(base, Vec::new(), 360.0);
        let eye = |share: f32| flight.at(0.0, share).eye;
        assert!(eye(1.0).distance(base.eye) < 1e-4 && eye(0.5).distance(base.eye) > 1.0);
        let radius = |share: f32| eye(share).distance(base.target);
        assert!((radius(0.3) - radius(0.0)).abs() < 1e-4);
    }
}
