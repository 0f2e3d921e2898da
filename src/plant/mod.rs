//! SIMULATED MECHANICS: slides, bridges, drives, encoders, cams and switches. This module has no state such as
//! "referenced".
//!
//! [`PlantDefinition`] is the content of `plant.toml`. [`Layout`] is the same with all defaults filled in, for the axes
//! of one machine. [`Plant`] is the state that moves. The machine calls [`Plant::advance`] once per position-control
//! cycle and [`Plant::feedback`] once per interpolation cycle. To add a fault, add an arm to [`FaultKind`] and its effect
//! to `moving.rs`.

mod definition;
mod faults;
mod hold;
mod layout;
mod leadscrew;
mod moving;
mod reading;

pub use definition::{
    AxisPlant, Bridge, Cam, Drive, EncoderKind, EncoderPlant, Given, Input, LimitSwitch, PlantDefinition,
};
pub use faults::{Fault, FaultKind, Switch};
pub use hold::HoldingBrake;
pub use layout::{AxisMechanics, Hints, Layout, SlideCoupling};
pub use leadscrew::Leadscrew;
pub use moving::Plant;
