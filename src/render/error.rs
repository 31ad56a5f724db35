use std::path::{Path, PathBuf};

/// Why a picture or an animation could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The file could not be created or written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The PNG encoder refused the pixels.
    #[error("cannot encode {}: {source}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Error of the encoder.
        source: png::EncodingError,
    },
    /// A width or height of 0, or a side longer than PNG can hold.
    #[error("cannot write {}: a picture of {width} x {height} pixels; each side must be 1 to 2147483647", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The pixel buffer does not hold three bytes for every pixel.
    #[error("cannot write {}: {found} bytes of pixels where {expected} are needed (width x height x 3)", path.display())]
    Pixels {
        /// The file.
        path: PathBuf,
        /// Bytes needed.
        expected: usize,
        /// Bytes in the image.
        found: usize,
    },
    /// A frame differs in size from its animation.
    #[error("{}: a frame of {found:?} pixels in an animation of {expected:?}", path.display())]
    FrameSize {
        /// The file.
        path: PathBuf,
        /// Width and height of the animation.
        expected: (u32, u32),
        /// Width and height of the frame.
        found: (u32, u32),
    },
    /// A frame rate outside the range.
    #[error("{}: frames_per_second is {value}; it must be 0.02 to 1000", path.display())]
    FrameRate {
        /// The file.
        path: PathBuf,
        /// The requested rate.
        value: f32,
    },
    /// Sides that the encoder of films does not take.
    #[cfg(feature = "film")]
    #[error("{}: a film of {width} x {height} pixels; it may have 16 x 16 to 3840 x 2160", path.display())]
    FilmSize {
        /// The file.
        path: PathBuf,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The encoder or the file of a film refused a frame.
    #[cfg(feature = "film")]
    #[error("cannot write {}: {message}", path.display())]
    Film {
        /// The file.
        path: PathBuf,
        /// Message of the encoder.
        message: String,
    },
    /// The animation was finished before its first frame: no valid file is possible.
    #[error("{}: an animation needs at least one frame", path.display())]
    NoFrames {
        /// The file.
        path: PathBuf,
    },
}

impl RenderError {
    pub(super) fn write(path: &Path, source: std::io::Error) -> Self {
        Self::Write { path: path.to_owned(), source }
    }

    pub(super) fn encode(path: &Path, source: png::EncodingError) -> Self {
        match source {
            png::EncodingError::IoError(source) => Self::write(path, source),
            source => Self::Encode { path: path.to_owned(), source },
        }
    }
}
