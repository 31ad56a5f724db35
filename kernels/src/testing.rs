//! Inputs for the tests of this package.

/// Points uniform in the cube of the given half edge, the same for the same seed.
pub(crate) fn random_points(count: usize, half_edge: f32, seed: u64) -> Vec<[f32; 4]> {
    let mut random = Random(seed);
    (0..count)
        .map(|_| {
            let mut next = || (random.unit() * 2.0 - 1.0) * half_edge;
            [next(), next(), next(), 0.0]
        })
        .collect()
}

/// A small generator of pseudo-random numbers (splitmix64).
#[derive(Clone, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 40) as f32 / (1_u64 << 24) as f32
    }
}
