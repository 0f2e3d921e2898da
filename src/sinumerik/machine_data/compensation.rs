//! Access to the tables of compensations, `$AA_ENC_COMP` and `$AN_CEC`.
//!
//! A file beside the machine contains them as a control exports them (`_EEC_INI`, `_CEC_INI`),
//! and an NC program can write them. MD38000 and MD18342 give the number of their points. Lengths are in millimetres or degrees, in every
//! system of units.

use super::MachineData;
use super::tables::{Element, Part, Points, TableRefusal, TableValue, TableVariable};
use crate::control::Value;
use crate::source::Problem;
use crate::units::AxisNumber;

impl MachineData {
    /// The number of points that a table can have.
    fn points_of(&self, element: Element) -> u16 {
        let points = match element {
            Element::Leadscrew { axis, encoder, .. } => {
                self.axes[axis].mm_enc_comp_max_points.get(usize::from(encoder)).copied()
            }
            Element::Sag { table, .. } => self.general.mm_cec_max_points.get(usize::from(table)),
        };
        points.and_then(|points| u16::try_from(points).ok()).unwrap_or(0)
    }

    /// The datum that makes a table active, if it is 1: a table must not be changed then (17070).
    fn table_is_active(&self, element: Element) -> Option<(u32, AxisNumber)> {
        match element {
            Element::Leadscrew { axis, encoder, .. } => {
                let enabled = self.axes[axis].enc_comp_enable.get(usize::from(encoder)) == Some(&true);
                enabled.then_some((32700, axis))
            }
            Element::Sag { table, .. } => {
                let output = self.tables.sag.get(&table)?.output?;
                self.axes[output].cec_enable.then_some((32710, output))
            }
        }
    }

    /// Writes an element like an NC program: not while its compensation is active.
    ///
    /// # Errors
    /// The table has no such element, the value does not fit, or the compensation is active.
    pub(in crate::sinumerik) fn write_table(
        &mut self,
        element: Element,
        value: TableValue,
    ) -> Result<(), TableRefusal> {
        self.check_table(element, value)?;
        if let Some((datum, axis)) = self.table_is_active(element) {
            return Err(TableRefusal::Active(datum, axis));
        }
        self.tables.store(element, value);
        Ok(())
    }

    /// Stores the line of a file, `$AA_ENC_COMP[0,5,AX1]=0.012` or `$AN_CEC_INPUT_AXIS[0]=(AX2)`.
    ///
    /// # Errors
    /// The brackets or the value do not fit, or the table has no such element.
    pub(super) fn read_table_line(&mut self, variable: TableVariable, name: &str, value: &str) -> Result<(), Problem> {
        let element = self.element_named(variable, name)?;
        let text = value.trim().trim_start_matches('(').trim_end_matches(')').trim().trim_matches('"');
        let number = || Value::parse(value).and_then(|value| value.number());
        let value = match variable.part {
            Part::InputAxis | Part::OutputAxis => self.axis(text).map(TableValue::Axis),
            Part::Value
            | Part::Step
            | Part::Minimum
            | Part::Maximum
            | Part::IsModulo
            | Part::Direction
            | Part::MultipliedBy
            | Part::Type => number().map(TableValue::Number),
        };
        let refused = |refusal: TableRefusal| match refusal {
            TableRefusal::Index(datum) => Problem::new(
                format!("expected a point below {} (MD{datum}), found {name}", self.points_of(element)),
                format!("set MD{datum} to at least (_MAX - _MIN) / _STEP + 1, or remove the line"),
            ),
            TableRefusal::Value(expected) => {
                Problem::new(format!("expected {expected}, found `{text}`"), "correct the value")
            }
            TableRefusal::Active(datum, _) => {
                Problem::new(format!("expected MD{datum} = 0 while a table is loaded"), "load the table first")
            }
        };
        let Some(value) = value else {
            return Err(refused(TableRefusal::Value("a number, or a machine axis in parentheses such as (AX1)")));
        };
        self.check_table(element, value).map_err(refused)?;
        self.tables.store(element, value);
        Ok(())
    }

