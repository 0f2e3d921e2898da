//! The ready programs, one file each.

mod enable_all;
mod gantry_start;
mod shared_reference_cam;

pub use enable_all::enable_all;
pub use gantry_start::gantry_start;
pub use shared_reference_cam::shared_reference_cam;
