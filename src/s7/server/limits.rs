//! The limits of a server: number of clients, networks, and times.

use std::net::IpAddr;
use std::time::Duration;

/// The limits of a server.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Maximum number of clients. A further client takes the place of the oldest connection without a request; if there is none, it is
    /// rejected.
    pub clients: usize,
    /// Allowed networks; an empty list allows all.
    pub networks: Vec<Network>,
    /// Idle timeout.
    pub idle: Duration,
    /// Time limit for the first request; never longer than [`Limits::idle`].
    pub greeting: Duration,
    /// Time limit for a client to read an answer.
    pub writing: Duration,
    /// Time limit for the step that executes a write, before the answer is sent.
    pub step: Duration,
    /// Time limit for requests in progress when the server stops.
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

/// A network: `192.168.0.0/24`, `fd00::/8`, or one address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Network {
    address: IpAddr,
    bits: u32,
}

impl Network {
    /// Whether it contains an address. IPv4 in IPv6 (`::ffff:192.168.0.1`) counts as IPv4.
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
        // IPv4 in IPv6 counts as IPv4 here as well, if the network includes all bits before the IPv4 address.
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
    fn invalid_networks_are_refused() {
        for text in ["", "192.168.0.0/33", "fd00::/129", "192.168.0/24", "host", "192.168.0.0/-1"] {
            assert!(text.parse::<Network>().is_err(), "{text}");
        }
    }
}
