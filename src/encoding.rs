//! Encodings of texts: what bytes of files mean as letters.

/// The encoding of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// UTF-8, with or without a byte order mark, which is then the first character
    #[default]
    Utf8,
    /// a byte per character: Latin-1 with the euro, dashes and curved quotes of Windows
    Windows1252,
    /// two bytes per character, the lower one first or last
    Utf16 {
        /// the higher byte stands first
        big_endian: bool,
    },
}

impl Encoding {
    /// Guesses the encoding of these bytes.
    ///
    /// UTF-16 is known by its byte order mark, or, without one, by zero bytes beside the first
    /// characters, which are plain letters in any dataset. Bytes that would not come back as they
    /// were are taken as Windows-1252.
    pub(crate) fn of(bytes: &[u8]) -> Self {
        let wide = |big_endian| Encoding::Utf16 { big_endian };
        let guess = match *bytes {
            [0xFF, 0xFE, ..] => wide(false),
            [0xFE, 0xFF, ..] => wide(true),
            [a, 0, b, 0, ..] if a > 0 && b > 0 => wide(false),
            [0, a, 0, b, ..] if a > 0 && b > 0 => wide(true),
            _ if std::str::from_utf8(bytes).is_ok() => Encoding::Utf8,
            _ => Encoding::Windows1252,
        };
        if guess == Encoding::Utf8 {
            return guess;
        }
        match guess.decode(bytes) {
            Some(text) if guess.encode(&text) == bytes => guess,
            _ if std::str::from_utf8(bytes).is_ok() => Encoding::Utf8,
            _ => Encoding::Windows1252,
        }
    }

    /// Returns the text of bytes; `None`: they are none of this encoding. A byte order mark is its
    /// first character.
    pub(crate) fn decode(self, bytes: &[u8]) -> Option<String> {
        match self {
            Encoding::Utf8 => std::str::from_utf8(bytes).ok().map(str::to_owned),
            Encoding::Windows1252 => Some(bytes.iter().map(|&b| letter(b)).collect()),
            Encoding::Utf16 { big_endian } => {
                let (pairs, rest) = bytes.as_chunks::<2>();
                let number = if big_endian {
                    u16::from_be_bytes
                } else {
                    u16::from_le_bytes
                };
                let units: Vec<u16> = pairs.iter().map(|&pair| number(pair)).collect();
                String::from_utf16(&units).ok().filter(|_| rest.is_empty())
            }
        }
    }

    /// Returns the bytes of a text; in UTF-8 if it has letters that this encoding lacks.
    pub(crate) fn encode(self, text: &str) -> Vec<u8> {
        let utf8 = || text.as_bytes().to_vec();
        match self {
            Encoding::Utf8 => utf8(),
            Encoding::Windows1252 => {
                let bytes: Option<Vec<u8>> = text.chars().map(byte).collect();
                bytes.unwrap_or_else(utf8)
            }
            Encoding::Utf16 { big_endian } => {
                let bytes = |unit: u16| match big_endian {
                    true => unit.to_be_bytes(),
                    false => unit.to_le_bytes(),
                };
                text.encode_utf16().flat_map(bytes).collect()
            }
        }
    }
}

/// Letters of the bytes 0x80 to 0x9F in Windows-1252, which differs from Latin-1 in these alone. A
/// library for them would bring the letters of East Asia and five libraries of its own, and writes
/// no UTF-16.
const WINDOWS: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// Returns the letter of a byte in Windows-1252.
fn letter(byte: u8) -> char {
    let place = usize::from(byte).checked_sub(0x80);
    let windows = place.and_then(|place| WINDOWS.get(place));
    windows.copied().unwrap_or(char::from(byte))
}

/// Returns the byte of a letter in Windows-1252; `None`: it has none.
fn byte(letter: char) -> Option<u8> {
    match WINDOWS.iter().position(|&windows| windows == letter) {
        Some(place) => u8::try_from(0x80 + place).ok(),
        None => u8::try_from(letter)
            .ok()
            .filter(|b| !(0x80..0xA0).contains(b)),
    }
}

/// Returns the bytes of a text as UTF-8, without a byte order mark.
pub fn as_utf8(mut bytes: Vec<u8>) -> Vec<u8> {
    const MARK: &[u8] = "\u{feff}".as_bytes();
    let encoding = Encoding::of(&bytes);
    if encoding != Encoding::Utf8 {
        bytes = match encoding.decode(&bytes) {
            Some(text) => text.into_bytes(),
            None => bytes,
        };
    }
    if bytes.starts_with(MARK) {
        bytes.drain(..MARK.len());
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_in_any_encoding_is_the_same_text() {
        let text = "time,Höhe.DX\nsec,mm\n0,1\n";
        let wide = |big: fn(u16) -> [u8; 2], marked: &str| -> Vec<u8> {
            let all = format!("{marked}{text}");
            all.encode_utf16().flat_map(big).collect()
        };
        for bytes in [
            text.as_bytes().to_vec(),
            format!("\u{feff}{text}").into_bytes(),
            text.chars().map(|c| c as u8).collect(),
            wide(u16::to_le_bytes, "\u{feff}"),
            wide(u16::to_be_bytes, "\u{feff}"),
            wide(u16::to_le_bytes, ""),
        ] {
            assert_eq!(String::from_utf8(as_utf8(bytes)).as_deref(), Ok(text));
        }
        assert!(as_utf8(Vec::new()).is_empty());
    }

    #[test]
    fn every_byte_is_a_letter_and_comes_back() {
        let all: Vec<u8> = (1..=255).collect();
        assert_eq!(Encoding::of(&all), Encoding::Windows1252);
        let text = Encoding::Windows1252.decode(&all).expect("a letter each");
        assert_eq!(text.chars().count(), all.len());
        assert!(text.contains("€") && text.contains("„") && text.contains("ÿ"));
        assert_eq!(Encoding::Windows1252.encode(&text), all);
        // a letter that it lacks
        assert_eq!(Encoding::Windows1252.encode("Ω"), "Ω".as_bytes());
    }
}
