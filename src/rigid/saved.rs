//! Bytes of engines.

use serde::{Serialize, de::DeserializeOwned};

use super::{BodyKind, RigidError, Target};

/// Appends a value.
pub(super) fn append(value: &impl Serialize, out: &mut Vec<u8>) -> Result<(), RigidError> {
    let before = std::mem::take(out);
    match postcard::to_extend(value, before) {
        Ok(all) => *out = all,
        Err(error) => return Err(RigidError::Saved { reason: error.to_string() }),
    }
    Ok(())
}

/// Reads a value that takes all bytes.
pub(super) fn read<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, RigidError> {
    let fail = |reason: String| RigidError::Saved { reason };
    let (value, rest) = postcard::take_from_bytes(bytes).map_err(|error| fail(error.to_string()))?;
    if rest.is_empty() { Ok(value) } else { Err(fail(format!("{} bytes are left over", rest.len()))) }
}

/// Refuses a time or targets that bodies of these kinds cannot have.
pub(super) fn check_targets(
    time: f64,
    targets: &[Option<Target>],
    kinds: &[BodyKind],
) -> Result<(), RigidError> {
    let fail = |reason: String| Err(RigidError::Saved { reason });
    if targets.len() != kinds.len() {
        return fail(format!("{} bodies, and there are {}", targets.len(), kinds.len()));
    }
    if !time.is_finite() {
        return fail(format!("time = {time} s"));
    }
    for (index, (target, kind)) in targets.iter().zip(kinds).enumerate() {
        let is_bad = target.is_some_and(|target| *kind != BodyKind::Kinematic || !target.is_valid());
        if is_bad {
            return fail(format!("body number {index}: no target for a {kind:?} body: {target:?}"));
        }
    }
    Ok(())
}
