use super::RenderError;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// A picture: rows from top to bottom, three bytes (sRGB red, green, blue) a pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height * 3` bytes.
    pub pixels: Vec<u8>,
}

impl Image {
    /// Writes the image as a PNG file, replacing a file that is there.
    ///
    /// # Errors
    /// [`RenderError`] when a side is 0, when `pixels` has the wrong length, or when the file cannot be written.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<(), RenderError> {
        let path = path.as_ref();
        self.check(path)?;
        let file = File::create(path).map_err(|source| RenderError::write(path, source))?;
        let mut buffer = BufWriter::new(file);
        let mut encoder = png::Encoder::new(&mut buffer, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let write = |encoder: png::Encoder<'_, _>| {
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&self.pixels)?;
            writer.finish()
        };
        write(encoder).map_err(|source| RenderError::encode(path, source))?;
        buffer.flush().map_err(|source| RenderError::write(path, source))
    }

    /// Refuses images of another size than the frames of a film before.
    pub(super) fn check_frame(&self, path: &Path, expected: (u32, u32)) -> Result<(), RenderError> {
        let found = (self.width, self.height);
        if found != expected {
            return Err(RenderError::FrameSize { path: path.to_owned(), expected, found });
        }
        self.check(path)
    }

    /// Refuses images that a PNG file cannot hold.
    pub(super) fn check(&self, path: &Path) -> Result<(), RenderError> {
        check_size(path, self.width, self.height)?;
        let expected = self.width as usize * self.height as usize * 3;
        if self.pixels.len() != expected {
            return Err(RenderError::Pixels { path: path.to_owned(), expected, found: self.pixels.len() });
        }
        Ok(())
    }
}

/// Refuses sides that are 0 or longer than PNG allows.
pub(super) fn check_size(path: &Path, width: u32, height: u32) -> Result<(), RenderError> {
    let fits = |side: u32| side > 0 && i32::try_from(side).is_ok();
    if fits(width) && fits(height) {
        Ok(())
    } else {
        Err(RenderError::Size { path: path.to_owned(), width, height })
    }
}
