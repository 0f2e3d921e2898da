//! USER: the messages of a PLC program (`messages.rs`), and what the 828D has for the PLC of a machine, and the 840D sl has not: user alarms in DB1600, machine data for the PLC in DB4500,
//! actual values and distances to go in DB570x.
//!
//! Called at the start of the decisions of a cycle, so that the reactions of an alarm act in it. A bit of DB1600 that the PLC sets raises its
//! alarm, 700000 to 700247, with the variable of the alarm as `%1`. MD14516 gives each alarm its reactions (bit 0 NC start disable, 1 read-in
//! disable, 2 feed disable of all axes, 3 emergency stop, 4 PLC stop) and what clears it: without bits 6 and 7 it goes with its bit; with bit 6
//! it stays until the PLC acknowledges with DB1600.DBX3000.0; with bit 7 until power off. A reaction acts as the signal of the same name would,
//! beside it (the alarm handler of the manuals combines both with OR), and causes name the alarm.
//!
//! Choices where the manuals leave one: an acknowledgement is a level, and clears only alarms whose bit is 0; the variable is read when the alarm
//! begins; bit 5 (entry in the alarm log) has no effect. DB570x follows while DB2600.DBX1.1 or 1.2 requests it, and then keeps its value.
//!
//! `state.rs` contains the active alarms, `alarms.rs` is the stage.

pub(super) mod alarms;
mod messages;
pub(super) mod state;
