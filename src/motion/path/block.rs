//! A block of a path: its way and its feed.

use serde::{Deserialize, Serialize};

use super::way::Way;

/// A block that ends within this distance has ended.
pub(super) const HALF_AN_INCREMENT: f64 = 0.5;

/// The feed of a block.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Feed {
    /// A programmed velocity along the way, in increments per second, to which the feed override applies.
    Programmed(f64),
    /// As fast as the axes can, to which the rapid traverse override applies.
    Rapid,
}

/// One block of a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathBlock {
    /// A number by which the control recognises the block.
    pub number: u64,
    /// Its geometry.
    pub way: Way,
    /// Its feed.
    pub feed: Feed,
    /// The path stops at its end.
    pub exact_stop: bool,
}
