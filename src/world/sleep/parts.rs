//! Parts of a scene that sleep separately, and the islands that they form.
//!
//! The water, every sponge and every dynamic body is a part. Parts whose boxes, enlarged by their reach, meet are an island:
//! they can touch, or are about to. Islands fall asleep as a whole. An awake part wakes the parts within its reach. Islands
//! are joined at [`JOIN`] times the reach. A part that a neighbour has just woken then shares its island, and does not fall
//! asleep while the neighbour moves.

use glam::Vec3;

use super::bounds::Bounds;

/// Reach of islands, over the reach of waking \[1\].
const JOIN: f32 = 1.5;

/// What a part is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// All particles.
    Fluid,
    /// A sponge, by its number.
    Sponge(usize),
    /// A dynamic body, by its number.
    Body(usize),
}

/// A part of a scene.
#[derive(Clone, Debug)]
pub(super) struct PartState {
    pub(super) kind: Kind,
    /// Distance beyond its box within which it can touch others; more than it moves in a step \[m\].
    pub(super) reach: f32,
    /// Its box at the last check of positions.
    pub(super) bounds: Bounds,
    pub(super) is_asleep: bool,
    /// Time since which it is awake \[s\].
    pub(super) awake_since: f64,
}

/// Data that all islands depend on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    /// Lengths of the box along periodic axes, else zero \[m\].
    pub(super) periods: Vec3,
    /// Whether sponges have properties that depend on wetness, which change after the water has gone: then all of them are
    /// one island with it.
    pub(super) has_wetting: bool,
}

impl Rules {
    fn are_joined(&self, a: &PartState, b: &PartState) -> bool {
        let is_wetting =
            |a: &PartState, b: &PartState| matches!((a.kind, b.kind), (Kind::Fluid, Kind::Sponge(_)));
        let (near, far) = (a.bounds.grown(JOIN * a.reach), b.bounds.grown(JOIN * b.reach));
        self.has_wetting && (is_wetting(a, b) || is_wetting(b, a)) || near.meets(&far, self.periods)
    }

    /// For every part the first of its island, among the parts that count.
    pub(super) fn islands(&self, parts: &[PartState], counts: impl Fn(&PartState) -> bool) -> Vec<usize> {
        let mut first: Vec<usize> = (0..parts.len()).collect();
        for (a, part) in parts.iter().enumerate().filter(|(_, part)| counts(part)) {
            for (b, other) in parts[..a].iter().enumerate().filter(|(_, other)| counts(other)) {
                if !self.are_joined(part, other) {
                    continue;
                }
                let [mut low, mut high] = [a, b];
                while first[low] != low {
                    low = first[low];
                }
                while first[high] != high {
                    high = first[high];
                }
                first[low.max(high)] = low.min(high);
            }
        }
        // The first of a chain comes before all others of it.
        for index in 0..first.len() {
            first[index] = first[first[index]];
        }
        first
    }

    /// Whether an awake box comes within reach of a part.
    pub(super) fn is_reached(&self, part: &PartState, awake: &Bounds) -> bool {
        part.bounds.grown(part.reach).meets(awake, self.periods)
    }

    /// Whether an awake box is so near that a part must not fall asleep.
    pub(super) fn is_kept_awake(&self, part: &PartState, awake: &Bounds) -> bool {
        part.bounds.grown(JOIN * part.reach).meets(awake, self.periods)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(kind: Kind, low: f32, high: f32) -> PartState {
        let bounds = Bounds::of([[low, 0.0, 0.0, 0.0], [high, 0.0, 0.0, 0.0]].iter());
        PartState { kind, reach: 0.1, bounds, is_asleep: false, awake_since: 0.0 }
    }

    #[test]
    fn chains_are_one_island_in_any_order() {
        let mut parts = vec![
            part(Kind::Fluid, 0.0, 1.0),
            part(Kind::Sponge(0), 3.2, 4.0),
            part(Kind::Sponge(1), 1.2, 2.0),
            part(Kind::Body(0), 2.25, 2.95),
            part(Kind::Body(1), 5.0, 6.0),
        ];
        let rules = Rules { periods: Vec3::ZERO, has_wetting: false };
        assert_eq!(rules.islands(&parts, |_| true), [0, 0, 0, 0, 4]);
        // The control: without the middle one there are two.
        let without = rules.islands(&parts, |part| part.kind != Kind::Body(0));
        assert_eq!(without, [0, 1, 0, 3, 4]);
        parts.reverse();
        assert_eq!(rules.islands(&parts, |_| true), [0, 1, 1, 1, 1]);
        let wetting = Rules { has_wetting: true, ..rules };
        let parts =
            [part(Kind::Sponge(0), 0.0, 1.0), part(Kind::Body(0), 2.0, 3.0), part(Kind::Fluid, 4.0, 5.0)];
        assert_eq!(wetting.islands(&parts, |_| true), [0, 1, 0]);
        assert_eq!(rules.islands(&parts, |_| true), [0, 1, 2]);
    }

    #[test]
    fn what_wakes_a_part_is_in_an_island_with_it() {
        let rules = Rules { periods: Vec3::ZERO, has_wetting: false };
        let own = part(Kind::Sponge(0), 0.0, 1.0);
        for apart in [0.05, 0.15, 0.19, 0.21, 0.29, 0.31] {
            let other = part(Kind::Sponge(1), 1.0 + apart, 2.0);
            let wakes = rules.is_reached(&own, &other.bounds.grown(other.reach));
            let joins = rules.islands(&[own.clone(), other], |_| true) == [0, 0];
            assert_eq!((wakes, joins), (apart < 0.2, apart < 0.3), "{apart}");
        }
    }
}
