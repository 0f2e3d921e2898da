//! OpenNCK: an open simulator of the NC/PLC interface of SINUMERIK-style controls.
//!
//! A PLC program of a machine tool talks to the control through data blocks of signals. OpenNCK is the other side of these
//! data blocks: the control's answer to what the PLC writes, the axes behind it, and a record of every bit that changed with
//! the reason why. It runs in virtual time, as fast as the computer allows, and the same input gives the same bytes.
//!
//! A whole run: a PLC program as a closure, a reference point approach of a gantry, and the trace of it.
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
//! # How data flow
//!
//! ```text
//!  machine data ──> sinumerik ──┐             ┌── closures of a user
//!  (.tea .arc)          │       ├──> image <──┤
//!                    motion     └──> variables└── plc: ready programs
//!                       │                │
//!  plant.toml ──────> plant ───────── machine ──> trace ──> scenario ──> golden
//!                              (step, save, fork)               └─────── cli
//!                                        │
//!                                      live (real time, inbox, copies) ──> s7 ──> clients
//! ```
//!
//! The control and the PLC program never see each other: they meet in the bytes of [`image`], as in the real thing. What the
//! control shows besides bits (positions, alarms, causes) is in [`variables`]. [`plant`] is the iron: it moves slides and presses
//! cams, and knows nothing of bits called "referenced". [`machine`] puts them in order, [`trace`] looks on.
//!
//! # Rooms, and who may import whom
//!
//! Each room is a folder, and `tests/layers.rs` holds this table against every import. Files import each other in no circle, also
//! within a room; the same test finds circles, and lists the few that remain.
//!
//! | room | what it is | it may import |
//! |---|---|---|
//! | [`units`] | time in whole nanoseconds, positions in whole nanometres, numbers of axes and channels | nothing |
//! | [`source`] | files with lines, TOML as a tree, and problems that say where, what and what to do | nothing |
//! | [`image`] | THE INTERFACE: bytes by writer, signals, symbols, addresses, presets, for any control; the tables of the SINUMERIK | `source`, `units` |
//! | [`variables`] | what the control shows besides bits: values, alarms, events with causes | `image`, `units` |
//! | [`motion`] | the axis: setpoints, position control, drive, encoder, and the engine that couples axes | `units` |
//! | [`control`] | the boundary of a control: the trait that the machine steps, its commands, data, texts and charts | `image`, `motion`, `source`, `units`, `variables` |
//! | [`sinumerik`] | THE CONTROL of the gantry manual, with its machine data and alarms | `control`, `image`, `motion`, `source`, `units`, `variables` |
//! | [`controls`] | which controls there are: the only place that names them | `control`, `image`, `sinumerik`, `source` |
//! | [`plc`] | THE PROGRAM: closures over the PLC's side, small blocks, ready programs | `image`, `source`, `units` |
//! | [`plant`] | THE IRON: slides, bridges, cams, switches, faults | `motion`, `source`, `units` |
//! | [`trace`] | THE RECORD: what changed when and why, as text and JSON lines | `image`, `source`, `units`, `variables` |
//! | [`expression`] | EXPRESSIONS over signals, values and alarms: read once, looked at in every cycle | `image`, `source`, `units`, `variables` |
//! | [`machine`] | ONE STEP, and open, queue, power, save, restore, fork | `control`, `controls`, `expression`, `image`, `motion`, `plant`, `plc`, `source`, `trace`, `units`, `variables` |
//! | [`scenario`] | files that act, and the session that tests in Rust use | `control`, `controls`, `expression`, `image`, `machine`, `plc`, `source`, `trace`, `units`, `variables` |
//! | [`golden`] | scenarios below a folder, each against its golden trace | `control`, `controls`, `image`, `machine`, `plc`, `scenario`, `source`, `trace`, `units` |
//! | [`live`] | a machine in real time: the stepping thread, the inbox, the copy of the last step, the recording, a PLC in another process (feature `live`, part of `s7` and `mapped`) | `image`, `machine`, `plc`, `scenario`, `source`, `trace`, `units`, `variables` |
//! | [`s7`] | S7 communication: wire formats, sessions without a socket, a server on TCP and for [`live`] (feature `s7`) | `control`, `image`, `live`, `machine`, `source`, `units`, `variables` |
//! | [`cli`] | the program's arguments and wiring (feature `cli`) | all |
//!
//! # The order of a step
//!
//! One step is one interpolation cycle. [`Machine::step`](machine::Machine::step) lists its stages, and their order is the
//! specification of who sees whom when:
//!
//! 1. Commands from outside that were queued: writes, forces, machine data, handwheels, faults, power, the cancel key.
//! 2. The plant senses: wired switches become inputs of the PLC.
//! 3. PLC scan, when its time has come. It reads what the control published at the end of the cycle before.
//! 4. Cams and limit switches that are not wired, then forces.
//! 5. The control decides: run-up, mode groups, emergency stop, RESET, handwheels, measuring systems, parameter sets, enabling,
//!    referencing and gantry or JOG, setpoints and coupling.
//! 6. Position control, drives and mechanics, MD10070 / MD10060 times; encoders tell.
//! 7. Monitoring and alarms.
//! 8. Publication of signals and variables.
//! 9. The record of what changed in this cycle.
//!
//! # What always holds
//!
//! * Same input, same bytes: on every run, build and machine. No clock, no thread, no order of a hash in a step; positions are
//!   integers, and model arithmetic is `+ − × ÷ sqrt` and comparisons.
//! * Nobody sees half a step of anybody else, and nothing acts on an outside event: it waits for the edge.
//! * A program writes only the PLC's side, the control only the NCK's: the borrow checker sees to it.
//! * Saved in mid-run and restored, or forked, a machine goes on byte for byte as if nothing had happened.
//! * Every edge of the control's bits has a cause: the rule that allowed it and the inputs that were tested.
//! * Every wait has a way out: done, aborted, too long. Inside the machine there are no errors, only alarms; at the doors an
//!   error says what was expected, what came and where.
//!
//! # What is deliberately absent
//!
//! No real-time claim and no connection to hardware: it is no safety device. No NC programs; no path motion beyond what
//! referencing and JOG need. No unsafe code but one block that maps a file. No hidden state: what a machine remembers is in
//! [`Machine::save`](machine::Machine::save), and what files said is shared between forks and never changes.
//!
//! # Where to add something
//!
//! | I want to add | I do | and see |
//! |---|---|---|
//! | a signal | a row in `db10.rs`, `db11.rs`, `db21.rs` or `db31.rs` of `image/sinumerik/`, in address order | accessor, constant, docs, symbol, trace column; overlaps stop the build |
//! | an interface of another control | a static [`image::Interface`] with its tables, as `tests/machine/own_interface.rs` does | symbols, addresses, presets, mapped image; gaps and foreign bytes stop the build |
//! | its value and its cause | a row in `sinumerik/publish/` | golden traces that show it |
//! | a machine datum | a row in `sinumerik/machine_data/`, a field in `sinumerik/parameters/axis.rs` | its number and name are read, checked and written |
//! | an alarm | a row in `sinumerik/alarms/mod.rs`, a `raise` where it happens | `alarm(N)` in scenarios, its text in traces |
//! | a rule | a row in `sinumerik/rules.rs`, a `note` where it is decided | the cause behind an edge |
//! | a reaction of a coupling | a value of a type in `motion/coupling/policy.rs`, what it does beside it | properties in `motion/coupling/tests.rs` |
//! | another gantry control | a `Policy` and its `Follower`s; rules and alarms for the events of `compare` | as `sinumerik/gantry/` |
//! | a step of referencing or of the gantry | a row in `TRANSITIONS` of `sinumerik/referencing/state.rs` or `gantry/state.rs` | golden traces that move |
//! | a fault | an arm of [`FaultKind`](machine::FaultKind), what it does in `plant/moving.rs`, its name in `scenario/faults.rs` | `fault = {…}` in scenarios |
//! | a PLC program | a file in `plc/programs/`, a line in `plc/registry.rs`; or a closure of your own | `plc = "name"` in scenarios |
//! | a machine | a folder below `machine_data/` | `machine = "path"` in scenarios |
//! | a scenario | a `.toml` below `golden/<area>/`, then read and accept its trace | the `.snap` beside it |
//! | a server for other clients | a folder in `src` that holds a [`live::Handle`] and no more of `live`; `tests/serve/another_server.rs` has a small one | reads of one step, orders that act whole and are recorded |
//! | an NC variable that clients read | a row in `s7/nck/catalogue.rs` | its value by area, module, column and line |
//! | a room | a folder in `src`, a row here and one in `tests/layers.rs` | the test that compares both |

#[cfg(feature = "cli")]
pub mod cli;
pub mod control;
pub mod controls;
pub mod expression;
pub mod golden;
pub mod image;
#[cfg(feature = "live")]
pub mod live;
pub mod machine;
pub mod motion;
pub mod plant;
pub mod plc;
#[cfg(feature = "s7")]
pub mod s7;
pub mod scenario;
pub mod sinumerik;
pub mod source;
pub mod trace;
pub mod units;
pub mod variables;
