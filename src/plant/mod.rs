//! THE IRON: slides, bridges, drives, encoders, cams and switches. It knows nothing of bits called "referenced".
//!
//! [`PlantDefinition`] is what `plant.toml` says; [`Layout`] is that with every default filled in, for the axes of one
//! machine; [`Plant`] is the state that moves. The machine calls [`Plant::advance`] once per position-control cycle and
//! [`Plant::tell`] once per interpolation cycle. A new fault is an arm of [`FaultKind`] and what it does in `moving.rs`.

mod definition;
mod faults;
mod layout;
mod moving;

pub use definition::{
    AxisPlant, Bridge, Cam, Db11Byte5Bit2, Drive, EncoderKind, EncoderPlant, Given, Input, LimitSwitch, PlantDefinition,
};
pub use faults::{Fault, FaultKind, Switch};
pub use layout::{Hints, Iron, Layout, RigidOrSoft};
pub use moving::Plant;
