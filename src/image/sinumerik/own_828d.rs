//! The signals that only the 828D has (P828-03). No data block of the 840D sl shows these bytes, so they follow the last byte of their block.
//!
//! Sources: the PLC interface of the 802/808D family, which the 828D continues, and the function manual Basic Functions, chapter P4 (PLC for
//! SINUMERIK 828D). User alarms are in DB1600, machine data for the PLC in DB4500, actual values and distances to go in DB570x. Auxiliary
//! functions (DB2500) and the M and S function of a spindle (DB370x) have other widths than on the 840D sl, so their signals exist twice with
//! the same name, and a profile finds the one that it shows.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use crate::image::table::signals;
use crate::image::{Block, Kind, Signal, Writer};

/// The user alarms 700000 to 700247.
pub const USER_ALARMS: usize = 248;
/// The machine data for the PLC that DB4500 has of MD14510, MD14512 and MD14514.
const USER_INTEGERS: usize = 32;
const USER_BYTES: usize = 32;
const USER_REALS: usize = 8;

/// What the PLC writes: DB1600 bytes 0 to 30, byte 3000, and 1000 to 1991.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct UserAlarmsToNck {
    /// One bit for each user alarm, from 700000 on.
    pub active: [u8; USER_ALARMS / 8],
    /// Bit 0: the acknowledgement.
    pub acknowledgement: u8,
    /// The variable of each user alarm, four bytes.
    pub variables: [[u8; 4]; USER_ALARMS],
}

/// What the NCK writes: DB1600 byte 2000, and DB4500.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct UserFromNck {
    /// The active reactions of user alarms.
    pub reactions: u8,
    /// MD14510, two bytes each.
    pub integers: [[u8; 2]; USER_INTEGERS],
    /// MD14512.
    pub bytes: [u8; USER_BYTES],
    /// MD14514, four bytes each.
    pub reals: [[u8; 4]; USER_REALS],
    /// MD14516.
    pub alarms: [u8; USER_ALARMS],
}

const fn signal(name: &'static str, byte: u16, bit: u8, kind: Kind, writer: Writer, doc: &'static str) -> Signal {
    Signal { name, block: Block::Nck, byte, bit, kind, writer, doc }
}

impl UserAlarmsToNck {
    /// The first byte in the block of the NCK.
    pub const FIRST: u16 = 272;
    /// The byte of the acknowledgement.
    pub const ACKNOWLEDGEMENT: u16 = Self::FIRST + 31;
    /// The first byte of the variables.
    pub const VARIABLES: u16 = Self::FIRST + 32;
    /// The last byte of the variables.
    pub const LAST: u16 = Self::VARIABLES + 4 * 248 - 1;
    /// The signals: user alarms, then their acknowledgement.
    pub const SIGNALS: &'static [Signal] = &TO_NCK;
}

impl UserFromNck {
    /// The first byte in the block of the NCK.
    pub const FIRST: u16 = UserAlarmsToNck::LAST + 1;
    /// The first byte of MD14510, MD14512, MD14514 and MD14516.
    pub const DATA: [u16; 4] = [Self::FIRST + 1, Self::FIRST + 65, Self::FIRST + 97, Self::FIRST + 129];
    /// The last byte.
    pub const LAST: u16 = Self::DATA[3] + 247;
    /// The signals: reactions, then the machine data for the PLC.
    pub const SIGNALS: &'static [Signal] = &FROM_NCK;
}

/// The bit of a user alarm, counted from 700000.
#[must_use]
pub const fn user_alarm(index: u8) -> Signal {
    TO_NCK[index as usize]
}

/// The acknowledgement of user alarms.
pub const ACKNOWLEDGE_USER_ALARMS: Signal = TO_NCK[USER_ALARMS];

