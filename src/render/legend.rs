//! The legend of a colour map: a bar with its quantity, unit and range.

use super::Image;
use super::colour::map_as_displayed;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Distance from the border of the picture, and between bar and text (pixels).
const MARGIN: usize = 12;
const GAP: usize = 4;
/// Height of the bar (pixels).
const BAR: usize = 12;
/// Height of the text (pixels).
const TEXT: RasterHeight = RasterHeight::Size16;
const INK: u8 = 38;

/// Draws the legend into the lower left corner of a picture; nothing on pictures that are too small for it.
pub(super) fn draw(image: &mut Image, title: &str, (low, high): (f32, f32)) {
    let (width, height) = (image.width as usize, image.height as usize);
    let bar = (width / 4).max(160);
    let needed = 2 * MARGIN + BAR + 2 * (TEXT.val() + GAP);
    if 2 * (bar + MARGIN) > width || needed > height / 2 {
        return;
    }
    let top = height - MARGIN - TEXT.val() - GAP - BAR;
    for y in top..top + BAR {
        for x in 0..bar {
            let colour = map_as_displayed(x as f32 / (bar - 1) as f32) * 255.0 + 0.5;
            let at = (y * width + MARGIN + x) * 3;
            image.pixels[at..at + 3].copy_from_slice(&colour.to_array().map(|channel| channel as u8));
        }
    }
    write(image, title, MARGIN, top - GAP - TEXT.val());
    let below = top + BAR + GAP;
    write(image, &number(low), MARGIN, below);
    let most = number(high);
    let length = most.chars().count() * get_raster_width(FontWeight::Regular, TEXT);
    write(image, &most, MARGIN + bar - length.min(bar), below);
}

/// Writes a line of text with its upper left corner at a place (pixels).
fn write(image: &mut Image, text: &str, left: usize, top: usize) {
    let width = image.width as usize;
    let advance = get_raster_width(FontWeight::Regular, TEXT);
    for (place, letter) in text.chars().enumerate() {
        let Some(glyph) = get_raster(letter, FontWeight::Regular, TEXT) else { continue };
        for (row, line) in glyph.rows().enumerate() {
            for (column, cover) in line.iter().enumerate() {
                let (x, y) = (left + place * advance + column, top + row);
                if x < width && y < image.height as usize {
                    for channel in &mut image.pixels[(y * width + x) * 3..][..3] {
                        let (under, cover) = (u16::from(*channel), u16::from(*cover));
                        *channel = ((under * (255 - cover) + u16::from(INK) * cover) / 255) as u8;
                    }
                }
            }
        }
    }
}

/// A number with at most three digits after the point, without zeros at its end.
fn number(value: f32) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_drawn_on_large_pictures_only() {
        for (width, height, expected) in [(640, 360, true), (192, 108, false), (1, 1, false)] {
            let mut image = Image { width, height, pixels: vec![200; (width * height * 3) as usize] };
            let before = image.clone();
            draw(&mut image, "speed (m/s)", (0.0, 2.5));
            assert_eq!(image != before, expected, "{width}");
        }
        assert_eq!([number(0.0), number(2.5), number(1000.0), number(0.125)], ["0", "2.5", "1000", "0.125"]);
    }
}
