//! DB2: which bit is which message, and which messages form the group signals.

/// How DB2 is laid out: the inputs `ExtendAlMsg` and `MsgUser` of FB1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessageLayout {
    /// The messages of 31 axes begin at byte 490, instead of those of 18 axes at byte 144.
    pub is_extended: bool,
    /// The number of user areas of 8 bytes from byte 180 on, at most 32.
    pub user_areas: u8,
}

impl Default for MessageLayout {
    /// 18 axes, 10 user areas.
    fn default() -> Self {
        Self { is_extended: false, user_areas: 10 }
    }
}

/// Some messages of DB2 that lie together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Messages {
    /// Their first byte.
    pub byte: u16,
    /// The number of bytes: the first half has error messages, the second operating messages.
    pub bytes: u16,
    /// The number of the first message.
    pub number: u32,
    /// What their group signal does.
    pub group: Group,
}

/// The group signal of some messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Feed disable of a channel (DB21.DBX6.0).
    Feed(u8),
    /// Feed and read-in disable (6.0 and 6.1).
    FeedAndReadIn(u8),
    /// Read-in disable (6.1).
    ReadIn(u8),
    /// NC start disable (7.0).
    NcStart(u8),
    /// Feed stop of a geometry axis (12.3, 16.3, 20.3): the channel, and the axis from 1.
    GeometryAxis(u8, u8),
    /// Feed stop or spindle stop of a machine axis (DB31.DBX4.3).
    Axis(u8),
    /// None.
    Nothing,
}

/// The groups of a channel: the first byte, the number of bytes, and the number of the first message after 5c0000.
const CHANNEL: [(u16, u16, u32); 7] = [
    (0, 2, 10_000),
    (2, 4, 10_100),
    (6, 4, 10_200),
    (10, 2, 10_300),
    (12, 2, 11_100),
    (14, 2, 11_200),
    (16, 2, 11_300),
];

impl MessageLayout {
    /// The bytes that DB2 needs.
    #[must_use]
    pub fn length(self) -> usize {
        self.areas().map(|area| usize::from(area.byte + area.bytes)).max().unwrap_or(0)
    }

    /// The longest DB2.
    pub const LONGEST: usize = 552;

    /// All groups of messages.
    pub fn areas(self) -> impl Iterator<Item = Messages> {
        let channels = (1..=8_u8).flat_map(|channel| {
            CHANNEL.into_iter().enumerate().map(move |(index, (byte, bytes, number))| Messages {
                byte: 18 * (u16::from(channel) - 1) + byte,
                bytes,
                number: 500_000 + 10_000 * (u32::from(channel) - 1) + number,
                group: match index {
                    0 => Group::Feed(channel),
                    1 => Group::FeedAndReadIn(channel),
                    2 => Group::ReadIn(channel),
                    3 => Group::NcStart(channel),
                    4 => Group::GeometryAxis(channel, 1),
                    5 => Group::GeometryAxis(channel, 2),
                    _ => Group::GeometryAxis(channel, 3),
                },
            })
        });
        let (first, last) = if self.is_extended { (490, 31) } else { (144, 18) };
        let axes = (1..=last).map(move |axis: u8| Messages {
            byte: first + 2 * (u16::from(axis) - 1),
            bytes: 2,
            number: 600_000 + 100 * u32::from(axis),
            group: Group::Axis(axis),
        });
        let users = (0..u16::from(self.user_areas.min(32))).map(|user| Messages {
            byte: 180 + 8 * user,
            bytes: 8,
            number: 700_000 + 100 * u32::from(user),
            group: Group::Nothing,
        });
        channels.chain(axes).chain(users)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(layout: MessageLayout, byte: u16) -> (u32, Group) {
        let area = layout.areas().find(|area| (area.byte..area.byte + area.bytes).contains(&byte)).unwrap();
        (area.number + 8 * u32::from(byte - area.byte), area.group)
    }

    /// P-130: the layout of DB2. Channel 1 from byte 0, channel 2 from byte 18; axis 1 at byte 144; user area 0 at byte 180.
    #[test]
    fn bytes_of_db2_have_the_numbers_of_their_messages() {
        let usual = MessageLayout::default();
        assert_eq!(at(usual, 1), (510_008, Group::Feed(1)));
        assert_eq!(at(usual, 5), (510_124, Group::FeedAndReadIn(1)));
        assert_eq!(at(usual, 6), (510_200, Group::ReadIn(1)));
        assert_eq!(at(usual, 10), (510_300, Group::NcStart(1)));
        assert_eq!(at(usual, 16), (511_300, Group::GeometryAxis(1, 3)));
        assert_eq!(at(usual, 18), (520_000, Group::Feed(2)));
        assert_eq!(at(usual, 144), (600_100, Group::Axis(1)));
        assert_eq!(at(usual, 180 + 8 + 4), (700_132, Group::Nothing));
        let extended = MessageLayout { is_extended: true, user_areas: 32 };
        assert_eq!(at(extended, 490 + 60), (603_100, Group::Axis(31)));
        assert_eq!(extended.length(), MessageLayout::LONGEST);
        assert_eq!(usual.length(), 260);
    }
}