    /// The element with the indices of a name: `$AA_ENC_COMP[0,5,AX1]`.
    fn element_named(&self, variable: TableVariable, name: &str) -> Result<Element, Problem> {
        let inside = name.split_once('[').and_then(|(_, rest)| rest.trim_end().strip_suffix(']')).unwrap_or_default();
        let (mut numbers, mut axis, mut unknown) = (Vec::new(), None, None);
        for index in inside.split(',').map(str::trim) {
            match index.parse::<u16>() {
                Ok(number) => numbers.push(f64::from(number)),
                Err(_) => match self.axis(index) {
                    Some(found) => axis = Some(found),
                    None => unknown = Some(index),
                },
            }
        }
        let form = match (variable.is_sag, variable.part == Part::Value) {
            (true, true) => "[table, point]",
            (true, false) => "[table]",
            (false, true) => "[encoder, point, AX1]",
            (false, false) => "[encoder, AX1]",
        };
        if let Some(unknown) = unknown {
            let what = format!("expected the name of a machine axis (MD10000) or AX1 to AX31, found `{unknown}`");
            return Err(Problem::new(what, format!("write {form}")));
        }
        let element = variable.element(&numbers, axis);
        element.ok_or_else(|| {
            Problem::new(format!("expected the indices {form}, found `{name}`"), format!("write {form}"))
        })
    }

