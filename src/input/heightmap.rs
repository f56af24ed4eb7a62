//! Height maps: PNG pictures and tables of numbers.

use super::{Place, ReadError, ending, error::Format};
use crate::geom::Raster;

const PNG: Format = Format("PNG");
const TABLE: Format = Format("table");

/// Numbers that a height map may hold.
const MOST_VALUES: usize = 16_000_000;

/// The heights of a file, its format told by the ending of `name`. A picture (png) gives its lightness from 0 (black) to 1
/// (white), what is transparent counting as black; a table (csv, txt, dat, asc) its numbers, separated by commas,
/// semicolons or blanks, a line each row, lines that begin with # left out.
///
/// # Errors
/// Broken files, rows of different lengths, fewer than 2 x 2 numbers, more than sixteen million, numbers that are not
/// finite.
///
/// ```
/// use katachi::input::read_heights;
/// let heights = read_heights("hill.csv", b"0, 1, 0\n1, 2, 1\n").unwrap();
/// assert_eq!((heights.size(), heights.at(0.5, 1.0)), ([3, 2], 2.0));
/// ```
pub fn read_heights(name: &str, bytes: &[u8]) -> Result<Raster, ReadError> {
    match ending(name).as_str() {
        "png" => picture(bytes),
        "csv" | "txt" | "dat" | "asc" => table(TABLE.text(bytes)?),
        _ => {
            let known = ".png, .csv, .txt, .dat or .asc";
            Err(ReadError::Extension { name: name.to_string(), known })
        }
    }
}

fn within_limit(format: Format, values: usize) -> Result<(), ReadError> {
    if values <= MOST_VALUES {
        return Ok(());
    }
    Err(format.limit(format!("a map of {values} heights"), format!("{MOST_VALUES} heights")))
}

fn picture(bytes: &[u8]) -> Result<Raster, ReadError> {
    let broken = |error: png::DecodingError| {
        PNG.error(Place::File, error.to_string(), "a whole file is needed")
    };
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(broken)?;
    let info = reader.info();
    let (width, height) = (info.width as usize, info.height as usize);
    within_limit(PNG, width.saturating_mul(height))?;
    let (color, depth) = reader.output_color_type();
    let size = reader.output_buffer_size().unwrap_or(usize::MAX);
    let most = MOST_VALUES * 8;
    if size > most {
        return Err(PNG.limit(format!("a picture of {size} bytes"), format!("{most} bytes")));
    }
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data).map_err(broken)?;
    let wide = depth == png::BitDepth::Sixteen;
    let samples = color.samples() * if wide { 2 } else { 1 };
    let rows = data.chunks_exact(frame.line_size.max(1)).take(height);
    let pixels = rows.flat_map(|row| row.chunks_exact(samples).take(width));
    let sample = |pixel: &[u8], i: usize| match wide {
        true => f64::from(u16::from_be_bytes([pixel[2 * i], pixel[2 * i + 1]])) / 65535.0,
        false => f64::from(pixel[i]) / 255.0,
    };
    let value = |pixel: &[u8]| {
        let at = |i| sample(pixel, i);
        match color {
            png::ColorType::Grayscale | png::ColorType::Indexed => at(0),
            png::ColorType::GrayscaleAlpha => at(0) * at(1),
            png::ColorType::Rgb => luma([at(0), at(1), at(2)]),
            png::ColorType::Rgba => luma([at(0), at(1), at(2)]) * at(3),
        }
    };
    let found = format!("{width} x {height} pixels");
    Raster::new(width, pixels.map(value).collect())
        .ok_or_else(|| PNG.error(Place::File, found, "at least 2 x 2 are needed"))
}

/// Lightness of a colour after Rec. 601; grey stays as it is.
fn luma([r, g, b]: [f64; 3]) -> f64 {
    if r == g && g == b { r } else { 0.299 * r + 0.587 * g + 0.114 * b }
}

fn table(text: &str) -> Result<Raster, ReadError> {
    let (mut width, mut values) = (0, vec![]);
    for (line, row) in text.lines().enumerate() {
        let (place, before) = (Place::Line(line + 1), values.len());
        if row.trim_start().starts_with('#') {
            continue;
        }
        let parted = |c: char| c == ',' || c == ';' || c.is_whitespace();
        for word in row.split(parted).filter(|word| !word.is_empty()) {
            values.push(TABLE.number(word, place)?);
        }
        within_limit(TABLE, values.len())?;
        match values.len() - before {
            0 => {}
            found if width == 0 => width = found,
            found if found == width => {}
            found => {
                let needed = format!("{width} are needed, as in the first row");
                return Err(TABLE.error(place, format!("{found} numbers"), needed));
            }
        }
    }
    let rows = values.len() / width.max(1);
    Raster::new(width, values).ok_or_else(|| {
        let found = format!("{rows} rows of {width} numbers");
        TABLE.error(Place::File, found, "at least 2 x 2 are needed")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(color: png::ColorType, depth: png::BitDepth, width: u32, data: &[u8]) -> Vec<u8> {
        let mut bytes = vec![];
        let mut encoder = png::Encoder::new(&mut bytes, width, 2);
        encoder.set_color(color);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(data).expect("data");
        writer.finish().expect("an end");
        bytes
    }

    #[test]
    fn pictures_of_all_kinds() {
        use png::{BitDepth, ColorType};
        let grey = png(ColorType::Grayscale, BitDepth::Eight, 2, &[0, 255, 51, 102]);
        let grey = read_heights("a.png", &grey).expect("a picture");
        assert_eq!((grey.at(1.0, 0.0), grey.at(0.0, 1.0)), (1.0, 0.2));
        let bits = png(ColorType::Grayscale, BitDepth::One, 3, &[0b1010_0000, 0b0100_0000]);
        let bits = read_heights("a.PNG", &bits).expect("a picture");
        assert_eq!((bits.size(), bits.at(0.5, 1.0)), ([3, 2], 1.0));
        let wide = png(ColorType::GrayscaleAlpha, BitDepth::Sixteen, 2, &[255; 16]);
        assert_eq!(read_heights("a.png", &wide).expect("a picture").at(0.3, 0.3), 1.0);
        let color =
            png(ColorType::Rgb, BitDepth::Eight, 2, &[255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9]);
        let color = read_heights("a.png", &color).expect("a picture");
        assert!((color.at(0.0, 0.0) + color.at(1.0, 0.0) + color.at(0.0, 1.0) - 1.0).abs() < 1e-12);
        let mut cut = png(ColorType::Rgb, BitDepth::Eight, 2, &[0; 12]);
        cut.truncate(50);
        assert!(read_heights("a.png", &cut).is_err());
    }

    #[test]
    fn bad_tables_are_told() {
        let told =
            |text: &str| read_heights("a.csv", text.as_bytes()).expect_err("bad").to_string();
        assert_eq!(
            told("1 2\n3 4 5"),
            "table line 2: 3 numbers; 2 are needed, as in the first row"
        );
        assert_eq!(told("1 x"), "table line 1: \"x\"; a finite number is needed");
        assert_eq!(told("1 inf"), "table line 1: \"inf\"; a finite number is needed");
        assert_eq!(told("# nothing"), "table: 0 rows of 0 numbers; at least 2 x 2 are needed");
        assert!(read_heights("a.bmp", b"").is_err());
    }
}
