//! The program `opennck` with an additional PLC program: every command accepts `plc = "drives_on_from_input"`.
//!
//! `cargo run --example own_binary -- run my_scenario.toml`

use std::process::ExitCode;

use opennck::plc::{Programs, program};

fn main() -> ExitCode {
    opennck::cli::main(Programs::ready().with("drives_on_from_input", |_| {
        let drives_on = program("drives_on_from_input", (), |(), io| {
            let on = io.inputs.bit(0, 0); // I0.0, the button
            for axis in io.axes() {
                io.to_nck.axis(axis).set_position_measuring_system_1(true);
                io.to_nck.axis(axis).set_controller_enable(on);
                io.to_nck.axis(axis).set_pulse_enable(on);
            }
        });
        Ok(drives_on.boxed())
    }))
}
