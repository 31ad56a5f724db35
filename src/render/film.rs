//! Films: H.264 in an MP4 file, which ordinary players open.

use super::image::check_size;
use super::{Image, RenderError};
use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Complexity, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, QpRange,
    RateControlMode, VuiConfig,
};
use openh264::formats::{RgbSliceU8, YUVBuffer};
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// Bits a pixel of a frame may take in the mean.
const BITS: f32 = 0.16;
/// Longest and shorter side that the encoder takes.
const LARGEST: (u32, u32) = (3840, 2160);
/// Seconds from one frame that stands alone to the next: players jump to those.
const WHOLE: f32 = 2.0;

/// An MP4 file, written frame by frame.
///
/// The file is complete after [`Film::finish`]; without it, it cannot be played. An odd last column or row of pixels is left out,
/// because the format halves the resolution of colours.
pub struct Film {
    path: PathBuf,
    muxer: Muxer<BufWriter<File>>,
    encoder: Encoder,
    width: u32,
    height: u32,
    rate: f32,
    frames: u32,
}

impl std::fmt::Debug for Film {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Film").field("path", &self.path).field("frames", &self.frames).finish_non_exhaustive()
    }
}

impl Film {
    /// Creates the file, replacing one that is there. `frames_per_second` is 0.02 to 1000.
    ///
    /// # Errors
    /// [`RenderError`] when a side is below 16 pixels or the film is larger than 3840 x 2160 pixels. Also when the rate is out of range, or
    /// the file cannot be created.
    pub fn create(
        path: impl AsRef<Path>,
        width: u32,
        height: u32,
        frames_per_second: f32,
    ) -> Result<Self, RenderError> {
        let path = path.as_ref();
        check_size(path, width, height)?;
        let (short, long) = (width.min(height), width.max(height));
        if short < 16 || short > LARGEST.1 || long > LARGEST.0 {
            return Err(RenderError::FilmSize { path: path.to_owned(), width, height });
        }
        if !(0.02..=1000.0).contains(&frames_per_second) {
            return Err(RenderError::FrameRate { path: path.to_owned(), value: frames_per_second });
        }
        let rate = frames_per_second;
        let (even_width, even_height) = (width & !1, height & !1);
        let bits = BITS * (even_width * even_height) as f32 * rate.max(1.0);
        let config = EncoderConfig::new()
            .bitrate(BitRate::from_bps(bits as u32))
            .max_frame_rate(FrameRate::from_hz(rate))
            .rate_control_mode(RateControlMode::Off)
            .qp(QpRange::new(14, 30))
            .skip_frames(false)
            .complexity(Complexity::Low)
            // One thread, so that the same pictures give the same file.
            .num_threads(1)
            .intra_frame_period(IntraFramePeriod::from_num_frames((WHOLE * rate).ceil().max(1.0) as u32))
            .vui(VuiConfig::bt601());
        let failed = |message: String| RenderError::Film { path: path.to_owned(), message };
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config)
            .map_err(|error| failed(error.to_string()))?;
        let file = File::create(path).map_err(|source| RenderError::write(path, source))?;
        let muxer = MuxerBuilder::new(BufWriter::new(file))
            .video(VideoCodec::H264, even_width, even_height, f64::from(rate))
            .with_fast_start(true)
            .build()
            .map_err(|error| failed(error.to_string()))?;
        Ok(Self { path: path.to_owned(), muxer, encoder, width, height, rate, frames: 0 })
    }

    /// Number of frames appended so far.
    #[must_use]
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Appends one frame.
    ///
    /// # Errors
    /// [`RenderError`] when the image has another size than the film, or when the file cannot be written.
    pub fn append(&mut self, image: &Image) -> Result<(), RenderError> {
        image.check_frame(&self.path, (self.width, self.height))?;
        let (width, height) = ((self.width & !1) as usize, (self.height & !1) as usize);
        let row = 3 * self.width as usize;
        let cut: Vec<u8>;
        let pixels = if row == 3 * width {
            &image.pixels[..row * height]
        } else {
            cut = image.pixels.chunks(row).take(height).flat_map(|row| &row[..3 * width]).copied().collect();
            &cut[..]
        };
        let colours = YUVBuffer::from_rgb8_source(RgbSliceU8::new(pixels, (width, height)));
        let encoded = self
            .encoder
            .encode(&colours)
            .map_err(|error| RenderError::Film { path: self.path.clone(), message: error.to_string() })?;
        let is_whole = matches!(encoded.frame_type(), FrameType::IDR | FrameType::I);
        let time = f64::from(self.frames) / f64::from(self.rate);
        let written = self.muxer.write_video(time, &encoded.to_vec(), is_whole);
        written.map_err(|error| RenderError::Film { path: self.path.clone(), message: error.to_string() })?;
        self.frames += 1;
        Ok(())
    }

    /// Completes the file and returns the number of frames in it.
    ///
    /// # Errors
    /// [`RenderError`] when there is no frame, or when the file cannot be written.
    pub fn finish(self) -> Result<u32, RenderError> {
        if self.frames == 0 {
            return Err(RenderError::NoFrames { path: self.path });
        }
        self.muxer
            .finish()
            .map_err(|error| RenderError::Film { path: self.path.clone(), message: error.to_string() })?;
        Ok(self.frames)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture with a bright square that moves.
    fn picture(width: u32, height: u32, frame: u32) -> Image {
        let bright = |x: u32, y: u32| (x + 64 - 3 * frame) % 64 < 16 && y % 48 < 16;
        let shade = |x: u32, y: u32| if bright(x, y) { 230 } else { 20 };
        let pixels = (0..height).flat_map(|y| (0..width).flat_map(move |x| [shade(x, y); 3])).collect();
        Image { width, height, pixels }
    }

    #[test]
    fn a_film_decodes_to_its_pictures() {
        let path = std::env::temp_dir().join(format!("sorb_film_{}.mp4", std::process::id()));
        for (width, height) in [(128, 96), (65, 49)] {
            let mut film = Film::create(&path, width, height, 30.0).expect("a film");
            for frame in 0..8 {
                film.append(&picture(width, height, frame)).expect("a frame");
            }
            assert!(film.append(&picture(width + 1, height, 0)).is_err(), "another size");
            assert_eq!(film.finish().expect("a file"), 8);
            let bytes = std::fs::read(&path).expect("the file is there");
            let has = |name: &[u8]| bytes.windows(4).any(|four| four == name);
            assert!(bytes[4..8] == *b"ftyp" && has(b"moov") && has(b"avcC") && has(b"mdat"));
        }
        assert!(Film::create(&path, 8, 8, 30.0).is_err() && Film::create(&path, 64, 64, 0.0).is_err());
        let empty = Film::create(&path, 64, 64, 30.0).expect("a film");
        assert!(empty.finish().is_err(), "no frames");
        // A folder of the system that stays behind holds nothing of ours.
        let _ = std::fs::remove_file(&path);
    }

    #[test]
    fn its_frames_are_the_pictures_and_not_others() {
        let (width, height) = (128, 96);
        let config = EncoderConfig::new().skip_frames(false).num_threads(1).qp(QpRange::new(14, 30));
        let mut encoder = Encoder::with_api_config(OpenH264API::from_source(), config).expect("an encoder");
        let mut decoder = openh264::decoder::Decoder::new().expect("a decoder");
        let shown: Vec<Image> = (0..3).map(|frame| picture(width, height, 4 * frame)).collect();
        let difference = |a: &[u8], b: &[u8]| {
            let sum: u64 = a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
            sum as f64 / a.len() as f64
        };
        for image in &shown {
            let source = RgbSliceU8::new(&image.pixels, (width as usize, height as usize));
            let encoded = encoder.encode(&YUVBuffer::from_rgb8_source(source)).expect("it encodes").to_vec();
            let Some(decoded) = decoder.decode(&encoded).expect("it decodes") else { continue };
            let mut pixels = vec![0; image.pixels.len()];
            decoded.write_rgb8(&mut pixels);
            assert!(difference(&pixels, &image.pixels) < 6.0);
            // Negative control: the picture before it is another one.
            let other = shown.iter().filter(|other| *other != image);
            assert!(other.map(|other| difference(&pixels, &other.pixels)).fold(f64::MAX, f64::min) > 8.0);
        }
    }
}
