//! Parts of scenes in commands and states. In binary formats they are text, because binary has no keys by which to tell tables of scenes
//! apart. For `#[serde(with = "crate::text")]`.

use serde::{
    Deserialize, Deserializer, Serialize, Serializer, de::DeserializeOwned, de::Error as _, ser::Error as _,
};

pub(crate) fn serialize<T: Serialize, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    if serializer.is_human_readable() {
        return value.serialize(serializer);
    }
    let text = serde_json::to_string(value).map_err(S::Error::custom)?;
    serializer.serialize_str(&text)
}

pub(crate) fn deserialize<'de, T: DeserializeOwned, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    if deserializer.is_human_readable() {
        return T::deserialize(deserializer);
    }
    let text = String::deserialize(deserializer)?;
    serde_json::from_str(&text).map_err(D::Error::custom)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Motion;
    use glam::Vec3;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Held(#[serde(with = "crate::text")] Motion);

    #[test]
    fn every_bit_comes_back() {
        for bits in [0x3dcc_cccd_u32, 0x3eaa_aaab, 0x0080_0001, 0x42c7_ffff, 0xbf7f_ffff] {
            let velocity = Vec3::new(f32::from_bits(bits), 0.0, -0.0);
            let motion = Held(Motion::Linear { velocity, start: 0.1, end: 1.0 / 3.0, ease: 0.01 });
            let bytes = postcard::to_stdvec(&motion).unwrap_or_else(|error| panic!("{error}"));
            let back: Held = postcard::from_bytes(&bytes).unwrap_or_else(|error| panic!("{error}"));
            let Motion::Linear { velocity: found, end, .. } = back.0 else { panic!("another motion") };
            assert_eq!(found.to_array().map(f32::to_bits), velocity.to_array().map(f32::to_bits));
            assert_eq!(end.to_bits(), (1.0_f32 / 3.0).to_bits());
        }
        assert!(postcard::from_bytes::<Held>(&[3, b'a', b'b', b'c']).is_err());
    }
}
