//! FB2 (GET), FB3 (PUT) and FB4 (PI_SERV) for STEP 7 programs: NC variables and services of the NC.
//!
//! The edge of Req starts a job; it is answered in the first call after the next FC2: NDR, Done or Error are 1 for this one call. A variable is
//! read in the scan of the answer, and written in that of the edge.

use crate::plc::step7::engine::{Areas, Cpu, Fault};
use crate::plc::step7::instruction::Width;
use crate::plc::step7::system::Region;
use crate::plc::step7::text::types::Layout;
use crate::plc::{NcOrder, NcVariable};
use crate::units::ChannelNumber;

/// The low byte of State (P-136).
mod state {
    pub(super) const NOT_THERE: u32 = 1;
    pub(super) const REFUSED: u32 = 3;
    pub(super) const FORMAT: u32 = 5;
    pub(super) const NO_COMMUNICATION: u32 = 7;
    pub(super) const ADDRESS: u32 = 11;
    pub(super) const NO_VARIABLE: u32 = 12;
}

/// The syntax identification of the address of an NC variable.
const SYNTAX: u8 = 0x82;

/// The static variable `Phase` of the instance.
const IDLE: u32 = 0;
const WAITS: u32 = 1;

/// Which block it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Access {
    Get,
    Put,
    Service,
}

impl Access {
    /// The output that says that the job is done.
    fn done(self) -> &'static str {
        if self == Self::Get { "NDR" } else { "Done" }
    }
}

impl Cpu {
    /// One call of FB2, FB3 or FB4.
    pub(super) fn nc_access<A: Areas>(&mut self, areas: &mut A, layout: &Layout, access: Access) -> Result<(), Fault> {
        let request = self.value(areas, layout, "Req", Width::Bit)? != 0;
        let before = self.value(areas, layout, "ReqBefore", Width::Bit)? != 0;
        let phase = self.value(areas, layout, "Phase", Width::Byte)?;
        let asked = self.value(areas, layout, "Since", Width::Word)?;
        let now = u32::from(self.state.basic.general_calls);
        self.set_value(areas, layout, "ReqBefore", Width::Bit, request.into())?;
        let mut answer = None;
        let mut next = phase;
        if phase == WAITS && now != asked {
            let result = self.value(areas, layout, "Result", Width::Word)?;
            let result = if result == 0 && access == Access::Get { self.get_variables(areas, layout)? } else { result };
            answer = Some(result);
            next = IDLE;
        } else if phase == IDLE && request && !before {
            let result = match access {
                _ if !self.state.basic.has_nc_communication => state::NO_COMMUNICATION,
                Access::Get => 0,
                Access::Put => self.put_variables(areas, layout)?,
                Access::Service => self.service(areas, layout)?,
            };
            self.set_value(areas, layout, "Result", Width::Word, result)?;
            self.set_value(areas, layout, "Since", Width::Word, now)?;
            next = WAITS;
        }
        self.set_value(areas, layout, "Phase", Width::Byte, next)?;
        self.set_value(areas, layout, access.done(), Width::Bit, (answer == Some(0)).into())?;
        self.set_value(areas, layout, "Error", Width::Bit, answer.is_some_and(|state| state != 0).into())?;
        if let Some(state) = answer {
            self.set_value(areas, layout, "State", Width::Word, state)?;
        }
        Ok(())
    }

    /// The number of variables of a job; the error if there is none.
    fn count<A: Areas>(&mut self, areas: &A, layout: &Layout) -> Result<Result<u32, u32>, Fault> {
        let count = self.value(areas, layout, "NumVar", Width::Word)?;
        Ok(if (1..=8).contains(&count) { Ok(count) } else { Err(state::NO_VARIABLE) })
    }

