//! Channel-specific setting data, `$SC_`: the operator's settings for programs.

use super::table::machine_data;

machine_data! {
/// The setting data of one channel.
ChannelSetting {
    /// feed of the dry run (DB21.DBX0.6)
    42100 DRY_RUN_FEED dry_run_feed: f64 = 5_000.0; "mm/min", Range::NOT_NEGATIVE, Immediate;
    /// dry run: 0 the greater of SD42100 and the programmed feed, 1 the smaller, 2 SD42100
    42101 DRY_RUN_FEED_MODE dry_run_feed_mode: u8 = 0; "", Range::ANY, Immediate;
    /// path feed of a program without F; 0 none (10860)
    42110 DEFAULT_FEED default_feed: f64 = 0.0; "mm/min", Range::NOT_NEGATIVE, Immediate;
    /// feed of the return to the interruption point; 0 takes the programmed feed
    42120 APPROACH_FEED approach_feed: f64 = 0.0; "mm/min", Range::NOT_NEGATIVE, Immediate;
    /// single block type 2 stops preparation at each block
    42200 SINGLEBLOCK2_STOPRE singleblock2_stopre: bool = false; "", Range::ANY, Immediate;
    /// an incremental movement also traverses a change of offsets: after TRANS X10, G91 X1 moves 11
    42440 FRAME_OFFSET_INCR_PROG frame_offset_incr_prog: bool = true; "", Range::ANY, Immediate;
}
scope ChannelSetting
}
