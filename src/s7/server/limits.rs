//! What a server allows: how many clients, from where, and how long anybody may take.

use std::net::IpAddr;
use std::time::Duration;

/// What a server allows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Clients at once. One more takes the place of the oldest connection that has not made any request; where there is none, it is sent
    /// away.
    pub clients: usize,
    /// From which networks they may come; from all where there is none.
    pub networks: Vec<Network>,
    /// How long a client may stay silent.
    pub idle: Duration,
    /// How long the first request may take; never longer than [`Limits::idle`].
    pub greeting: Duration,
    /// How long a client may take to take an answer.
    pub writing: Duration,
    /// How long an answer waits for the step that takes up a write.
    pub step: Duration,
    /// How long requests on their way have when the server ends.
    pub end: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            clients: 2048,
            networks: Vec::new(),
            idle: Duration::from_mins(10),
            greeting: Duration::from_secs(10),
            writing: Duration::from_secs(5),
            step: Duration::from_secs(1),
            end: Duration::from_secs(2),
        }
    }
}

/// Addresses that begin alike: `192.168.0.0/24`, `fd00::/8`, or one address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Network {
    address: IpAddr,
    bits: u32,
}

impl Network {
    /// Whether an address is in it. IPv4 in IPv6 (`::ffff:192.168.0.1`) counts as IPv4.
    #[must_use]
    pub fn contains(&self, address: IpAddr) -> bool {
        match (self.address, address.to_canonical()) {
            (IpAddr::V4(own), IpAddr::V4(other)) => {
                u64::from(own.to_bits() ^ other.to_bits()) >> 32_u32.saturating_sub(self.bits) == 0
            }
            (IpAddr::V6(own), IpAddr::V6(other)) => {
                (own.to_bits() ^ other.to_bits()).checked_shr(128_u32.saturating_sub(self.bits)).unwrap_or(0) == 0
            }
            (IpAddr::V4(_), IpAddr::V6(_)) | (IpAddr::V6(_), IpAddr::V4(_)) => false,
        }
    }
}

impl std::str::FromStr for Network {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected an address or a network such as 192.168.0.0/24 or fd00::/8, found {text}");
        let (address, bits) = text.split_once('/').map_or((text, None), |(address, bits)| (address, Some(bits)));
        let address: IpAddr = address.parse().map_err(|_| wrong())?;
        let most = if address.is_ipv4() { 32 } else { 128 };
        let bits = bits.map_or(Ok(most), str::parse).map_err(|_| wrong())?;
        if bits > most {
            return Err(wrong());
        }
        // IPv4 in IPv6 counts as IPv4 here, too, as far as all its bits before the IPv4 address are meant.
        match (address, address.to_canonical()) {
            (IpAddr::V6(_), IpAddr::V4(within)) if bits >= 96 => Ok(Self { address: within.into(), bits: bits - 96 }),
            _ => Ok(Self { address, bits }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ipv4_in_ipv6_is_ipv4_on_both_sides() {
        let has = |network: &str, address: &str| network.parse::<Network>().unwrap().contains(address.parse().unwrap());
        assert!(has("192.168.0.0/24", "::ffff:192.168.0.7") && has("::ffff:192.168.0.0/120", "192.168.0.7"));
        assert!(!has("::ffff:192.168.0.0/120", "192.168.1.7") && !has("192.168.0.0/24", "fd00::7"));
        assert!(has("0.0.0.0/0", "10.1.2.3") && has("::/0", "fd00::7") && !has("fd00::/8", "fe80::1"));
    }

    #[test]
    fn what_is_no_network_is_refused() {
        for text in ["", "192.168.0.0/33", "fd00::/129", "192.168.0/24", "host", "192.168.0.0/-1"] {
            assert!(text.parse::<Network>().is_err(), "{text}");
        }
    }
}
