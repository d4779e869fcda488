//! The digest of a text: whether something is still what a file was made of.

/// Returns the digest of bytes (FNV-1a, which needs no table and never changes), as 16 digits.
pub fn digest(bytes: impl IntoIterator<Item = u8>) -> String {
    const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    let mix = |digest: u64, byte| (digest ^ u64::from(byte)).wrapping_mul(PRIME);
    format!("{:016x}", bytes.into_iter().fold(OFFSET, mix))
}
