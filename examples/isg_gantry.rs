//! A PLC program in Rust for a control of the ISG kernel: it starts the NC program, and after an error of the gantry it clears the difference
//! with `gantry_on`, presses RESET and starts again.
//!
//! `cargo run --example isg_gantry`

use opennck::isg::hli::Isg;
use opennck::machine::FaultKind;
use opennck::plc::{OnDelay, PlcProgram, program_for};
use opennck::scenario::{Failure, Session};
use opennck::units::{Position, Time};
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
enum Phase {
    #[default]
    WaitsForDrives,
    Runs,
    Clears,
    Resets,
}

/// Supervises the gantry of `isg_hard_gantry`: master X, slave axis 5.
fn supervisor() -> Box<dyn PlcProgram> {
    program_for::<_, Isg>("gantry_supervisor", (Phase::default(), OnDelay::default()), |(phase, delay), io| {
        let (Some(x), Some(slave)) = (io.axis("ax1"), io.axis("ax5")) else { return Ok(()) };
        let Some(channel) = io.channel("channel_1") else { return Ok(()) };
        let (from, to) = (io.from_nck, &mut *io.to_nck);
        let stands = from.axes[x].in_position() && from.axes[slave].in_position();
        let has_cleared = delay.scan(*phase == Phase::Clears && stands, Time::from_millis(500), io.time);
        let is_error = from.channels[channel].error();
        *phase = match *phase {
            Phase::WaitsForDrives
                if io.names.axes.iter().all(|(axis, name)| name.is_none() || from.axes[axis].drive_ready()) =>
            {
                Phase::Runs
            }
            // An error that no RESET clears needs somebody at the machine.
            Phase::Runs if is_error && !from.axes[slave].error_not_resettable() => Phase::Clears,
            Phase::Clears if has_cleared => Phase::Resets,
            Phase::Resets if !is_error => Phase::WaitsForDrives,
            phase => phase,
        };
        to.channels[channel].set_start(*phase == Phase::Runs);
        to.channels[channel].set_reset(*phase == Phase::Resets);
        // The control unit: the PLC takes over (enable_w), and gives its value (command_w).
        to.axes[slave].set_gantry_on_enable(true);
        to.axes[slave].set_gantry_on_command(*phase == Phase::Clears);
        Ok(())
    })
    .boxed()
}

/// Somebody displaces the slide of the slave by 0.2 mm: beyond P-AXIS-00072 (0.1 mm), within P-AXIS-00071 (0.5 mm).
pub(crate) fn run() -> Result<Session, Failure> {
    let mut gantry = Session::open("isg_hard_gantry")?.with_program(supervisor());
    gantry.nc("G90 G01 F6000 X=100\nM30", 1)?;
    gantry.wait("X.setpoint > 50", "2s")?;
    gantry.fault("ax5", FaultKind::MovedByHand { by: Position::from_user(0.2) })?;
    gantry.wait("message('gantry-stage-1', ax5) == 1 && channel_1.error", "100ms")?;
    gantry.wait("ax5.gantry_on", "1s")?;
    gantry.wait("!channel_1.error", "2s")?;
    gantry.expect("abs(ax5.gantry_difference) < 0.001")?;
    gantry.wait("channel_1.program_completed", "5s")?;
    gantry.expect("abs(X.position - 100) < 0.001 && abs(ax5.position - 100) < 0.001 && errors() == 1")?;
    Ok(gantry)
}

fn main() -> Result<(), Failure> {
    println!("{}", run()?.sequence());
    Ok(())
}
