//! The built-in programs, one file each.

mod enable_all;
mod gantry_start;
mod gear_change;
mod limit_edge_marker;
mod machine_control_panel;
mod position_axis;
mod shared_reference_cam;
mod tool_change;

pub use enable_all::enable_all;
pub use gantry_start::gantry_start;
pub use gear_change::{GearChange, gear_change};
pub use limit_edge_marker::{LimitEdgeMarker, limit_edge_marker};
pub use machine_control_panel::{MACHINE_CONTROL_PANEL_LAYOUT, MachineControlPanel, machine_control_panel};
pub use position_axis::{PositionAxis, position_axis};
pub use shared_reference_cam::shared_reference_cam;
pub use tool_change::{ToolChange, tool_change};
