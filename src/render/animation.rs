use super::image::check_size;
use super::{Image, RenderError};
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Largest difference of a channel (of 255) to the previous frame at which a pixel is not stored again.
///
/// The comparison is with what the viewer has on screen, so the error does not add up over frames.
const TOLERANCE: u8 = 2;
/// Where the chunk with the number of frames starts: after the signature (8 bytes) and the header chunk (25 bytes).
const CONTROL_OFFSET: u64 = 33;
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// An animated PNG file that repeats for ever, written frame by frame.
///
/// Only changed pixels are stored. The file is complete after [`Animation::finish`], with any number of frames. Dropping the
/// value finishes it too, and ignores errors.
#[derive(Debug)]
pub struct Animation {
    path: PathBuf,
    file: BufWriter<File>,
    width: u32,
    height: u32,
    delay: (u16, u16),
    declared: u32,
    frames: u32,
    sequence: u32,
    canvas: Vec<u8>,
    finished: bool,
}

impl Animation {
    /// Creates the file, replacing an existing one; `frames` is the expected number and may turn out wrong.
    ///
    /// `frames_per_second` is 0.02 to 1000.
    ///
    /// # Errors
    /// [`RenderError`] when a side is 0, the rate is out of range or the file cannot be created.
    pub fn create(
        path: impl AsRef<Path>,
        width: u32,
        height: u32,
        frames_per_second: f32,
        frames: u32,
    ) -> Result<Self, RenderError> {
        let path = path.as_ref();
        check_size(path, width, height)?;
        let delay = delay(frames_per_second)
            .ok_or_else(|| RenderError::FrameRate { path: path.to_owned(), value: frames_per_second })?;
        let file = File::create(path).map_err(|source| RenderError::write(path, source))?;
        let mut animation = Self {
            path: path.to_owned(),
            file: BufWriter::new(file),
            width,
            height,
            delay,
            declared: frames.max(1),
            frames: 0,
            sequence: 0,
            canvas: Vec::new(),
            finished: false,
        };
        animation.header().map_err(|source| RenderError::write(path, source))?;
        Ok(animation)
    }

    /// Number of frames appended so far.
    #[must_use]
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Appends one frame.
    ///
    /// # Errors
    /// [`RenderError`] when the image has another size than the animation or the file cannot be written.
    pub fn append(&mut self, image: &Image) -> Result<(), RenderError> {
        image.check_frame(&self.path, (self.width, self.height))?;
        let patch = if self.frames == 0 { Patch::whole(image) } else { Patch::changes(image, &self.canvas) };
        let data = patch.compress().map_err(|source| RenderError::encode(&self.path, source))?;
        self.frame(&patch, &data).map_err(|source| RenderError::write(&self.path, source))?;
        if self.frames == 0 {
            self.canvas.clone_from(&image.pixels);
        } else {
            patch.apply(&mut self.canvas, self.width as usize);
        }
        self.frames += 1;
        Ok(())
    }

    /// Completes the file and returns the number of frames in it.
    ///
    /// # Errors
    /// [`RenderError`] when there is no frame or the file cannot be written.
    pub fn finish(mut self) -> Result<u32, RenderError> {
        self.complete()?;
        Ok(self.frames)
    }

    fn complete(&mut self) -> Result<(), RenderError> {
        self.finished = true;
        if self.frames == 0 {
            return Err(RenderError::NoFrames { path: self.path.clone() });
        }
        self.trailer().map_err(|source| RenderError::write(&self.path, source))
    }

    fn header(&mut self) -> std::io::Result<()> {
        self.file.write_all(&SIGNATURE)?;
        let mut header = Vec::with_capacity(13);
        header.extend(self.width.to_be_bytes());
        header.extend(self.height.to_be_bytes());
        // Eight bits, red green blue alpha, deflate, adaptive filters, not interlaced.
        header.extend([8, 6, 0, 0, 0]);
        chunk(&mut self.file, *b"IHDR", &header)?;
        chunk(&mut self.file, *b"acTL", &control(self.declared))?;
        chunk(&mut self.file, *b"sRGB", &[0])
    }

    fn frame(&mut self, patch: &Patch, data: &[u8]) -> std::io::Result<()> {
        let mut control = Vec::with_capacity(26);
        for value in [self.sequence, patch.width, patch.height, patch.x, patch.y] {
            control.extend(value.to_be_bytes());
        }
        control.extend(self.delay.0.to_be_bytes());
        control.extend(self.delay.1.to_be_bytes());
        // Leave the canvas as it is afterwards; blend over it, except for the first frame, which replaces it.
        control.extend([0, u8::from(self.frames > 0)]);
        chunk(&mut self.file, *b"fcTL", &control)?;
        self.sequence += 1;
        if self.frames == 0 {
            return chunk(&mut self.file, *b"IDAT", data);
        }
        let mut body = Vec::with_capacity(data.len() + 4);
        body.extend(self.sequence.to_be_bytes());
        body.extend(data);
        self.sequence += 1;
        chunk(&mut self.file, *b"fdAT", &body)
    }

    fn trailer(&mut self) -> std::io::Result<()> {
        chunk(&mut self.file, *b"IEND", &[])?;
        if self.frames != self.declared {
            self.file.seek(SeekFrom::Start(CONTROL_OFFSET))?;
            chunk(&mut self.file, *b"acTL", &control(self.frames))?;
        }
        self.file.flush()
    }
}

