//! Where pictures go: a still, an animated PNG or a film.

use std::path::{Path, PathBuf};

use sorb::render::{Animation, Image};

use crate::error::CliError;

/// A file of pictures while it is written.
#[derive(Debug)]
pub(crate) enum Sink {
    /// The last picture alone.
    Still(PathBuf, Option<Image>),
    /// An animated PNG.
    Animation(Animation),
    /// An MP4 file.
    #[cfg(feature = "film")]
    Film(Box<sorb::render::Film>),
}

/// Ending of the files of films that this build writes.
pub(crate) const FILM: &str = if cfg!(feature = "film") { "mp4" } else { "png" };

impl Sink {
    /// Creates a file by its ending: `.mp4`, or `.png` for a still or more than one picture.
    ///
    /// # Errors
    /// The ending is another one, this build has no films, or the file cannot be created.
    pub(crate) fn create(
        path: &Path,
        (width, height): (u32, u32),
        rate: f32,
        count: u32,
    ) -> Result<Self, CliError> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let rate = rate.clamp(0.02, 1e3);
        match ending {
            "png" | "apng" if count > 1 => {
                Ok(Self::Animation(Animation::create(path, width, height, rate, count)?))
            }
            "png" => Ok(Self::Still(path.to_owned(), None)),
            #[cfg(feature = "film")]
            "mp4" => Ok(Self::Film(Box::new(sorb::render::Film::create(path, width, height, rate)?))),
            #[cfg(not(feature = "film"))]
            "mp4" => Err(CliError::Usage(format!(
                "{}: this program was built without films; build it with `--features film`, or write a .png file",
                path.display()
            ))),
            _ => Err(CliError::Usage(format!("{}: pictures are written as .png or .mp4", path.display()))),
        }
    }

    /// Appends a picture.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn append(&mut self, image: &Image) -> Result<(), CliError> {
        match self {
            Self::Still(_, last) => *last = Some(image.clone()),
            Self::Animation(animation) => animation.append(image)?,
            #[cfg(feature = "film")]
            Self::Film(film) => film.append(image)?,
        }
        Ok(())
    }

    /// Completes the file.
    ///
    /// # Errors
    /// There was no picture, or the file cannot be written.
    pub(crate) fn finish(self) -> Result<(), CliError> {
        match self {
            Self::Still(path, Some(image)) => image.write_png(path)?,
            Self::Still(path, None) => {
                return Err(CliError::Usage(format!("{}: no picture is due in that time", path.display())));
            }
            Self::Animation(animation) => {
                animation.finish()?;
            }
            #[cfg(feature = "film")]
            Self::Film(film) => {
                film.finish()?;
            }
        }
        Ok(())
    }
}
