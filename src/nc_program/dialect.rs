//! What differs between controls with this kind of language. There is one dialect today: [`SINUMERIK`].

use super::functions::{FUNCTIONS, GFunction};
use super::operator::Operator;

/// The differences.
#[derive(Debug)]
pub struct Dialect {
    /// The name.
    pub name: &'static str,
    /// Begins a comment up to the end of the line.
    pub comment: char,
    /// The rank of each operator: 2 binds strongest. Rank 1 has the operators before a value.
    pub rank: fn(Operator) -> u8,
    /// G functions and other words that act as one, with group and index.
    pub functions: &'static [(&'static str, GFunction)],
    /// Words of the control that OpenNCK refuses, and what they are.
    pub refused: &'static [(&'static str, &'static str)],
    /// The longest name.
    pub name_length: usize,
    /// The highest skip level.
    pub skip_level: u8,
    /// The number of control structures inside each other, for each program level.
    pub structures: usize,
    /// The number of program levels, with the main program.
    pub program_levels: usize,
    /// The permitted IDs of synchronised actions.
    pub synchronised_ids: (i32, i32),
    /// The permitted numbers of cycle alarms.
    pub cycle_alarms: (i32, i32),
    /// From this number on a cycle alarm is only shown: the program goes on.
    pub shown_alarms: i32,
}

/// The language of the SINUMERIK 840D sl and 828D.
pub static SINUMERIK: Dialect = Dialect {
    name: "SINUMERIK",
    comment: ';',
    rank: sinumerik_rank,
    functions: FUNCTIONS,
    refused: REFUSED,
    name_length: 32,
    skip_level: 9,
    structures: 8,
    program_levels: 8,
    synchronised_ids: (1, 255),
    cycle_alarms: (60_000, 69_999),
    shown_alarms: 65_000,
};

fn sinumerik_rank(operator: Operator) -> u8 {
    match operator {
        Operator::Multiply | Operator::Divide | Operator::WholeDivide | Operator::Modulo => 2,
        Operator::Add | Operator::Subtract | Operator::Chain => 3,
        Operator::BitAnd => 4,
        Operator::BitXor => 5,
        Operator::BitOr => 6,
        Operator::And => 7,
        Operator::Xor => 8,
        Operator::Or => 9,
        Operator::Join => 10,
        Operator::Equal
        | Operator::Unequal
        | Operator::Greater
        | Operator::Less
        | Operator::GreaterOrEqual
        | Operator::LessOrEqual => 11,
    }
}

const COMPENSATION: &str = "tool radius compensation";
const ADDITIVE: &str = "an additive or fine offset";
const FRAMES: &str = "a frame other than an offset";
const SPLINES: &str = "an interpolation other than lines and circles";
const THREADS: &str = "a thread or an interpolation with the spindle";
const TRANSFORMATIONS: &str = "a kinematic transformation";
const SPEEDS: &str = "this kind of feedrate or speed";
const CYCLES: &str = "a modal call";
const PATHS: &str = "a call with another search path";
const COUPLINGS: &str = "the definition of a coupling";
const FILES: &str = "access to files";
const INTERRUPTS: &str = "an interrupt routine";
const MEASURING: &str = "measuring in a program";
const OVERLAYS: &str = "an overlaid movement";
const SPINDLES: &str = "this spindle function";
const NAMES: &str = "names of axes as text";
const MACROS: &str = "program text from a string";
const OTHERS: &str = "this function";