/// The rows of the user alarms: their numbers without the leading `700`.
macro_rules! user_alarms {
    ($($number:literal)*) => {
        [
            $(signal(
                concat!("user_alarm_700", $number),
                UserAlarmsToNck::FIRST + place($number) / 8,
                (place($number) % 8) as u8,
                Kind::Bit,
                Writer::Plc,
                concat!("User alarm 700", $number, ": 1 raises the alarm."),
            ),)*
            signal(
                "acknowledge_user_alarms",
                UserAlarmsToNck::ACKNOWLEDGEMENT,
                0,
                Kind::Bit,
                Writer::Plc,
                "Acknowledge user alarms: 1 clears the user alarms that wait for it (MD14516 bit 6).",
            ),
        ]
    };
}

/// The place of a user alarm: the number that its last three digits write.
const fn place(digits: &str) -> u16 {
    let digits = digits.as_bytes();
    (digits[0] - b'0') as u16 * 100 + (digits[1] - b'0') as u16 * 10 + (digits[2] - b'0') as u16
}

#[rustfmt::skip]
const TO_NCK: [Signal; USER_ALARMS + 1] = user_alarms!(
    "000" "001" "002" "003" "004" "005" "006" "007" "008" "009" "010" "011" "012" "013" "014" "015" "016" "017" "018"
    "019" "020" "021" "022" "023" "024" "025" "026" "027" "028" "029" "030" "031" "032" "033" "034" "035" "036" "037"
    "038" "039" "040" "041" "042" "043" "044" "045" "046" "047" "048" "049" "050" "051" "052" "053" "054" "055" "056"
    "057" "058" "059" "060" "061" "062" "063" "064" "065" "066" "067" "068" "069" "070" "071" "072" "073" "074" "075"
    "076" "077" "078" "079" "080" "081" "082" "083" "084" "085" "086" "087" "088" "089" "090" "091" "092" "093" "094"
    "095" "096" "097" "098" "099" "100" "101" "102" "103" "104" "105" "106" "107" "108" "109" "110" "111" "112" "113"
    "114" "115" "116" "117" "118" "119" "120" "121" "122" "123" "124" "125" "126" "127" "128" "129" "130" "131" "132"
    "133" "134" "135" "136" "137" "138" "139" "140" "141" "142" "143" "144" "145" "146" "147" "148" "149" "150" "151"
    "152" "153" "154" "155" "156" "157" "158" "159" "160" "161" "162" "163" "164" "165" "166" "167" "168" "169" "170"
    "171" "172" "173" "174" "175" "176" "177" "178" "179" "180" "181" "182" "183" "184" "185" "186" "187" "188" "189"
    "190" "191" "192" "193" "194" "195" "196" "197" "198" "199" "200" "201" "202" "203" "204" "205" "206" "207" "208"
    "209" "210" "211" "212" "213" "214" "215" "216" "217" "218" "219" "220" "221" "222" "223" "224" "225" "226" "227"
    "228" "229" "230" "231" "232" "233" "234" "235" "236" "237" "238" "239" "240" "241" "242" "243" "244" "245" "246"
    "247"
);

const fn reaction(name: &'static str, bit: u8, doc: &'static str) -> Signal {
    signal(name, UserFromNck::FIRST, bit, Kind::Bit, Writer::Nck, doc)
}

/// The rows of what the NCK writes.
macro_rules! from_nck {
    ($($index:literal)* ; $($real:literal)*) => {
        [
            reaction("user_alarm_disables_nc_start", 0, "NC start disabled by a user alarm."),
            reaction("user_alarm_disables_read_in", 1, "Read-in disabled by a user alarm."),
            reaction("user_alarm_disables_feed", 2, "Feed of all axes disabled by a user alarm."),
            reaction("user_alarm_emergency_stop", 3, "Emergency stop by a user alarm."),
            reaction("user_alarm_plc_stop", 4, "PLC stop by a user alarm."),
            $(signal(
                concat!("user_data_integer_", $index),
                UserFromNck::DATA[0] + 2 * $index,
                0,
                Kind::Word,
                Writer::Nck,
                concat!("Machine datum for the PLC, an integer: MD14510[", $index, "]."),
            ),)*
            $(signal(
                concat!("user_data_byte_", $index),
                UserFromNck::DATA[1] + $index,
                0,
                Kind::Byte,
                Writer::Nck,
                concat!("Machine datum for the PLC, a byte: MD14512[", $index, "]."),
            ),)*
            $(signal(
                concat!("user_data_real_", $real),
                UserFromNck::DATA[2] + 4 * $real,
                0,
                Kind::Real,
                Writer::Nck,
                concat!("Machine datum for the PLC, a REAL: MD14514[", $real, "]."),
            ),)*
        ]
    };
}