    /// Variable `number` of a job, with its data; the error if it is wrong.
    fn job<A: Areas>(
        &mut self,
        areas: &A,
        layout: &Layout,
        number: u32,
        data: &str,
    ) -> Result<Result<(NcVariable, Region), u32>, Fault> {
        let at = self.variable(areas, layout, &format!("Addr{number}"))?;
        let Ok(address) = self.region_at(areas, at) else { return Ok(Err(state::ADDRESS)) };
        let bytes: [u8; 10] = match self.read_bytes(areas, address.spot) {
            Ok(bytes) if address.bytes >= 10 => bytes,
            _ => return Ok(Err(state::ADDRESS)),
        };
        let [syntax, place, column_high, column_low, line_high, line_low, module, ..] = bytes;
        if syntax != SYNTAX {
            return Ok(Err(state::ADDRESS));
        }
        let given = |name: &str| format!("{name}{number}");
        let unit = self.value(areas, layout, &given("Unit"), Width::Byte)?;
        let column = self.value(areas, layout, &given("Column"), Width::Word)?;
        let line = self.value(areas, layout, &given("Line"), Width::Word)?;
        let or = |given: u32, own: u16| if given == 0 { own } else { u16::try_from(given).unwrap_or(u16::MAX) };
        let variable = NcVariable {
            area: place >> 5,
            unit: u8::try_from(or(unit, u16::from(place & 0x1F))).unwrap_or(0),
            column: or(column, u16::from_be_bytes([column_high, column_low])),
            line: or(line, u16::from_be_bytes([line_high, line_low])),
            module,
        };
        let at = self.variable(areas, layout, &given(data))?;
        let Ok(region) = self.region_at(areas, at) else { return Ok(Err(state::FORMAT)) };
        Ok(Ok((variable, region)))
    }

    /// FB2: reads all variables; 0, or State.
    fn get_variables<A: Areas>(&mut self, areas: &mut A, layout: &Layout) -> Result<u32, Fault> {
        let count = match self.count(areas, layout)? {
            Ok(count) => count,
            Err(state) => return Ok(state),
        };
        for number in 1..=count {
            let failed = |state: u32| Ok(number << 8 | state);
            let (variable, region) = match self.job(areas, layout, number, "RD")? {
                Ok(job) => job,
                Err(state) => return failed(state),
            };
            let Some(value) = areas.link().and_then(|link| link.nc.read(variable)) else {
                return failed(state::NOT_THERE);
            };
            let Some(bytes) = encode(value, &region) else { return failed(state::FORMAT) };
            for (offset, byte) in (0..region.bytes).zip(bytes) {
                self.write_bytes(areas, region.spot.after(offset), [byte])?;
            }
        }
        Ok(0)
    }

    /// FB3: orders that all variables are written; 0, or State.
    fn put_variables<A: Areas>(&mut self, areas: &mut A, layout: &Layout) -> Result<u32, Fault> {
        let count = match self.count(areas, layout)? {
            Ok(count) => count,
            Err(state) => return Ok(state),
        };
        for number in 1..=count {
            let failed = |state: u32| Ok(number << 8 | state);
            let (variable, region) = match self.job(areas, layout, number, "SD")? {
                Ok(job) => job,
                Err(state) => return failed(state),
            };
            let mut bytes = [0; 4];
            for (offset, byte) in (0..region.bytes).zip(&mut bytes) {
                [*byte] = self.read_bytes(areas, region.spot.after(offset))?;
            }
            let Some(value) = decode(bytes, &region) else { return failed(state::FORMAT) };
            let Some(link) = areas.link() else { return failed(state::NOT_THERE) };
            if link.nc.read(variable).is_none() {
                return failed(state::NOT_THERE);
            }
            if !link.nc.order(NcOrder::Write(variable, value)) {
                return failed(state::REFUSED);
            }
        }
        Ok(0)
    }

    /// FB4: a service by its name; 0, or State (P-137).
    fn service<A: Areas>(&mut self, areas: &mut A, layout: &Layout) -> Result<u32, Fault> {
        let name = self.text_of(areas, layout, "PIService")?;
        let name = name.trim_start_matches("_N_").trim_end_matches('_').to_ascii_uppercase();
        let order = match name.as_str() {
            "SELECT" => {
                let unit = self.value(areas, layout, "Unit", Width::Word)?;
                let Some(channel) = u8::try_from(unit).ok().and_then(ChannelNumber::new) else {
                    return Ok(state::REFUSED);
                };
                let (path, program) = (self.text_of(areas, layout, "Addr1")?, self.text_of(areas, layout, "Addr2")?);
                let Some(link) = areas.link() else { return Ok(state::REFUSED) };
                let is_taken = program_paths(&path, &program)
                    .into_iter()
                    .any(|path| link.nc.order(NcOrder::SelectProgram(channel, path)));
                return Ok(if is_taken { 0 } else { state::REFUSED });
            }
            // No PIService, or an empty one.
            "" => return Ok(state::ADDRESS),
            "CONFIG" => NcOrder::ActivateData,
            // Interrupt routines, and what has no counterpart here: done at once.
            _ => return Ok(0),
        };
        let is_taken = areas.link().is_some_and(|link| link.nc.order(order));
        Ok(if is_taken { 0 } else { state::REFUSED })
    }