impl Drop for Animation {
    fn drop(&mut self) {
        if !self.finished {
            // A destructor cannot return errors; `finish` does.
            let _ = self.complete();
        }
    }
}

/// The rectangle of a frame that differs from the canvas; unchanged pixels in it are transparent.
struct Patch {
    x: u32,
    y: u32,
    width: u32,
    height: u32,
    /// Red, green, blue, alpha.
    pixels: Vec<u8>,
}

impl Patch {
    fn whole(image: &Image) -> Self {
        let pixels = image.pixels.as_chunks::<3>().0.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
        Self { x: 0, y: 0, width: image.width, height: image.height, pixels }
    }

    fn changes(image: &Image, canvas: &[u8]) -> Self {
        let (new, old) = (image.pixels.as_chunks::<3>().0, canvas.as_chunks::<3>().0);
        let changed = |i: usize| (0..3).any(|c| new[i][c].abs_diff(old[i][c]) > TOLERANCE);
        // A frame of an animation must not be empty: without changes, one transparent pixel stands for the previous frame.
        let (mut left, mut right, mut top, mut bottom) = (u32::MAX, 0, u32::MAX, 0);
        for y in 0..image.height {
            let row = y as usize * image.width as usize;
            let mut hits = (0..image.width).filter(|&x| changed(row + x as usize));
            if let Some(first) = hits.next() {
                let last = hits.next_back().unwrap_or(first);
                left = left.min(first);
                right = right.max(last);
                top = top.min(y);
                bottom = y;
            }
        }
        if left == u32::MAX {
            (left, top) = (0, 0);
        }
        let (width, height) = (right - left + 1, bottom - top + 1);
        let mut pixels = Vec::with_capacity(width as usize * height as usize * 4);
        for y in top..=bottom {
            for x in left..=right {
                let i = y as usize * image.width as usize + x as usize;
                let [r, g, b] = new[i];
                pixels.extend(if changed(i) { [r, g, b, 255] } else { [0; 4] });
            }
        }
        Self { x: left, y: top, width, height, pixels }
    }

    /// Brings the copy of the screen up to date.
    fn apply(&self, canvas: &mut [u8], canvas_width: usize) {
        let canvas = canvas.as_chunks_mut::<3>().0;
        let rows = self.pixels.as_chunks::<4>().0.chunks(self.width as usize);
        for (row, pixels) in rows.enumerate() {
            let start = (self.y as usize + row) * canvas_width + self.x as usize;
            for (target, &[r, g, b, a]) in canvas[start..].iter_mut().zip(pixels) {
                if a > 0 {
                    *target = [r, g, b];
                }
            }
        }
    }

    /// The compressed pixel stream, taken out of a PNG that lives in memory only.
    fn compress(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Balanced);
        encoder.set_filter(png::Filter::Adaptive);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        writer.finish()?;
        let mut data = Vec::with_capacity(bytes.len());
        let mut rest = &bytes[SIGNATURE.len()..];
        while let Some((&head, tail)) = rest.split_first_chunk::<8>() {
            let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
            if head[4..] == *b"IDAT" {
                data.extend(&tail[..length]);
            }
            rest = &tail[length + 4..];
        }
        Ok(data)
    }
}

/// Contents of the chunk with the number of frames, repeated for ever.
fn control(frames: u32) -> [u8; 8] {
    let mut bytes = [0; 8];
    bytes[..4].copy_from_slice(&frames.to_be_bytes());
    bytes
}

/// Seconds a frame stays, as a fraction of two 16-bit numbers.
fn delay(frames_per_second: f32) -> Option<(u16, u16)> {
    if !(0.02..=1000.0).contains(&frames_per_second) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "the range was checked; the value is at most 1e6")]
    let rate = (f64::from(frames_per_second) * 1000.0).round() as u32;
    let (numerator, denominator) = (1000, rate);
    let divisor = greatest_common_divisor(numerator, denominator);
    let (mut numerator, mut denominator) = (numerator / divisor, denominator / divisor);
    while denominator > u32::from(u16::MAX) {
        numerator = (numerator / 2).max(1);
        denominator /= 2;
    }
    Some((u16::try_from(numerator).ok()?, u16::try_from(denominator).ok()?))
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

fn chunk(writer: &mut impl Write, kind: [u8; 4], data: &[u8]) -> std::io::Result<()> {
    let length = u32::try_from(data.len()).map_err(|_| std::io::Error::other("a chunk above 4 GiB"))?;
    writer.write_all(&length.to_be_bytes())?;
    writer.write_all(&kind)?;
    writer.write_all(data)?;
    writer.write_all(&checksum(kind.iter().chain(data)).to_be_bytes())
}

/// CRC-32 as PNG defines it.
fn checksum<'a>(bytes: impl Iterator<Item = &'a u8>) -> u32 {
    const TABLE: [u32; 256] = {
        let mut table = [0; 256];
        let mut i = 0;
        let mut seed: u32 = 0;
        while i < 256 {
            let mut value = seed;
            let mut bit = 0;
            while bit < 8 {
                value = if value & 1 == 1 { 0xEDB8_8320 ^ (value >> 1) } else { value >> 1 };
                bit += 1;
            }
            table[i] = value;
            i += 1;
            seed += 1;
        }
        table
    };
    !bytes.fold(u32::MAX, |crc, &byte| TABLE[usize::from(crc.to_le_bytes()[0] ^ byte)] ^ (crc >> 8))
}