/// In alphabetical order.
const REFUSED: &[(&str, &str)] = &[
    ("ACTFRAME", FRAMES),
    ("ADIS", OTHERS),
    ("ADISPOS", OTHERS),
    ("AMIRROR", FRAMES),
    ("AROT", FRAMES),
    ("AROTS", FRAMES),
    ("ASCALE", FRAMES),
    ("ASPLINE", SPLINES),
    ("AXNAME", NAMES),
    ("AXSTRING", NAMES),
    ("BLSYNC", INTERRUPTS),
    ("BSPLINE", SPLINES),
    ("CFC", SPEEDS),
    ("CFIN", SPEEDS),
    ("CFINE", ADDITIVE),
    ("CFTCP", SPEEDS),
    ("CIP", SPLINES),
    ("CLRINT", INTERRUPTS),
    ("CMIRROR", FRAMES),
    ("COMPCAD", SPLINES),
    ("COMPCURV", SPLINES),
    ("COMPOF", SPLINES),
    ("COMPON", SPLINES),
    ("COMPSURF", SPLINES),
    ("CORROF", OVERLAYS),
    ("COUPDEF", COUPLINGS),
    ("COUPDEL", COUPLINGS),
    ("CROT", FRAMES),
    ("CSCALE", FRAMES),
    ("CSPLINE", SPLINES),
    ("CT", SPLINES),
    ("CTABDEF", COUPLINGS),
    ("CTABEND", COUPLINGS),
    ("DELETE", FILES),
    ("DISABLE", INTERRUPTS),
    ("DRIVE", OTHERS),
    ("EGDEF", COUPLINGS),
    ("EGDEL", COUPLINGS),
    ("ENABLE", INTERRUPTS),
    ("ENDPROC", OTHERS),
    ("ESRR", OTHERS),
    ("ESRS", OTHERS),
    ("EXECSTRING", MACROS),
    ("FAD", SPEEDS),
    ("FB", SPEEDS),
    ("FGREF", SPEEDS),
    ("FL", SPEEDS),
    ("FTOCOF", OVERLAYS),
    ("FTOCON", OVERLAYS),
    ("FXS", OTHERS),
    ("G110", SPLINES),
    ("G111", SPLINES),
    ("G112", SPLINES),
    ("G140", COMPENSATION),
    ("G141", COMPENSATION),
    ("G142", COMPENSATION),
    ("G143", COMPENSATION),
    ("G147", COMPENSATION),
    ("G148", COMPENSATION),
    ("G247", COMPENSATION),
    ("G248", COMPENSATION),
    ("G290", "the ISO dialect"),
    ("G291", "the ISO dialect"),
    ("G33", THREADS),
    ("G331", THREADS),
    ("G332", THREADS),
    ("G34", THREADS),
    ("G340", COMPENSATION),
    ("G341", COMPENSATION),
    ("G347", COMPENSATION),
    ("G348", COMPENSATION),
    ("G35", THREADS),
    ("G41", COMPENSATION),
    ("G42", COMPENSATION),
    ("G450", COMPENSATION),
    ("G451", COMPENSATION),
    ("G460", COMPENSATION),
    ("G461", COMPENSATION),
    ("G462", COMPENSATION),
    ("G5", SPLINES),
    ("G58", ADDITIVE),
    ("G59", ADDITIVE),
    ("G62", SPEEDS),
    ("G621", SPEEDS),
    ("G63", THREADS),
    ("G7", SPLINES),
    ("G75", "the approach of a fixed point"),
    ("G92", "a spindle speed limit for constant cutting speed"),
    ("G93", SPEEDS),
    ("G931", SPEEDS),
    ("G942", SPEEDS),
    ("G952", SPEEDS),
    ("G96", SPEEDS),
    ("G961", SPEEDS),
    ("G962", SPEEDS),
    ("G97", SPEEDS),
    ("G971", SPEEDS),
    ("G972", SPEEDS),
    ("G973", SPEEDS),
    ("GEOAX", TRANSFORMATIONS),
    ("GETSELT", "tool management"),
    ("GROUP_BEGIN", OTHERS),
    ("GROUP_END", OTHERS),
    ("IPOBRKA", OTHERS),
    ("ISAXIS", NAMES),
    ("ISFILE", FILES),
    ("ISOCALL", PATHS),
    ("LIMS", SPEEDS),
    ("MCALL", CYCLES),
    ("MEAC", MEASURING),
    ("MEAS", MEASURING),
    ("MEASA", MEASURING),
    ("MEAW", MEASURING),
    ("MEAWA", MEASURING),
    ("MIRROR", FRAMES),
    ("MODAXVAL", OTHERS),
    ("MOV", OTHERS),
    ("ORIAXES", TRANSFORMATIONS),
    ("ORIMKS", TRANSFORMATIONS),
    ("ORIWKS", TRANSFORMATIONS),
    ("OVRA", SPEEDS),
    ("PAROT", FRAMES),
    ("PAROTOF", FRAMES),
    ("PCALL", PATHS),
    ("POLFMASK", OTHERS),
    ("POLY", SPLINES),
    ("PRESETONS", "a preset that keeps the reference"),
    ("PROT", OTHERS),
    ("PROTA", OTHERS),
    ("PROTS", OTHERS),
    ("READ", FILES),
    ("ROT", FRAMES),
    ("ROTS", FRAMES),
    ("RPY", FRAMES),
    ("SAVEOF", OTHERS),
    ("SCALE", FRAMES),
    ("SETINT", INTERRUPTS),
    ("SETMS", SPINDLES),
    ("SPCOF", SPINDLES),
    ("SPCON", SPINDLES),
    ("TCARR", "tool management"),
    ("TOFRAME", FRAMES),
    ("TRAANG", TRANSFORMATIONS),
    ("TRACYL", TRANSFORMATIONS),
    ("TRAFOOF", TRANSFORMATIONS),
    ("TRAFOON", TRANSFORMATIONS),
    ("TRANSMIT", TRANSFORMATIONS),
    ("TRAORI", TRANSFORMATIONS),
    ("WRITE", FILES),
];

impl Dialect {
    /// The G function of this name, as `G1`, `G01` or `BRISK`.
    pub(super) fn function(&self, name: &str) -> Option<GFunction> {
        let found = self.functions.iter().find(|(row, _)| *row == name).map(|(_, function)| *function);
        found.or_else(|| super::functions::settable_offset(name.strip_prefix('G')?.parse().ok()?))
    }

    /// What a word is that OpenNCK refuses.
    pub(super) fn refused(&self, name: &str) -> Option<&'static str> {
        let found = self.refused.binary_search_by_key(&name, |(row, _)| row);
        found.ok().map(|index| self.refused[index].1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refused_words_are_in_order_and_are_no_functions() {
        assert!(REFUSED.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert!(REFUSED.iter().all(|(name, _)| SINUMERIK.function(name).is_none()));
        assert_eq!(SINUMERIK.refused("G41"), Some(COMPENSATION));
    }
}