    /// The tables as lines of a file.
    pub(super) fn table_lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let mut points = |name: &str, prefix: String, suffix: String, points: &Points| {
            for (point, value) in &points.values {
                lines.push(format!("{name}[{prefix},{point}{suffix}]={value}"));
            }
            for (part, value) in [("STEP", points.step), ("MIN", points.minimum), ("MAX", points.maximum)] {
                lines.push(format!("{name}_{part}[{prefix}{suffix}]={value}"));
            }
            lines.push(format!("{name}_IS_MODULO[{prefix}{suffix}]={}", u8::from(points.is_modulo)));
        };
        for ((axis, encoder), table) in &self.tables.leadscrew {
            points("$AA_ENC_COMP", encoder.to_string(), format!(",AX{axis}"), table);
        }
        for (number, table) in &self.tables.sag {
            points("$AN_CEC", number.to_string(), String::new(), &table.points);
        }
        for (number, table) in &self.tables.sag {
            for (part, axis) in [("INPUT", table.input), ("OUTPUT", table.output)] {
                lines.extend(axis.map(|axis| format!("$AN_CEC_{part}_AXIS[{number}]=(AX{axis})")));
            }
            lines.push(format!("$AN_CEC_DIRECTION[{number}]={}", table.direction));
            lines.push(format!("$AN_CEC_MULT_BY_TABLE[{number}]={}", table.multiplied_by));
        }
        lines
    }

    /// Whether an element could be written with [`MachineData::write_table`].
    ///
    /// # Errors
    /// As there.
    pub(in crate::sinumerik) fn may_write_table(
        &self,
        element: Element,
        value: TableValue,
    ) -> Result<(), TableRefusal> {
        self.check_table(element, value)?;
        self.table_is_active(element).map_or(Ok(()), |(datum, axis)| Err(TableRefusal::Active(datum, axis)))
    }

    fn check_table(&self, element: Element, value: TableValue) -> Result<(), TableRefusal> {
        let (Element::Leadscrew { point, part, .. } | Element::Sag { point, part, .. }) = element;
        if point >= self.points_of(element) {
            return Err(TableRefusal::Index(element.size_datum()));
        }
        let is_axis = matches!(part, Part::InputAxis | Part::OutputAxis);
        match value {
            TableValue::Axis(_) if is_axis => Ok(()),
            TableValue::Axis(_) => Err(TableRefusal::Value("a number")),
            TableValue::Number(_) if is_axis => Err(TableRefusal::Value("a machine axis")),
            TableValue::Number(number) => {
                let (fits, expected) = match part {
                    Part::IsModulo | Part::Type => ([0.0, 1.0].contains(&number), "0 or 1"),
                    Part::Direction => ([-1.0, 0.0, 1.0].contains(&number), "-1, 0 or 1"),
                    Part::MultipliedBy => {
                        (number.fract() == 0.0 && (0.0..=62.0).contains(&number), "0, or a table from 1 to 62")
                    }
                    Part::Value | Part::Step | Part::Minimum | Part::Maximum | Part::InputAxis | Part::OutputAxis => {
                        (number.abs() <= 1e8, "a position in mm or degrees, at most 100000000")
                    }
                };
                if fits { Ok(()) } else { Err(TableRefusal::Value(expected)) }
            }
        }
    }

    /// The value of an element; `None` if the table has no such element, or for an axis.
    pub(in crate::sinumerik) fn table_number(&self, element: Element) -> Option<f64> {
        let (Element::Leadscrew { point, part, .. } | Element::Sag { point, part, .. }) = element;
        if point >= self.points_of(element) {
            return None;
        }
        let (points, sag) = match element {
            Element::Leadscrew { axis, encoder, .. } => (self.tables.leadscrew.get(&(axis, encoder)), None),
            Element::Sag { table, .. } => {
                let table = self.tables.sag.get(&table);
                (table.map(|table| &table.points), table)
            }
        };
        Some(match part {
            Part::Value => points.and_then(|points| points.values.get(&point)).copied().unwrap_or(0.0),
            Part::Step => points.map_or(0.0, |points| points.step),
            Part::Minimum => points.map_or(0.0, |points| points.minimum),
            Part::Maximum => points.map_or(0.0, |points| points.maximum),
            Part::IsModulo => points.map_or(0.0, |points| f64::from(u8::from(points.is_modulo))),
            Part::Direction => sag.map_or(0.0, |sag| f64::from(sag.direction)),
            Part::MultipliedBy => sag.map_or(0.0, |sag| f64::from(sag.multiplied_by)),
            Part::Type => 0.0,
            Part::InputAxis | Part::OutputAxis => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sinumerik::machine_data::Archive;

    const SIZES: &str = "N18342 $MN_MM_CEC_MAX_POINTS[1]=2\nN38000 $MA_MM_ENC_COMP_MAX_POINTS[0,AX2]=2\n";

    fn read(lines: &str) -> Result<Archive, String> {
        let text = format!("{lines}\n{SIZES}");
        Archive::read([("tables.ini", text.as_bytes())]).map_err(|findings| format!("{:?}", findings[0]))
    }

    /// Tables in the form of an export, before the data that give their size; written and read again they are the same.
    #[test]
    fn tables_are_read_in_the_syntax_of_an_export_and_written_back() {
        let text = "%_N_AX2_EEC_INI\nCHANDATA(1)\nN10 $AA_ENC_COMP[0,1,AX2]=1.5EX-02\n$AA_ENC_COMP_STEP[0,AX2]=100\n\
            $AA_ENC_COMP_MAX[0,AX2]=100\n$AN_CEC_INPUT_AXIS[1]=(AX2)\n$AN_CEC_OUTPUT_AXIS[1]=\"AX3\"\n$AN_CEC_DIRECTION[1]=-1\n\
            $AN_CEC_TYPE[1]=0\nM17\n";
        let archive = read(text).unwrap();
        let (second, third) = (AxisNumber::new(2).unwrap(), AxisNumber::new(3).unwrap());
        let points = &archive.data.tables.leadscrew[&(second, 0)];
        assert_eq!((points.step.to_bits(), points.maximum.to_bits()), (100f64.to_bits(), 100f64.to_bits()));
        assert_eq!(points.values[&1].to_bits(), 0.015f64.to_bits());
        let sag = &archive.data.tables.sag[&1];
        assert_eq!((sag.input, sag.output, sag.direction), (Some(second), Some(third), -1));
        let again = read(&archive.write()).unwrap();
        assert!(again.data.tables == archive.data.tables && archive.unknown.is_empty(), "{}", archive.write());
    }

    #[test]
    fn what_no_table_can_have_is_refused_with_what_is_allowed() {
        for (line, expected) in [
            ("$AA_ENC_COMP[0,2,AX2]=1", "below 2 (MD38000)"),
            ("$AA_ENC_COMP[0,0,AX1]=1", "below 0 (MD38000)"),
            ("$AN_CEC[0,0]=1", "below 0 (MD18342)"),
            ("$AN_CEC[1,0,AX1]=1", "the indices [table, point]"),
            ("$AA_ENC_COMP_STEP[0]=1", "the indices [encoder, AX1]"),
            ("$AA_ENC_COMP_STEP[0,NONE]=1", "the name of a machine axis"),
            ("$AN_CEC_DIRECTION[1]=2", "-1, 0 or 1"),
            ("$AN_CEC_MULT_BY_TABLE[1]=63", "a table from 1 to 62"),
            ("$AN_CEC_INPUT_AXIS[1]=5", "a machine axis"),
            ("$AN_CEC_STEP[1]=(AX1)", "a number"),
        ] {
            let error = read(line).unwrap_err();
            assert!(error.contains(expected), "{line}: {error}");
        }
    }

    /// 17070: a table is written only while its compensation is switched off.
    #[test]
    fn a_program_does_not_write_a_table_that_acts() {
        let mut data = read("$AN_CEC_OUTPUT_AXIS[1]=(AX3)\n").unwrap().data;
        let axis = AxisNumber::new(3).unwrap();
        let element = Element::Sag { table: 1, point: 0, part: Part::Step };
        assert_eq!(data.write_table(element, TableValue::Number(10.0)), Ok(()));
        assert_eq!(data.table_number(element).map(f64::to_bits), Some(10f64.to_bits()));
        data.axes[axis].cec_enable = true;
        assert_eq!(data.write_table(element, TableValue::Number(20.0)), Err(TableRefusal::Active(32710, axis)));
        assert_eq!(data.table_number(element).map(f64::to_bits), Some(10f64.to_bits()));
    }
}
