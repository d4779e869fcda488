//! The digest of a text: whether something is still what a file was made of.

use std::io::Read;

/// The digest of bytes as they come (FNV-1a, which needs no table and never changes).
#[derive(Debug)]
struct Digest(u64);

impl Digest {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: impl IntoIterator<Item = u8>) {
        const PRIME: u64 = 0x0000_0100_0000_01b3;
        let mix = |digest: u64, byte| (digest ^ u64::from(byte)).wrapping_mul(PRIME);
        self.0 = bytes.into_iter().fold(self.0, mix);
    }

    fn text(&self) -> String {
        format!("{:016x}", self.0)
    }
}

/// Returns the digest of bytes, as 16 digits.
pub fn digest(bytes: impl IntoIterator<Item = u8>) -> String {
    let mut digest = Digest::new();
    digest.add(bytes);
    digest.text()
}

/// Returns the number of bytes that a file holds and their digest.
///
/// # Errors
/// When it cannot be read.
pub(super) fn digest_of(file: &mut impl Read) -> std::io::Result<(u64, String)> {
    let (mut digest, mut n_bytes) = (Digest::new(), 0);
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok((n_bytes, digest.text())),
            n => {
                digest.add(buffer[..n].iter().copied());
                n_bytes += n as u64;
            }
        }
    }
}