    /// The text to which an ANY of the instance points: a STRING, or characters; empty if it points nowhere.
    fn text_of<A: Areas>(&mut self, areas: &A, layout: &Layout, name: &str) -> Result<String, Fault> {
        let at = self.variable(areas, layout, name)?;
        let Ok(region) = self.region_at(areas, at) else { return Ok(String::new()) };
        let (mut first, mut count) = (0, region.bytes.min(256));
        if region.code == 0x13 {
            let [length]: [u8; 1] = self.read_bytes(areas, region.spot.after(1))?;
            (first, count) = (2, length.into());
        }
        let mut text = String::new();
        for offset in first..first + count {
            let [letter]: [u8; 1] = self.read_bytes(areas, region.spot.after(offset))?;
            if letter != 0 {
                text.push(char::from(letter));
            }
        }
        Ok(text.trim().to_owned())
    }
}

/// The bytes of a value in the type of a variable of the PLC; `None` if the type is of another kind, or too small. A DOUBLE of the NC becomes a REAL.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the PLC variable is as wide as the program made it"
)]
fn encode(value: f64, region: &Region) -> Option<[u8; 4]> {
    let fits = |least: f64, most: f64| (least..=most).contains(&value.trunc());
    Some(match (region.code, region.bytes) {
        (0x01, 1) => [u8::from(value != 0.0), 0, 0, 0],
        (0x02 | 0x03, 1) if fits(0.0, 255.0) => [value as u8, 0, 0, 0],
        (0x04, 2) if fits(0.0, 65_535.0) => ((value as i32 as u32) << 16).to_be_bytes(),
        (0x05, 2) if fits(-32_768.0, 32_767.0) => ((value as i32 as u32) << 16).to_be_bytes(),
        (0x06, 4) if fits(0.0, 4_294_967_295.0) => (value as i64 as u32).to_be_bytes(),
        (0x07, 4) if fits(-2_147_483_648.0, 2_147_483_647.0) => (value as i64 as u32).to_be_bytes(),
        (0x08, 4) => (value as f32).to_be_bytes(),
        _ => return None,
    })
}

fn decode(bytes: [u8; 4], region: &Region) -> Option<f64> {
    let word = u16::from_be_bytes([bytes[0], bytes[1]]);
    Some(match (region.code, region.bytes) {
        (0x01, 1) => f64::from(bytes[0] & 1),
        (0x02 | 0x03, 1) => f64::from(bytes[0]),
        (0x04, 2) => f64::from(word),
        (0x05, 2) => f64::from(word.cast_signed()),
        (0x06, 4) => f64::from(u32::from_be_bytes(bytes)),
        (0x07, 4) => f64::from(i32::from_be_bytes(bytes)),
        (0x08, 4) => f64::from(f32::from_be_bytes(bytes)),
        _ => return None,
    })
}

/// The paths under which a program can be in memory: as it is written, and for `_N_MPF_DIR`, `_N_PART_MPF` as `PART.MPF`.
fn program_paths(path: &str, program: &str) -> Vec<String> {
    let plain = |name: &str| {
        let name = name.trim_start_matches("_N_");
        match name.rsplit_once('_') {
            Some((name, ending @ ("MPF" | "SPF" | "WPD" | "DIR"))) => format!("{name}.{ending}"),
            _ => name.to_owned(),
        }
    };
    let folder = path.trim_matches('/');
    let name = plain(program);
    let folders = folder.split('/').map(plain).collect::<Vec<_>>().join("/");
    vec![
        format!("{}/{name}", path.trim_end_matches('/')),
        format!("{folder}/{program}"),
        program.to_owned(),
        format!("{folders}/{name}"),
        name,
    ]
}

#[cfg(test)]
mod tests {
    use super::program_paths;

    #[test]
    fn a_program_is_found_with_the_names_of_the_control() {
        let paths = program_paths("/_N_MPF_DIR", "_N_PART_1_MPF");
        assert_eq!(paths[0], "/_N_MPF_DIR/PART_1.MPF", "as an archive names it");
        assert!(paths.contains(&"PART_1.MPF".to_owned()));
        assert!(
            program_paths("/_N_WKS_DIR/_N_SHAFT_WPD", "_N_PART_MPF").contains(&"WKS.DIR/SHAFT.WPD/PART.MPF".to_owned())
        );
    }
}
