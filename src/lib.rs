//! OpenNCK: an open simulator of the NC/PLC interface of SINUMERIK-style controls.
//!
//! A machine tool has a numerical control (its kernel is the NCK) and a PLC program. They exchange signals through data blocks. OpenNCK is
//! the control side of these data blocks: it answers the signals that the PLC program writes, simulates the axes, and records every signal
//! that changes with the reason of the change. It runs in virtual time, as fast as the computer allows. The same input gives the same bytes.
//!
//! A complete run: a PLC program as a closure, a reference point approach of a gantry, and its trace.
//!
//! ```
//! use opennck::plc::program;
//! use opennck::scenario::Session;
//!
//! let plc = program("everything_on", (), |(), io| {
//!     for axis in io.axes() {
//!         io.to_nck.axis(axis).set_position_measuring_system_1(true); // DBX1.5
//!         io.to_nck.axis(axis).set_controller_enable(true); // DBX2.1
//!         io.to_nck.axis(axis).set_pulse_enable(true); // DBX21.7
//!     }
//! });
//! let mut gantry = Session::open("g1_example")?.with_program(plc.boxed());
//! gantry.watch(&["X.referenced_synchronized_1", "XF.referenced_synchronized_1", "DB31.DBX101.*"])?;
//! gantry.set("DB11.DBX1.2", 1)?; // JOG is active after power on; this is machine function REF
//! gantry.pulse("X.traversing_key_plus")?;
//! gantry.wait("X.gantry_synchronization_ready_to_start && alarm(10654)", "60s")?;
//! gantry.set("X.start_gantry_synchronization", 1)?;
//! gantry.wait("X.gantry_grouping_is_synchronized", "60s")?;
//! gantry.wait("X.position == XF.position", "1s")?;
//! assert!(gantry.text().contains("DB31.DBX101.5     0 -> 1"), "{}", gantry.text());
//! # Ok::<(), opennck::scenario::Failure>(())
//! ```
//!
//! # Data flow
//!
//! ```text
//!  machine data ──> sinumerik ──┐             ┌── closures of a user
//!  (.tea .arc)      (a control) ├──> image <──┤
//!                    motion     └──> variables└── plc: built-in programs
//!                       │                │
//!  plant.toml ──────> plant ───────── machine ──> trace ──> scenario ──> golden
//!                              (step, save, fork)               └─────── cli
//!                                        │
//!                                      live (real time, inbox, copies) ──> s7, web, opcua ──> clients
//! ```
//!
//! The control and the PLC program have no direct connection: they exchange the bytes of [`image`], as on a real machine. [`variables`]
//! contains the output of the control in addition to signals: positions, alarms and causes. [`plant`] is the simulated mechanics: it moves
//! slides and presses cams, and does not know signals such as "referenced". [`machine`] runs all of them in a fixed order, and [`trace`]
//! records the result.
//!
//! # Modules and their imports
//!
//! Each module is a folder. `tests/layers.rs` checks every import against this table. The imports between files have no cycles, also inside
//! a module; the same test finds cycles.
//!
//! | module | content | allowed imports |
//! |---|---|---|
//! | [`units`] | time in whole nanoseconds, positions in whole nanometres, numbers of axes and channels | nothing |
//! | [`source`] | files with line numbers, TOML as a tree, and error messages with place, cause and remedy | nothing |
//! | [`image`] | the interface: bytes by writer, signals, symbols, addresses, presets, for any control; the tables of the SINUMERIK | `source`, `units` |
//! | [`variables`] | the output of the control in addition to signals: values, alarms, events with causes | `image`, `source`, `units` |
//! | [`motion`] | the axis: setpoints, position control, drive, encoder, and the engine that couples axes | `units` |
//! | [`nc_program`] | NC programs as a language: text, words, expressions, blocks, with a dialect; knows the names of axes, and no axis | nothing |
//! | [`control`] | the boundary of a control: the trait that the machine steps, its commands, data, texts and charts | `image`, `motion`, `nc_program`, `source`, `units`, `variables` |
//! | [`sinumerik`] | the control of the gantry manual, with its machine data and alarms | `control`, `image`, `motion`, `nc_program`, `source`, `units`, `variables` |
//! | [`isg`] | the control of the ISG kernel and TwinCAT CNC: parameter lists, NC language, hard and soft gantry | `control`, `image`, `motion`, `nc_program`, `source`, `units`, `variables` |
//! | [`controls`] | the list of controls: the only module that names them | `control`, `image`, `isg`, `sinumerik`, `source` |
//! | [`plc`] | the PLC program: closures over the PLC side, function blocks, built-in programs, STEP 7 sources | `image`, `source`, `units` |
//! | [`plant`] | the simulated mechanics: slides, bridges, cams, switches, faults | `motion`, `source`, `units` |
//! | [`trace`] | the record: every change with its time and cause, as text and JSON lines | `image`, `source`, `units`, `variables` |
//! | [`expression`] | expressions over signals, values and alarms: parsed once, evaluated in every cycle | `image`, `source`, `units`, `variables` |
//! | [`monitor`] | rules over time: conditions of every cycle, consequences that follow in time | `expression`, `image`, `source`, `units`, `variables` |
//! | [`machine`] | one step of the complete machine, and open, queue, power, save, restore, fork | `control`, `controls`, `expression`, `image`, `motion`, `nc_program`, `plant`, `plc`, `source`, `trace`, `units`, `variables` |
//! | [`scenario`] | scenario files, and the session for tests in Rust | `control`, `controls`, `expression`, `image`, `machine`, `monitor`, `nc_program`, `plc`, `source`, `trace`, `units`, `variables` |
//! | [`golden`] | runs the scenarios below a folder and compares each with its golden trace | `control`, `controls`, `image`, `plc`, `scenario`, `source`, `trace`, `units` |
//! | [`campaign`] | many cases of a scenario: what varies, what must hold, failures in groups, the smallest scenario of each | `image`, `plc`, `scenario`, `source`, `trace`, `units`, `variables` |
//! | [`live`] | a machine in real time: the stepping thread, the inbox, the copy of the last step, the recording, a PLC in another process (feature `live`, part of `s7` and `mapped`) | `image`, `machine`, `plc`, `scenario`, `source`, `trace`, `units`, `variables` |
//! | [`s7`] | S7 communication: wire formats, sessions without a socket, a server on TCP and for [`live`] (feature `s7`) | `image`, `live`, `machine`, `source`, `units`, `variables` |
//! | [`web`] | the live page: a machine in real time in a browser (feature `web`) | `control`, `image`, `live`, `machine`, `plc`, `scenario`, `source`, `trace`, `units`, `variables` |
//! | [`opcua`] | OPC UA: the namespace of a SINUMERIK for data collectors and operator panels (feature `opcua`, off by default) | `image`, `live`, `machine`, `source`, `units`, `variables` |
//! | [`symbol_files`] | the signals of a machine as files of other tools: Node-RED, python-snap7, TIA Portal, STEP 7 (feature `cli`) | `image` |
//! | [`cli`] | the command line: its arguments, and the construction of all other parts (feature `cli`) | all |
//!
//! Every module works for any control, except these, which are for the SINUMERIK on purpose: [`sinumerik`], the tables in [`image`] that
//! have its name, the built-in programs of [`plc`], which name its signals, and the NC variables of `variables::nc`. `tests/layers.rs` keeps the
//! list of files that may use its structures.
//!
//! # The order of a step
//!
//! One step is one interpolation cycle. [`Machine::step`](machine::Machine::step) lists its stages. Their order defines which stage sees
//! the results of which other stage:
//!
//! 1. Queued commands from outside: writes, forces, machine data, handwheels, faults, power, the cancel key.
//! 2. Sensors of the plant: wired switches set inputs of the PLC.
//! 3. The PLC scan, if it is due. It reads the signals that the control published at the end of the previous cycle.
//! 4. Cams and limit switches that are not wired, then forces.
//! 5. Decisions of the control: run-up, mode groups, emergency stop, RESET, handwheels, measuring systems, parameter sets, enabling,
//!    referencing and gantry or JOG, setpoints and coupling.
//! 6. Position control, drives and mechanics, MD10070 / MD10060 times per cycle; then the encoders.
//! 7. Monitoring and alarms.
//! 8. Publication of signals and variables.
//! 9. The record of all changes in this cycle.
//!
//! # Guarantees
//!
//! * The same input gives the same bytes: in every run, build and machine. A step uses no clock, no thread and no hash order. Positions are
//!   integers, and the arithmetic of the model is `+ − × ÷ sqrt` and comparisons.
//! * No part sees an incomplete step of another part, and no external event has an effect inside a step: it waits for the next step.
//! * A PLC program writes only the PLC side, the control writes only the NCK side; the borrow checker enforces this.
//! * A machine that is saved during a run and restored, or forked, continues byte for byte like the original.
//! * Every edge of a signal of the control has a cause: the rule that allowed it and the inputs that were tested.
//! * Every wait ends: completed, aborted or timed out. Inside the machine there are no errors, only alarms. At the boundaries, an error
//!   names what was expected, what was found, and the place.
//!
//! # Deliberate limits
//!
//! OpenNCK is not a safety device: it does not claim real time and has no connection to hardware. It runs no NC programs, and no path
//! motion beyond the needs of referencing and JOG. It has no unsafe code except one block that maps a file. It has no hidden state: the
//! complete state of a machine is in [`Machine::save`](machine::Machine::save); data from files are shared between forks and never change.
//!
//! # Where to add something
//!
//! This is the only such table. Paths are relative to `src`.
//!
//! | to add | change | result |
//! |---|---|---|
//! | a signal | a row in `db10.rs`, `db11.rs`, `db21.rs` or `db31.rs` of `image/sinumerik/`, in address order | accessor, constant, docs, symbol, trace column; the build rejects overlaps |
//! | the value of a signal of the control, and its cause | the stage that decides it; its state and the event behind it, for an axis in `AxisSignals` or `Causes` of `sinumerik/axis/state.rs`; a row in `sinumerik/publish/`, and what must hold for it in `publish/conditions/`; a row in `sinumerik/rules.rs` if no rule fits | golden traces that show it; they show the cause if the scenario has `causes = true` |
//! | the reaction to a signal of the PLC | the stage that reads it, by its constant through `sinumerik/inputs.rs`; its row in `sinumerik/modelled.rs` | the cause of an edge names it |
//! | an interface of another control | a static [`image::Interface`] with its tables, as in `tests/machine/own_interface.rs` | symbols, addresses, presets, mapped image; the build rejects gaps and bytes of another writer |
//! | another control | a module with its [`control::Control`], [`control::Configuration`] and [`control::Texts`]; a row in `CONTROLS` of `controls/mod.rs`; its folder in `KNOWS_CONTROLS` of `tests/layers.rs`. `tests/machine/second_control/platform.rs` is a tiny one | its machines run in scenarios, traces, S7 |
//! | a machine datum | a row in `general.rs`, `channel.rs`, `axis.rs` or `setting.rs` of `sinumerik/machine_data/`; a field in the file of its topic in `sinumerik/parameters/`, if the model needs it | its number and name are read, checked and written; the build rejects a number twice |
//! | an alarm | a row in `sinumerik/alarms/mod.rs`, and its row removed from `alarms/not_raised.rs`; a `raise` at the place of its condition; an arm of `cleared_cause` in `sinumerik/publish/alarms.rs`, if another event than the movement of its axis clears it; the table in `sinumerik/monitoring/mod.rs`, if it is a monitoring function | `alarm(N)` in scenarios, its text in traces; the build rejects rows out of order |
//! | a monitoring function | a file in `sinumerik/monitoring/`, a row in the table of its `mod.rs`, a call in `monitor_axis` | its alarms |
//! | a key or verb of scenarios | `scenario/file.rs` or `scenario/steps.rs` | `docs/scenarios.md`, whose examples are tested |
//! | a rule | a row in `sinumerik/rules.rs` and in `docs/rules.md`, a `note` at the place of the decision | the cause of an edge |
//! | a state of an axis | a field of `Axis` in `sinumerik/axis/state.rs`, compared in `has_decisions_of` or `has_movement_of` there; an arm of `decisions_follow_movement`, if a decision depends on the position | axes at rest wake in time |
//! | a state that all axes depend on | a field of `Shared` in `sinumerik/resting.rs`; without it no axis wakes when the state changes | as above |
//! | a step of referencing or of the gantry | a row in `TRANSITIONS` of `sinumerik/referencing/state.rs` or `gantry/state.rs` | golden traces that change |
//! | more synchronous axes of a gantry grouping | `SYNCHRONOUS_AXES` in `sinumerik/parameters/groupings.rs` | groupings of that size; one axis more raises 10650 |
//! | a reaction of a coupling | a value of a type in `motion/coupling/policy.rs`, and its effect | properties in `motion/coupling/tests.rs` |
//! | another gantry control | a `Policy` and its `Follower`s; rules and alarms for the events of `compare` | a module like `sinumerik/gantry/` |
//! | a fault | a variant of [`FaultKind`](machine::FaultKind) in `plant/faults.rs`, its effect in `plant/moving.rs`, its name in `variables/happening.rs`, its row in `scenario/faults.rs` | `fault = {…}` in scenarios, recordings and messages; the build rejects a missing one |
//! | a word of NC programs | a G function: a row in `nc_program/functions.rs`; an address or a command: `nc_program/syntax.rs`, `words.rs`, and what it does in `addresses.rs` or `commands.rs`; a word that is only refused: a row in `nc_program/dialect.rs` | the table in `docs/nc_programs.md`, the tests of the module |
//! | an alarm of block preparation | a row in `nc_program/alarm.rs`, a smallest program in `nc_program/tests/alarms.rs` | a run and `opennck nc check` raise it |
//! | another dialect of NC programs | a static `nc_program::Dialect`; a field there for what differs | the seam between controls |
//! | a PLC program | a file in `plc/programs/` and a line in `plc/registry.rs`, or your own closure | `plc = "name"` in scenarios |
//! | a machine | a folder below `machine_data/` | `machine = "path"` in scenarios |
//! | a scenario | a `.toml` file below `golden/<area>/`; then review and accept its trace | the `.snap` file beside it |
//! | a server for other clients | a folder in `src` that uses [`live::Handle`] and no other item of `live`; `tests/serve/another_server.rs` has a small example | consistent reads of one step, orders that are executed as a whole and recorded |
//! | a symbol file for another tool | a function in `symbol_files/`, a value of `Format` there and in `cli/signals/files.rs` | `opennck signals --format`; read it back in `tests/foreign` |
//! | an NC variable for clients | a row in `variables/nc/catalogue.rs` | its value for S7 and OPC UA clients |
//! | a module | a folder in `src`, a row here and one in `tests/layers.rs` | the test that compares both |

// A build without the module has no documentation of it to link to.
#![cfg_attr(not(feature = "opcua"), doc = "", doc = " [`opcua`]: #modules-and-their-imports")]

pub mod campaign;
#[cfg(feature = "cli")]
pub mod cli;
pub mod control;
pub mod controls;
pub mod expression;
pub mod golden;
pub mod image;
pub mod isg;
#[cfg(feature = "live")]
pub mod live;
pub mod machine;
pub mod monitor;
pub mod motion;
pub mod nc_program;
#[cfg(feature = "opcua")]
pub mod opcua;
pub mod plant;
pub mod plc;
#[cfg(feature = "s7")]
pub mod s7;
pub mod scenario;
pub mod sinumerik;
pub mod source;
#[cfg(feature = "cli")]
pub mod symbol_files;
pub mod trace;
pub mod units;
pub mod variables;
#[cfg(feature = "web")]
pub mod web;
