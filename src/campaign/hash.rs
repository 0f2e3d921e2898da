//! A hash that identifies specs (FNV-1a, 64 bits): the same on every computer.

/// The hash of some bytes as 16 hexadecimal digits.
pub(super) fn hash<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> String {
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for part in parts {
        // The length keeps two parts apart.
        for byte in part.iter().copied().chain(part.len().to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    format!("{hash:016x}")
}

/// A number that follows from a seed and some counters (SplitMix64).
pub(super) fn number(seed: u64, counters: [u64; 2]) -> u64 {
    let mut state = seed;
    for counter in counters {
        state = mixed(state.wrapping_add(counter.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
    }
    state
}

fn mixed(mut state: u64) -> u64 {
    state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    state ^ (state >> 31)
}

/// The same as a number from 0 to below 1.
pub(super) fn share(seed: u64, counters: [u64; 2]) -> f64 {
    (number(seed, counters) >> 11) as f64 / (1_u64 << 53) as f64
}
