//! The members of the objects of OPC 40502, by their ids: `CncInterface/CncAxisList/X/IsReferenced`. `cnc.rs` has their values.

/// The root of the objects.
pub(super) const ROOT: &str = "CncInterface";

/// A member, by its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Member {
    Interface(&'static str),
    /// Of the axis with this name.
    Axis(String, &'static str),
    /// Of the channel with this name.
    Channel(String, &'static str),
}

pub(super) const OF_INTERFACE: [&str; 3] = ["VendorName", "VendorRevision", "Version"];
pub(super) const OF_AXIS: [&str; 16] = [
    "ActStatus",
    "IsReferenced",
    "IsRotational",
    "IsInactive",
    "IsVirtual",
    "PosDirect/ActPos",
    "PosDirect/CmdPos",
    "PosDirect/RemDist",
    "PosIndirect/ActPos",
    "PosIndirect/CmdPos",
    "PosIndirect/RemDist",
    "ActLoad",
    "ActPower",
    "ActTorque",
    "CmdTorque",
    "ZeroOffset",
];
pub(super) const OF_CHANNEL: [&str; 11] = [
    "Id",
    "ActStatus",
    "ActProgramStatus",
    "ActOperationMode",
    "ActFeedrate",
    "CmdFeedrate",
    "ActOverride",
    "ActProgramName",
    "BlockMode",
    "FeedHold",
    "ToolId",
];

impl Member {
    /// Reads an id of the form `CncInterface/…`.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let rest = text.strip_prefix(ROOT)?.strip_prefix('/')?;
        let find = |names: &'static [&'static str], name: &str| names.iter().find(|known| **known == name).copied();
        if let Some(rest) = rest.strip_prefix("CncAxisList/") {
            let (axis, name) = rest.split_once('/')?;
            return Some(Self::Axis(axis.to_owned(), find(&OF_AXIS, name)?));
        }
        if let Some(rest) = rest.strip_prefix("CncChannelList/") {
            let (channel, name) = rest.split_once('/')?;
            return Some(Self::Channel(channel.to_owned(), find(&OF_CHANNEL, name)?));
        }
        find(&OF_INTERFACE, rest).map(Self::Interface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_member_has_the_name_of_its_axis_or_channel() {
        let axis = Member::parse("CncInterface/CncAxisList/X/PosDirect/ActPos");
        assert_eq!(axis, Some(Member::Axis("X".to_owned(), "PosDirect/ActPos")));
        let channel = Member::parse("CncInterface/CncChannelList/CHAN1/ActStatus");
        assert_eq!(channel, Some(Member::Channel("CHAN1".to_owned(), "ActStatus")));
        assert_eq!(Member::parse("CncInterface/Version"), Some(Member::Interface("Version")));
        for text in
            ["CncInterface", "CncInterface/", "CncInterface/CncAxisList/X", "CncInterface/CncAxisList/X/Nonsense"]
        {
            assert_eq!(Member::parse(text), None, "{text}");
        }
    }
}
