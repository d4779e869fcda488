//! Files of pictures: SVG as it is drawn here, PNG and PDF made from it.
//!
//! Words are set in a face that is part of the program, so that a picture has the same dots on
//! every machine. In a PDF they are outlines, which need no face to be read.

use crate::diagnostic::Diagnostic;
use crate::disk;
use std::path::Path;

/// A format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// lines and words, which any size suits
    Svg,
    /// dots
    Png,
    /// a page
    Pdf,
}

/// Dots of a PNG per px of the picture.
#[cfg(feature = "png")]
const DOTS_PER_PX: f32 = 2.0;

impl PictureFormat {
    /// The endings of names of files.
    pub const ENDINGS: [(PictureFormat, &'static str); 3] = [
        (PictureFormat::Svg, "svg"),
        (PictureFormat::Png, "png"),
        (PictureFormat::Pdf, "pdf"),
    ];

    /// Returns the format that the name of a file ends with, if it is one of pictures.
    pub fn of(file: &Path) -> Option<Self> {
        let ending = file.extension()?.to_str()?;
        let mut all = Self::ENDINGS.into_iter();
        let found = all.find(|(_, known)| ending.eq_ignore_ascii_case(known));
        found.map(|(format, _)| format)
    }

    /// Returns a picture in this format; `svg`: the text of the same picture as SVG.
    ///
    /// # Errors
    /// When the program was built without the feature of the format.
    pub fn bytes(self, svg: &str) -> Result<Vec<u8>, Diagnostic> {
        match self {
            PictureFormat::Svg => Ok(svg.as_bytes().to_vec()),
            PictureFormat::Png => png(svg),
            PictureFormat::Pdf => pdf(svg),
        }
    }
}

/// Returns the contents of a file of a picture, in the format of its name; `svg`: the text of the
/// picture as SVG.
///
/// # Errors
/// When no format of pictures has this ending, or it is none of this program.
pub fn bytes(svg: &str, file: &Path) -> Result<Vec<u8>, Diagnostic> {
    let Some(format) = PictureFormat::of(file) else {
        let what = format!("{}: pictures are .svg, .png and .pdf", disk::text(&file));
        return Err(Diagnostic::error("picture_format", what));
    };
    format.bytes(svg)
}

#[cfg(any(feature = "png", feature = "pdf"))]
fn failed(why: impl std::fmt::Display) -> Diagnostic {
    let what = format!("the picture could not be drawn: {why}");
    Diagnostic::error("plot_failed", what)
}

#[cfg(not(all(feature = "png", feature = "pdf")))]
fn left_out(feature: &str) -> Diagnostic {
    let what = format!("this program was built without the feature {feature}");
    Diagnostic::error("picture_format", what).help("write an .svg")
}

/// Reads the text of a picture, with the faces of the program and no others.
#[cfg(feature = "png")]
fn tree(svg: &str) -> Result<resvg::usvg::Tree, Diagnostic> {
    use resvg::usvg::{Options, Tree};
    let mut options = Options::default();
    let faces = options.fontdb_mut();
    // the second has signs that the first lacks
    for face in [
        epaint_default_fonts::UBUNTU_LIGHT,
        epaint_default_fonts::HACK_REGULAR,
    ] {
        faces.load_font_data(face.to_vec());
    }
    let first = faces.faces().next();
    let family = first.and_then(|face| face.families.first());
    if let Some((family, _)) = family.cloned() {
        faces.set_sans_serif_family(&family);
        faces.set_serif_family(&family);
        options.font_family = family;
    }
    Tree::from_str(svg, &options).map_err(failed)
}

#[cfg(feature = "png")]
fn png(svg: &str) -> Result<Vec<u8>, Diagnostic> {
    pixmap(svg, DOTS_PER_PX)?.encode_png().map_err(failed)
}

/// Draws a picture with so many dots a px.
#[cfg(feature = "png")]
fn pixmap(svg: &str, per_px: f32) -> Result<resvg::tiny_skia::Pixmap, Diagnostic> {
    use resvg::tiny_skia::{Pixmap, Transform};
    let tree = tree(svg)?;
    let size = tree.size();
    let dots = |px: f32| (px * per_px).ceil() as u32;
    let dots = Pixmap::new(dots(size.width()), dots(size.height()));
    let mut dots = dots.ok_or_else(|| failed("it has no size"))?;
    let larger = Transform::from_scale(per_px, per_px);
    resvg::render(&tree, larger, &mut dots.as_mut());
    Ok(dots)
}

/// Returns the dots of a picture, one a px, red, green and blue, with its width and height.
///
/// # Errors
/// When it cannot be drawn.
#[cfg(feature = "gif")]
pub(super) fn dots(svg: &str) -> Result<(Vec<[u8; 3]>, [u16; 2]), Diagnostic> {
    let dots = pixmap(svg, 1.0)?;
    let [Ok(width), Ok(height)] = [dots.width(), dots.height()].map(u16::try_from) else {
        return Err(failed("it is too large"));
    };
    // pictures have a ground, on which nothing is transparent
    let all = dots.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]);
    Ok((all.collect(), [width, height]))
}

#[cfg(not(feature = "png"))]
fn png(_: &str) -> Result<Vec<u8>, Diagnostic> {
    Err(left_out("png"))
}

#[cfg(feature = "pdf")]
fn pdf(svg: &str) -> Result<Vec<u8>, Diagnostic> {
    use resvg::usvg::{Options, Tree, WriteOptions};
    use svg2pdf::{ConversionOptions, PageOptions, to_pdf};
    let outlines = tree(svg)?.to_string(&WriteOptions::default());
    let tree = Tree::from_str(&outlines, &Options::default()).map_err(failed)?;
    to_pdf(&tree, ConversionOptions::default(), PageOptions::default()).map_err(failed)
}

#[cfg(not(feature = "pdf"))]
fn pdf(_: &str) -> Result<Vec<u8>, Diagnostic> {
    Err(left_out("pdf"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(feature = "pdf")]
    fn picture(word: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"20\" font-family=\"sans-serif\">\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/><text x=\"4\" y=\"15\">{word}</text></svg>"
        )
    }

    #[cfg(feature = "pdf")]
    #[test]
    fn words_leave_dots_and_outlines_whatever_faces_the_machine_has() {
        let blank = PictureFormat::Png.bytes(&picture("")).unwrap();
        // letters, signs of units, and what the first face lacks
        for word in ["slider", "ω ² ±", "→"] {
            let png = PictureFormat::Png.bytes(&picture(word)).unwrap();
            assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"), "{word}");
            assert_ne!(png, blank, "{word} leaves nothing");
            assert_eq!(png, PictureFormat::Png.bytes(&picture(word)).unwrap());
            let pdf = PictureFormat::Pdf.bytes(&picture(word)).unwrap();
            assert!(
                pdf.starts_with(b"%PDF-") && pdf.ends_with(b"%%EOF"),
                "{word}"
            );
        }
        let size =
            |bytes: &[u8], at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!((size(&blank, 16), size(&blank, 20)), (120, 40));
    }

    #[test]
    fn the_ending_of_a_name_is_the_format() {
        let of = |name: &str| PictureFormat::of(Path::new(name));
        assert_eq!(of("a/b.PNG"), Some(PictureFormat::Png));
        assert_eq!(of("b.svg.pdf"), Some(PictureFormat::Pdf));
        assert_eq!(of("png").or(of("b.txt")), None);
        assert!(bytes("", Path::new("b.txt")).is_err());
    }
}
