//! Units: time in whole nanoseconds, positions in whole nanometres or millionths of a degree, and the numbers of axes, channels and mode
//! groups, which count from one as in the manuals.
//!
//! Every quantity that is compared with a limit is an integer, because `37.7 − 37.5 > 0.2` is true in `f64`, and decision O-11 requires
//! "strictly greater".

mod numbers;
mod position;
mod time;

pub use numbers::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel, PerModeGroup};
pub use position::Position;
pub use time::Time;
