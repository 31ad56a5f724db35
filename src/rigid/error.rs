use super::BodyKind;
#[cfg(feature = "rigid")]
use super::HullError;

/// Why bodies could not be built or moved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RigidError {
    /// A number of a body is out of its range.
    #[error("body `{body}`: {key} = {value} is out of range: {range}")]
    Value {
        /// Name of the body.
        body: String,
        /// The key, with its path inside the body, as in `motions[0].end`.
        key: String,
        /// The offending value.
        value: String,
        /// What is accepted.
        range: &'static str,
    },
    /// A body has something that its kind does not allow.
    #[error("body `{body}`: `{key}` does not fit a {kind:?} body: {reason}")]
    Kind {
        /// Name of the body.
        body: String,
        /// The offending key.
        key: &'static str,
        /// Kind of the body.
        kind: BodyKind,
        /// What is accepted.
        reason: &'static str,
    },
    /// A dynamic body was given to an engine that supports only fixed and kinematic ones.
    #[error("body `{body}` is dynamic: build with the feature `rigid`, or make it fixed or kinematic")]
    DynamicUnsupported {
        /// Name of the body.
        body: String,
    },
    /// A convex hull is not usable.
    #[cfg(feature = "rigid")]
    #[error("body `{body}`: shape: {source}")]
    Hull {
        /// Name of the body.
        body: String,
        /// What is wrong with it.
        source: HullError,
    },
    /// The gravity is not finite.
    #[error("gravity = {value} is out of range: finite numbers [m/s²]")]
    Gravity {
        /// The offending value.
        value: String,
    },
    /// The container is empty, inverted or not a number.
    #[error(
        "container = {value} is out of range: min < max on every axis [m]; an infinite bound leaves that side open"
    )]
    Container {
        /// The offending value.
        value: String,
    },
    /// A dynamic body starts with its centre outside the container.
    #[error("body `{body}`: position = {value} lies outside the container {container}")]
    OutsideContainer {
        /// Name of the body.
        body: String,
        /// Its centre.
        value: String,
        /// Corners of the container.
        container: String,
    },
    /// The step length is unusable.
    #[error("dt = {dt} is out of range: finite and above 0 [s]")]
    TimeStep {
        /// The offending value \[s\].
        dt: f32,
    },
    /// The number of wrenches differs from the number of bodies.
    #[error("{found} wrenches for {expected} bodies: give one per body, in order")]
    WrenchCount {
        /// Number of bodies.
        expected: usize,
        /// Number of wrenches.
        found: usize,
    },
    /// A wrench is not a number, or too large for the body's mass in `f32`.
    #[error("body `{body}` (number {index}): {quantity} = {value} is not finite, or too large for its mass")]
    Wrench {
        /// Name of the body.
        body: String,
        /// Number of the body.
        index: usize,
        /// `impulse` or `angular_impulse`.
        quantity: &'static str,
        /// The offending value.
        value: String,
    },
    /// The state of a body stopped being finite.
    #[error("body `{body}` (number {index}): pose or velocity is no longer finite at t = {time} s")]
    Diverged {
        /// Name of the body.
        body: String,
        /// Number of the body.
        index: usize,
        /// Time at the end of the step \[s\].
        time: f64,
    },
    /// The engine lacks something that it may lack.
    #[error("the rigid-body engine supports no {what}")]
    Unsupported {
        /// What is missing.
        what: &'static str,
    },
    /// Saved bytes are not those of an engine of these bodies.
    #[error("saved bodies: {reason}")]
    Saved {
        /// What is wrong with them.
        reason: String,
    },
    /// A host's own engine failed.
    #[error("rigid-body engine: {message}")]
    Engine {
        /// Message of the engine.
        message: String,
    },
}