#[rustfmt::skip]
const FROM_NCK: [Signal; 5 + USER_INTEGERS + USER_BYTES + USER_REALS] = from_nck!(
    0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31;
    0 1 2 3 4 5 6 7
);

signals! {
    /// DB2500 of the 828D: auxiliary functions of the channel.
    pub struct ChannelAuxiliary828d, channel_auxiliary_828d: Channel, Nck, 416 to 511;

    /// Extension of M function 1: the spindle.
    u8, m_function_1_extension, set_m_function_1_extension: 428, 7 to 0;
    /// Extension of M function 2: the spindle.
    u8, m_function_2_extension, set_m_function_2_extension: 436, 7 to 0;
    /// Extension of M function 3: the spindle.
    u8, m_function_3_extension, set_m_function_3_extension: 444, 7 to 0;
    /// Extension of M function 4: the spindle.
    u8, m_function_4_extension, set_m_function_4_extension: 452, 7 to 0;
    /// Extension of M function 5: the spindle.
    u8, m_function_5_extension, set_m_function_5_extension: 460, 7 to 0;
    /// Extension of S function 1: the spindle.
    u8, s_function_1_extension, set_s_function_1_extension: 468, 7 to 0;
    /// Extension of S function 2: the spindle.
    u8, s_function_2_extension, set_s_function_2_extension: 476, 7 to 0;
    /// Extension of S function 3: the spindle.
    u8, s_function_3_extension, set_s_function_3_extension: 484, 7 to 0;
    /// Extension of H function 1.
    u8, h_function_1_extension, set_h_function_1_extension: 492, 7 to 0;
    /// Extension of H function 2.
    u8, h_function_2_extension, set_h_function_2_extension: 500, 7 to 0;
    /// Extension of H function 3.
    u8, h_function_3_extension, set_h_function_3_extension: 508, 7 to 0;
    numbers {
        /// T function 1: the number of the tool.
        u32, t_function_1, set_t_function_1: 416;
        /// D function 1: the number of the tool offset.
        u32, d_function_1, set_d_function_1: 420;
        /// M function 1: its number.
        u32, m_function_1, set_m_function_1: 424;
        /// M function 2: its number.
        u32, m_function_2, set_m_function_2: 432;
        /// M function 3: its number.
        u32, m_function_3, set_m_function_3: 440;
        /// M function 4: its number.
        u32, m_function_4, set_m_function_4: 448;
        /// M function 5: its number.
        u32, m_function_5, set_m_function_5: 456;
        /// S function 1: its value.
        f32, s_function_1, set_s_function_1: 464;
        /// S function 2: its value.
        f32, s_function_2, set_s_function_2: 472;
        /// S function 3: its value.
        f32, s_function_3, set_s_function_3: 480;
        /// H function 1: its value.
        f32, h_function_1, set_h_function_1: 488;
        /// H function 2: its value.
        f32, h_function_2, set_h_function_2: 496;
        /// H function 3: its value.
        f32, h_function_3, set_h_function_3: 504;
    }
}

signals! {
    /// DB370x and DB570x of the 828D: functions of a spindle, actual value and distance to go.
    pub struct Axis828d, axis_828d: Axis, Nck, 148 to 163;

    numbers {
        /// M function for the spindle: the number of the last one.
        u32, spindle_m_function, set_spindle_m_function: 148;
        /// S function for the spindle: the speed of the last one.
        f32, spindle_s_function, set_spindle_s_function: 152;
        /// Actual value of the axis, while the PLC requests the actual values (DB2600.DBX1.1).
        f32, axis_actual_value, set_axis_actual_value: 156;
        /// Distance to go of the axis, while the PLC requests the distances to go (DB2600.DBX1.2).
        f32, axis_distance_to_go, set_axis_distance_to_go: 160;
    }
}
